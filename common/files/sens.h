/* Shape derivatives at one load. Kind `sens`. */
#ifndef PM_SENS_H
#define PM_SENS_H

#include "common/files/case.h"
#include "common/files/h5.h"

/* Derivatives of every U_l, J_lr, V_r (deformed chamber volumes) and C_rs = dV_r/d(p_s/mu), in this
 * order, last index fastest: (6 + 6 nc + nc + nc nc) x n x 3, by the positions of n points. */
struct pm_entries {
    ptrdiff_t n;
    double *d; /* NULL: not computed */
};

struct pm_sens {
    struct pm_case pcase;
    int64_t form, load;
    int64_t shape_form; /* enum pm_shape_form of common/mechanics/adjoint.h */
    ptrdiff_t N;        /* control points, 0: none */
    double *gradient;   /* dw_g/dphi (N x 3), not projected on the symmetric subspace; NULL: no work
                           file was given */
    ptrdiff_t nclose;   /* regions where the state is close to itself (geometry/closeness.h) */
    double *close_value;    /* G of them (nclose) */
    double *close_gradient; /* their derivatives, as the gradient (nclose x N x 3) */
    double identity_translation, identity_scaling,
        identity_rotation; /* relative defects of the nodal gradient [model 4.3], domain form */
    ptrdiff_t nc;
    double *compliance;            /* C (nc x nc) [mm3], with the entries */
    struct pm_entries each, nodal; /* by control points, by nodes */
};

/* Number of entries of nc chambers. */
ptrdiff_t pm_entries_count(ptrdiff_t nc);
/* A file without gradient is PM_INPUT: its entries are for other programs. */
enum pm_status pm_sens_load(const char *path, struct pm_sens *s, struct pm_err *err);
enum pm_status pm_sens_write(struct pm_h5 *f, const struct pm_sens *s, struct pm_err *err);
void pm_sens_release(struct pm_sens *s);

#endif
