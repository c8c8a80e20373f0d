/* Derivatives of the equilibrium path q(lambda) at pressures p + lambda dp. */
#ifndef PM_PATH_H
#define PM_PATH_H

#include "common/mechanics/model.h"

/* dq = K^-1 T^T sum_r dp_r dV_r and ddq = - K^-1 (D3 Pi[dq, dq, .] + 2 sum_r dp_r dK/dp_r dq):
 * first and second derivative of the path at the equilibrium c (q-vectors), with the factor that
 * the model holds; f nodal forces at c, p and dp [MPa]. The second takes the strain out that a
 * linear step of rotating parts leaves. */
enum pm_status pm_path_derivatives(struct pm_model *m, const struct pm_config *c, const double *p,
                                   const double *f, const double *dp, double *dq, double *ddq,
                                   struct pm_err *err);

#endif
