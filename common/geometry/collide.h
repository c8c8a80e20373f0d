/* Intersections and distances in a set of triangles. */
#ifndef PM_COLLIDE_H
#define PM_COLLIDE_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_contact {
    ptrdiff_t a, b;  /* two triangles, or a node and a triangle; -1 if there is none */
    double at[3];    /* where [mm] */
    double distance; /* [mm] */
};

/* The first pair of triangles (in the order of their lowest z) of which an edge of one pierces the
 * other; triangles with a common edge are not tested, with a common node only their other edges.
 * Cost: sorted by z, about nt^2 (triangle height / total height) box tests. */
enum pm_status pm_collide_pierce(const double *x, ptrdiff_t nt, const int32_t *tri,
                                 struct pm_contact *c, struct pm_err *err);
/* The node nearest, in parts of its own limit (nn) [mm], to a triangle it does not belong to; only
 * nodes within their limit are seen. Nodes with limit 0 are skipped. */
enum pm_status pm_collide_near(ptrdiff_t nn, const double *x, const double *limit, ptrdiff_t nt,
                               const int32_t *tri, struct pm_contact *c, struct pm_err *err);
/* Solid angle of the triangles seen from p over 4 pi: 1 inside a closed outward surface, 0 outside.
 */
double pm_collide_winding(const double p[3], const double *x, ptrdiff_t nt, const int32_t *tri);
/* Volume enclosed by a closed outward surface, sum of det / 6 [mm3]. */
double pm_collide_volume(const double *x, ptrdiff_t nt, const int32_t *tri);

#endif
