/* The grid of control points of an exterior: a tube of nu x nv of them, rows 0 and nv - 1 on its
 * rims. */
#ifndef PM_TUBE_H
#define PM_TUBE_H

#include "common/files/surfaces.h"

/* Phi (cos t, sin t, v) at the Greville abscissae, what is free (rims: nothing, the rows beside
 * them: x and y), triangles whose diagonals alternate like a chess board: symmetric under mirrors
 * and turns for nu = 12 m. phi, d0 and spacing are zero. */
enum pm_status pm_tube_seed(ptrdiff_t nu, ptrdiff_t nv, struct pm_surface *s, struct pm_err *err);
/* Mean length of the grid's edges around and along, and the longest in parts of it; edges along
 * next to the rims, short by construction, are left out. */
enum pm_status pm_tube_edges(const struct pm_surface *s, double mean[2], double longest[2],
                             struct pm_err *err);

#endif
