/* A deformation carried from one shape of a body to a neighbouring one of the same connectivity. */
#ifndef PM_ADVECT_H
#define PM_ADVECT_H

#include "common/files/mesh.h"

/* u_to = u + (F - I)(X_to - X), F = I + du/dX at the nodes of `from` (mean over their elements):
 * the new material point goes where the old deformation takes it, so that F changes only by its own
 * gradient. Displacements kept as they are would tear every part that has turned. u, u_to (nn x 3)
 * [mm], distinct. */
enum pm_status pm_advect(const struct pm_mesh *from, const double *u, const struct pm_mesh *to,
                         double *u_to, struct pm_err *err);

#endif
