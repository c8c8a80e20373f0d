/* A mesh given to other control points of nearly the same surfaces. */
#ifndef PM_CARRY_H
#define PM_CARRY_H

#include "common/files/mesh.h"
#include "common/files/surfaces.h"

struct pm_carry_report {
    double furthest;  /* of a vertex from its foot [mm] */
    ptrdiff_t damped; /* mid-side nodes on surfaces with t < 1 */
};

/* New parameters S and weights for the surface nodes of m, whose chambers are those of s; positions
 * stay and are no longer W phi. A vertex gets its foot on the new surface, along rims and in mirror
 * planes (bits `planes`) where it lies on one, a mid-side node that of its own place with t = 1
 * [model 5], or, where it lies further off than every vertex, the t that brings it nearest: it was
 * drawn to its chord. */
enum pm_status pm_mesh_carry(const struct pm_surfaces *s, unsigned planes, struct pm_mesh *m,
                             struct pm_carry_report *r, struct pm_err *err);

#endif
