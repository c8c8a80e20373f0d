/* Newton's method at fixed loads, for steps as long as they can be: mixed integration points far
 * from the solution, steps that turn (warp.h), and near it the factor at hand with conjugate
 * gradients. */
#ifndef PM_NEWTON_H
#define PM_NEWTON_H

#include "common/mechanics/equilibrium.h"
#include "common/mechanics/warp.h"

struct pm_newton {
    struct pm_model *m;
    const struct pm_solve_options *o;
    struct pm_solve_report *r;
    double *p;          /* pressures (nc) [MPa] */
    double *f, *volume; /* at the configuration evaluated last: nodal forces (nn x 3), chamber
                           volumes (nc) */
    double *g;          /* its residual (nq) */
    double residual;    /* |g|_inf / load_norm */
    double Pi, load_norm;
    pm_lanes *mixed;    /* independent pressures and stresses for the next tangent */
    double *dq, *nodal; /* correction (nq), (nn x 3) */
    struct pm_config trial;
    struct pm_warp *warp;
    int settles; /* corrections left that an indefinite tangent is replaced in, backoffs all */
};

/* f (nn x 3) and volume (nc) are the caller's. */
enum pm_status pm_newton_new(struct pm_model *m, const struct pm_solve_options *o,
                             struct pm_solve_report *r, double *f, double *volume,
                             struct pm_newton *s, struct pm_err *err);
void pm_newton_release(struct pm_newton *s);

/* load_norm: the largest generalised load of the pressures p on the undeformed body. */
void pm_newton_measure_load(struct pm_newton *s, const double *p);
/* Residual at c; 0 if an element is inverted or too flat. */
int pm_newton_evaluate(struct pm_newton *s, const struct pm_config *c);
/* Keeps the reason in the report; returns 0. */
int pm_newton_refuse(struct pm_newton *s, const char *why, double value);
/* From c to the equilibrium at s->p, residual `tolerance`. mixed: s->mixed holds the stresses for
 * the first tangent. *reached = 0, with the reason in the report: no convergence, or a tangent that
 * is not positive definite. */
enum pm_status pm_newton_solve(struct pm_newton *s, struct pm_config *c, double tolerance,
                               int mixed, int *reached, struct pm_err *err);

#endif
