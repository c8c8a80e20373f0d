/* Continuum Jacobian and the aggregated second-order adjoint of one load case [model 4.1-4.3]. */
#ifndef PM_ADJOINT_H
#define PM_ADJOINT_H

#include "common/mechanics/model.h"

/* J_r = dq/dp_r for the unit of pressure `scale` [MPa]: q-vectors Jq (nc x nq), and their
 * end-effector rows J (6 x nc). The model holds the factor of the exact tangent at c. */
enum pm_status pm_jacobian(struct pm_model *m, const struct pm_config *c, double scale, double *Jq,
                           double *J, struct pm_err *err);

/* Nodal gradient D = dw/dX (nn x 3) and D_ref = dw/dX_ref of w(U, J) at fixed loads, from a = dw/dU
 * (6) and b = dw/dJ (6 x nc) with J per `scale` MPa; p [MPa], f nodal forces at c. */
enum pm_status pm_adjoint(struct pm_model *m, const struct pm_config *c, const double *p,
                          const double *f, double scale, const double *Jq, const double a[6],
                          const double *b, double *D, double D_ref[3], struct pm_err *err);

#endif
