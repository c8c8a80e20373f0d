/* Weight over the workspace: where the poses count [model 7.5]. */
#ifndef PM_WEIGHT_H
#define PM_WEIGHT_H

#include "common/files/case.h"

/* rho(y) and its gradient over U (6), y = U_1..3 [mm] or R(theta) e_z. s(d) = (1 +
 * tanh(d/width))/2: none        1 box         prod_i s(y_i - c_i + a_i) s(c_i + a_i - y_i) gaussian
 * exp(-sum_i (y_i - c_i)^2/(2 a_i^2)) half-space  s((y - c).n) */
double pm_weight_at(const struct pm_weight *k, const double U[6], double grad[6]);
/* 1 if rho(Q y) = rho(y) for all y; Q orthogonal (3 x 3), keeps e_z. */
int pm_weight_keeps(const struct pm_weight *k, const double *Q);

#endif
