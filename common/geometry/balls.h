/* Which of many balls of very different radii hold a point: a tree of bounding boxes of balls. */
#ifndef PM_BALLS_H
#define PM_BALLS_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_balls;

/* centre (n x 3), radius (n); both are copied. */
enum pm_status pm_balls_new(ptrdiff_t n, const double *centre, const double *radius,
                            struct pm_balls **balls, struct pm_err *err);
void pm_balls_free(struct pm_balls *balls);
/* The balls with |x - centre| < radius, in a fixed but unsorted order: id has room for n; returns
 * their number. */
ptrdiff_t pm_balls_query(const struct pm_balls *balls, const double x[3], int32_t *id);

#endif
