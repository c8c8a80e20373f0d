/* A tree of points: which of them is nearest, of all or of those that are faced; which balls around
 * them hold a place. */
#ifndef PM_CLOUD_H
#define PM_CLOUD_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_cloud;

/* x (n x 3) [mm], normal (n x 3): unit normals, or NULL; both are copied. PM_NUMERIC where a place
 * is not finite. n log n. */
enum pm_status pm_cloud_new(ptrdiff_t n, const double *x, const double *normal,
                            struct pm_cloud **cloud, struct pm_err *err);
void pm_cloud_free(struct pm_cloud *cloud);

/* Gives every point a ball around it (n) [mm]. */
enum pm_status pm_cloud_inflate(struct pm_cloud *cloud, const double *radius, struct pm_err *err);
/* The balls that hold x, in a fixed order: id has room for n; returns their number. */
ptrdiff_t pm_cloud_covering(const struct pm_cloud *cloud, const double x[3], int32_t *id);

/* What is looked for: a point of the other cloud closer than `cutoff` and accepted (NULL: any).
 * With side 1, where both have normals n and m and d is the way to it, d.n > cosine |d| and -d.m >
 * cosine |d|; side -1: so against the normals; 0: whatever the normals. */
struct pm_look {
    double side, cosine; /* >= 0 */
    double cutoff;       /* [mm] */
    int (*accept)(void *data, int32_t point, int32_t other);
    void *data;
};
/* For the points of `from` that are wanted (n; NULL: all) the nearest one of `to`, of equal ones
 * the first, or -1: found (n), and its distance (n) [mm]. About n log n. */
void pm_cloud_look(const struct pm_cloud *from, const unsigned char *wanted,
                   const struct pm_cloud *to, const struct pm_look *look, int32_t *found,
                   double *distance);
/* The closest points i of a and j of b, closer than `cutoff`. Returns whether there are. */
int pm_cloud_closest(const struct pm_cloud *a, const struct pm_cloud *b, double cutoff, int32_t *i,
                     int32_t *j, double *distance);

#endif
