/* Gradient of the measure at one Gauss point with respect to the control points. Kind `sens`. */
#ifndef PM_SENS_H
#define PM_SENS_H

#include "common/files/case.h"
#include "common/files/h5.h"

struct pm_sens {
    struct pm_case pcase;
    int64_t form, load;
    ptrdiff_t N;
    double *gradient; /* dw_g/dphi (N x 3), not projected on the symmetric subspace */
    double identity_translation, identity_scaling,
        identity_rotation; /* relative defects of the nodal gradient [model 4.3] */
};

enum pm_status pm_sens_load(const char *path, struct pm_sens *s, struct pm_err *err);
enum pm_status pm_sens_write(struct pm_h5 *f, const struct pm_sens *s, struct pm_err *err);
void pm_sens_release(struct pm_sens *s);

#endif
