/* A deformation carried from one mesh of a body to another of the same or nearly the same shape. */
#ifndef PM_TRANSFER_H
#define PM_TRANSFER_H

#include "common/mechanics/model.h"

/* At every point of the elements of `to` what `from` has there at c: displacement gradients (nb x
 * points x 9, du_i/dX_j in row i) for pm_warp_fit, and pressures and stresses (nb x points x
 * PM_MIXED), in each element the linear functions nearest to those at its own points. Outside,
 * of the element nearest to the place. Bubbles of `from` are not seen in the gradients. What `from`
 * has behind its symmetry planes is its image. About points log ne. */
enum pm_status pm_transfer(const struct pm_model *from, const struct pm_config *c,
                           const struct pm_model *to, pm_lanes *gradient, pm_lanes *mixed,
                           struct pm_err *err);

#endif
