/* A new parametrisation of the exterior, along which its control points are even. */
#ifndef PM_SURFREMESH_EXTERIOR_H
#define PM_SURFREMESH_EXTERIOR_H

#include "common/files/surfaces.h"

/* Numbers of control points around (a multiple of 12) and along that bring the mean edges back to
 * s->spacing, at least those there are; *off: how much longer the edges are, as a part. */
enum pm_status pm_exterior_counts(const struct pm_surface *s, ptrdiff_t *nu, ptrdiff_t *nv,
                                  double *off, struct pm_err *err);
/* How uneven the control points lie: longest over mean length of the grid's edges around and along,
 * the worse of the two. */
enum pm_status pm_exterior_unevenness(const struct pm_surface *s, double *ratio,
                                      struct pm_err *err);
/* A grid nu x nv on the old surface, relaxed so that every point lies in the middle of its four
 * neighbours; the rims and the rows beside them stay. *to gets Phi, free, the triangles and phi =
 * f_old (unfitted), the heights z = height v where they are not free, and on the rims control
 * points whose curve passes through the old one at theta = 2 pi a / nu. *carried (n x 3, new
 * memory): the parameters of the old surface. */
enum pm_status pm_exterior_spread(const struct pm_surface *s, double height, ptrdiff_t nu,
                                  ptrdiff_t nv, struct pm_surface *to, double **carried,
                                  struct pm_err *err);

#endif
