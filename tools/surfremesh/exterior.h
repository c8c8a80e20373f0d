/* A new parametrisation of the exterior, along which its control points are even. */
#ifndef PM_SURFREMESH_EXTERIOR_H
#define PM_SURFREMESH_EXTERIOR_H

#include "common/geometry/surface_map.h"

/* How uneven the control points lie: longest over mean length of the grid's edges around and along,
 * the worse of the two; edges along next to the rims, short by construction, are left out. */
enum pm_status pm_exterior_unevenness(const struct pm_surface *s, double *ratio,
                                      struct pm_err *err);
/* Shifts (n x 2) in (theta, v) of the control points' parameters, relaxed so that every point lies
 * in the middle of its four neighbours; rows 0, 1, nv-2, nv-1 stay. */
enum pm_status pm_exterior_relax(const struct pm_surface *s, double *shift, struct pm_err *err);
/* Parameter of the old surface under S of the new one: (theta, v) + sum c_m(S) shift_m. */
enum pm_status pm_exterior_start(const struct pm_map *map, const double *shift, const double S[3],
                                 struct pm_basis *work, double old[3], struct pm_err *err);

#endif
