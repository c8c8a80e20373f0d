/* Workspace measures w(U, J) per point [theory 7]; T = sigma * sum weight * w. */
#ifndef PM_MEASURE_H
#define PM_MEASURE_H

#include "common/actuation/loads.h"

/* Contribution of one point before sigma and weight: w, dw/dU (6), dw/dJ (6 x n), J is (6 x n) per unit of
 * p/mu. Boundary form: (sign/n) det(J with column `face` replaced by F(U)); volume form: density * det J. */
enum pm_status pm_measure_point(const struct pm_case *c, enum pm_form form, const struct pm_load *load,
                                const double U[6], const double *J, double *w, double dw_dU[6],
                                double *dw_dJ, struct pm_err *err);
/* det of the selected rows of J. */
double pm_measure_det(const struct pm_case *c, const double *J);
const char *pm_measure_unit(const struct pm_case *c);

#endif
