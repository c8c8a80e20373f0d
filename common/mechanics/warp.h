/* Large steps of a deformation without the strain that straight lines put into turning parts: the
 * step is taken as a field of deformation gradients, F -> exp(A) F, and the positions are the ones
 * whose gradients come nearest to it (least squares, quadratic Laplacians on the reference body,
 * factored once). Bodies that bend by radians stay free of spurious stretch. */
#ifndef PM_WARP_H
#define PM_WARP_H

#include "common/mechanics/model.h"

struct pm_warp;

enum pm_status pm_warp_new(struct pm_model *m, struct pm_warp **w, struct pm_err *err);
/* to = c moved by A = H1 + (H2 - H1 H1)/2, H = grad_x of the nodal fields du1 and du2 (NULL: A =
 * H1; nn x 3). The end-effector moves as a rigid body with the mean of its nodes; its rotation
 * vector is the one near that of c. */
enum pm_status pm_warp_move(struct pm_warp *w, const struct pm_config *c, const double *du1,
                            const double *du2, struct pm_config *to, struct pm_err *err);
/* to = the deformation u of an earlier shape X of the same elements (nn x 3 of the model's space),
 * point by point with its gradients, so that strains change only where those no longer fit
 * together; to->U: the rigid motion of before as a first value. mixed: its pressures and stresses,
 * as pm_model_mixed. PM_INPUT where an element of X is inverted. */
enum pm_status pm_warp_carry(struct pm_warp *w, const double *X, const double *u,
                             struct pm_config *to, pm_lanes *mixed, struct pm_err *err);
/* to = the deformation whose displacement gradients come nearest to the given at the points of the
 * elements (nb x points x 9); to->U as in pm_warp_carry. */
enum pm_status pm_warp_fit(struct pm_warp *w, const pm_lanes *gradient, struct pm_config *to,
                           struct pm_err *err);
void pm_warp_free(struct pm_warp *w);

#endif
