/* Control points from points of a surface: iterated Tikhonov [paper 77 iterated, model 9 step 3],
 * psi <- argmin sum_q w_q |target_q - sum_m c_m(S_q) psi_m|^2 + alpha |psi - psi_previous|^2. */
#ifndef PM_FIT_H
#define PM_FIT_H

#include "common/geometry/surface_map.h"

struct pm_fit {
    ptrdiff_t nq;         /* samples */
    const double *S;      /* their parameters (nq x 3) */
    const double *weight; /* scaled inside to the sum n (nq) */
    const double *target; /* wanted points (nq x 3) [mm] */
    double alpha;         /* about 0.1 */
    int iterations;       /* 1 is (77) itself */
    const uint8_t *fixed; /* 1: coordinate keeps its value (n x 3), NULL: none */
};

/* The same samples for many targets: the system is factored once. */
struct pm_fitter;
/* Of fit, the target and the iterations are not looked at. */
enum pm_status pm_fitter_new(const struct pm_map *map, ptrdiff_t n, const struct pm_fit *fit,
                             struct pm_fitter **fitter, struct pm_err *err);
void pm_fitter_free(struct pm_fitter *fitter);
/* psi (n x 3): in the start (the target at the control points), out the fitted control points.
 * error: rms and largest of |target - r| over the samples [mm]. */
enum pm_status pm_fitter_solve(struct pm_fitter *fitter, const double *target, int iterations,
                               double *psi, double error[2], struct pm_err *err);
/* All in one. */
enum pm_status pm_fit_points(const struct pm_map *map, ptrdiff_t n, const struct pm_fit *fit,
                             double *psi, double error[2], struct pm_err *err);

#endif
