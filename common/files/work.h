/* The workspace measure with its derivatives. Kind `work`. */
#ifndef PM_WORK_H
#define PM_WORK_H

#include "common/files/case.h"
#include "common/files/h5.h"

struct pm_work {
    struct pm_case pcase;
    char failure[512];    /* "" or the failure of a state */
    double value;         /* the measure T = sum_g w_g */
    double objective;     /* f h T, what is optimised (amplification.h, closeness.h) */
    double amplification; /* largest of the points */
    double closeness;     /* sum of the points of the full set (closeness.h) [1] */
    char name[16], unit[16];
    int64_t form;
    double orientation;      /* sigma = +1 or -1, frozen at the first design */
    double value_other;      /* the other form, 0 if its states were not given */
    double quadrature_error; /* |value - value_other| / |value|, -1 if not known */
    double min_det,
        max_det; /* of J (selected rows) times sigma over all points: a sign change is a fold */
    int64_t sign_changes;
    int64_t branch_jumps; /* points whose rotation vector and the one at the nearest pressures lie
                             on different branches */
    double max_rotation, max_tilt; /* largest |theta|, largest angle of pointing to +z [rad] */
    ptrdiff_t ng, nc;              /* points of the chosen form, chambers */
    int64_t *load;                 /* index in the Gauss set    (ng) */
    double *pressure;              /* (ng x nc) [p/mu] */
    double *U;                     /* (ng x 6) */
    double *J;                     /* (ng x 6 x nc) */
    double *w;                     /* contribution, sigma and weight included (ng) */
    double *dw_dU;                 /* derivatives of the objective (ng x 6) */
    double *dw_dJ;                 /* (ng x 6 x nc) */
    int64_t *intersections;        /* of the deformed boundary with itself (ng) */
    double *gap;                   /* least distance across air, -1: wide (ng) [mm] */
    double *closeness_at;          /* G (ng) */
    double *dw_dG;                 /* derivative of the objective by it (ng) */
};

enum pm_status pm_work_load(const char *path, int allow_failure, struct pm_work *w,
                            struct pm_err *err);
enum pm_status pm_work_write(struct pm_h5 *f, const struct pm_work *w, struct pm_err *err);
void pm_work_release(struct pm_work *w);

#endif
