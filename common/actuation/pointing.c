#include "common/actuation/pointing.h"

#include "common/mechanics/rotation.h"

enum pm_status pm_pointing_point(const struct pm_load *load, int nc, const double U[6],
                                 const double *J, double *w, double dw_dU[6], double *dw_dJ,
                                 struct pm_err *err)
{
    enum { X, Y, Z };
    const int v = load->face;
    struct pm_rotation rot;
    double n[3], n_k[3][3], d[3] = {0, 0, 0}; /* n_k[k][i] = dn_i/dtheta_k */

    pm_rotation_at(U + 3, 0, &rot);
    for (int i = 0; i < 3; i++) {
        n[i] = rot.R[3 * i + 2];
        for (int k = 0; k < 3; k++) {
            n_k[k][i] = rot.Ri[k][3 * i + 2];
            d[i] += n_k[k][i] * J[nc * (3 + k) + v];
        }
    }
    const double below = 1 + n[Z], c = n[X] * d[Y] - n[Y] * d[X];
    if (below < 1e-3)
        return pm_fail(
            err, PM_NUMERIC,
            "the end-effector points along -z (n_z = %.6f), where measure 2R is singular", n[Z]);
    *w = load->sign * c / below;
    for (int k = 0; k < 3; k++) {
        double dd[3] = {0, 0, 0}; /* d(d)/dtheta_k */
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                dd[i] += rot.Rij[j][k][3 * i + 2] * J[nc * (3 + j) + v];
        const double dc = n_k[k][X] * d[Y] + n[X] * dd[Y] - n_k[k][Y] * d[X] - n[Y] * dd[X];
        dw_dU[3 + k] = (load->sign * dc - *w * n_k[k][Z]) / below;
        dw_dJ[nc * (3 + k) + v] = load->sign * (n[X] * n_k[k][Y] - n[Y] * n_k[k][X]) / below;
    }
    return PM_OK;
}
