/* A tree of bounding boxes: which of them meet a box, and what is nearest to a point. */
#ifndef PM_BOXES_H
#define PM_BOXES_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_boxes;

/* box (n x 6): lowest and highest corner; copied. n log n. */
enum pm_status pm_boxes_new(ptrdiff_t n, const double *box, struct pm_boxes **boxes,
                            struct pm_err *err);
void pm_boxes_free(struct pm_boxes *boxes);
/* The boxes that meet this one (touching counts), in a fixed but unsorted order: id has room for n;
 * returns their number. */
ptrdiff_t pm_boxes_meet(const struct pm_boxes *boxes, const double box[6], int32_t *id);

/* Looks at item id and returns the lesser of `best` and its distance [mm]. */
typedef double pm_boxes_visit(void *data, int32_t id, double best);
/* Visits the items whose boxes are nearer to x than the best distance so far, near ones first;
 * returns the best. ahead: a unit vector n or NULL: passes over boxes all of whose points y have
 * (y - x).n < cosine |y - x|. */
double pm_boxes_nearest(const struct pm_boxes *boxes, const double x[3], const double *ahead,
                        double cosine, double best, pm_boxes_visit *visit, void *data);

#endif
