/* From straight tetrahedra to 10-node ones with mid-side nodes on the true surfaces. */
#ifndef PM_CURVE_H
#define PM_CURVE_H

#include "common/files/mesh.h"
#include "tools/tetmesh/middle.h"
#include "tools/tetmesh/volume_gmsh.h"

struct pm_curve_report {
    ptrdiff_t surface_middles; /* mid-side nodes on surfaces */
    ptrdiff_t bad;             /* elements below the bound before damping */
    ptrdiff_t damped;          /* mid-side nodes on surfaces with t < 1 */
    double off;                /* largest distance that damping took from the true surface [mm] */
    int sweeps;
};

/* Smallest scaled Jacobian (quality.h) of a new mesh. */
extern const double pm_curve_bound;

/* Fills m (all but the case, the reference point and the quality). The mid-side node of a surface
 * edge (a, b) is x = (1 - t) (x_a + x_b)/2 + t r(S_m), S_m the foot of the chord's middle on the
 * surface (on a rim: along the rim); its displacement from the chord is carried into the interior
 * by the Laplace extension of model 5, and nodes of distorted elements inside make room
 * (relocate.h). t = 1, but *= 0.7 around elements whose scaled Jacobian is still below the bound
 * until none is left: x stays linear in the control points. PM_NUMERIC where that does not succeed
 * or where the tetrahedra do not fit the shell. */
enum pm_status pm_curve_mesh(struct pm_middles *middles, const struct pm_shell *shell,
                             const struct pm_tetra *tetra, struct pm_mesh *m,
                             struct pm_curve_report *r, struct pm_err *err);
/* Smallest scaled Jacobian and straight mean ratio over the elements of x (nn x 3). */
void pm_curve_quality(const struct pm_mesh *m, const double *x, double *scaled, double *mean_ratio);

#endif
