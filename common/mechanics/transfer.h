/* A deformation carried from one mesh of a body to another of the same or nearly the same shape. */
#ifndef PM_TRANSFER_H
#define PM_TRANSFER_H

#include "common/files/mesh.h"

/* u_to(X) = u(Y) + (F - I)(X - Y) at every node X of `to`: Y is X itself where an element of `from`
 * holds it, else a point near X in the element nearest to it, F = I + du/dX there. So a node
 * outside goes where the deformation beside it takes it, and F changes only by its own gradient.
 * What `from` has behind its symmetry planes is its image. Nodes of the base stay, those of
 * symmetry planes stay in them. u (nn of from x 3), u_to (nn of to
 * x 3) [mm], distinct. About nn log ne. */
enum pm_status pm_transfer(const struct pm_mesh *from, const double *u, const struct pm_mesh *to,
                           double *u_to, struct pm_err *err);

#endif
