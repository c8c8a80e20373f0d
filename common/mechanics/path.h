/* Derivatives of the equilibrium path q(lambda) at pressures p + lambda dp. */
#ifndef PM_PATH_H
#define PM_PATH_H

#include "common/mechanics/model.h"

/* First and second derivative of the node positions along the path at the equilibrium c (nodal, nn
 * x 3), from those of the unknowns, dq = K^-1 T^T sum_r dp_r dV_r,  ddq = - K^-1 (D3 Pi[dq, dq, .]
 * + 2 sum_r dp_r dK/dp_r dq), to three or four digits; f nodal forces at c, p and dp [MPa].
 * *definite = 0: the tangent is not positive definite, and nothing is computed. */
enum pm_status pm_path_derivatives(struct pm_model *m, const struct pm_config *c, const double *p,
                                   const double *f, const double *dp, double *du1, double *du2,
                                   int *definite, struct pm_err *err);

#endif
