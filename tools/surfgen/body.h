/* The exterior: a B-spline tube over the outlines of the body. */
#ifndef PM_BODY_H
#define PM_BODY_H

#include "common/files/surfaces.h"
#include "tools/surfgen/outline.h"

/* nu x nv control points without places: Phi, free, triangulation. */
enum pm_status pm_body_grid(const struct pm_case *c, struct pm_surface *s, struct pm_err *err);
/* nu x nv control points on the outlines (unfitted), v linear in z (around cells in arc length),
 * rims in z = 0 and z = H. Fixed: the rim rows, and z of the rows next to them. */
enum pm_status pm_body_seed(const struct pm_case *c, const struct pm_outline *o,
                            struct pm_surface *s, struct pm_err *err);
/* The wanted point over S = (cos t, sin t, v). */
void pm_body_point(const struct pm_outline *o, const double S[3], double x[3]);

#endif
