/* The integrand of measure 2R on one edge of its path [model 7.2]. */
#ifndef PM_POINTING_H
#define PM_POINTING_H

#include "common/actuation/loads.h"

/* w = sign c/(1 + n_z), c = n_x d_y - n_y d_x, n = R(theta) e_z, d = dn/dp of the pressure that
 * varies; its integral along a closed path is the solid angle that n encloses, counted from +e_z.
 * dw_dU (6) and dw_dJ (6 x nc) are set where they are not zero. PM_NUMERIC within 1e-3 of the pole
 * n = -e_z. */
enum pm_status pm_pointing_point(const struct pm_load *load, int nc, const double U[6],
                                 const double *J, double *w, double dw_dU[6], double *dw_dJ,
                                 struct pm_err *err);

#endif
