/* Stable static equilibrium by load continuation: predictors of first and second order, Newton
 * (newton.h), step halving where the factor, an inverted element or a lack of convergence says no.
 */
#ifndef PM_EQUILIBRIUM_H
#define PM_EQUILIBRIUM_H

#include "common/mechanics/model.h"

struct pm_solve_options {
    double tolerance;  /* |g|_inf / |pressure load|_inf at the solution */
    double first_step; /* of the load parameter, 0..1 */
    double min_step;   /* below it the path has ended */
    double min_det;    /* a trial with smaller det F is refused */
    int max_newton;    /* per load step */
};

extern const struct pm_solve_options pm_solve_default;

struct pm_solve_report {
    long load_steps, newton_steps, factorisations, solves, backoffs;
    int warm;        /* 1: the guess led to the solution, 0: from the undeformed state */
    double lambda;   /* load parameter reached */
    double residual; /* relative, at the solution */
    double min_det_F;
    double energy; /* strain energy [mJ] */
    char why[192]; /* last reason of a back-off */
};

/* A guess in c: the loads it belongs to, and the pressures in its elements or NULL. */
struct pm_guess {
    const double *at;      /* (nc) [MPa] */
    const pm_lanes *mixed; /* as pm_model_mixed [MPa] */
    int only;              /* 1: no other start where the guess fails */
};

/* Equilibrium at pressures p (nc) [MPa] into c, with the model ready for solves with its exact
 * tangent. guess NULL: from the undeformed state; else c holds a guess, corrected at its own loads
 * and followed from there to p. PM_NUMERIC with the load reached and the last reason if that does
 * not lead to a stable equilibrium; c is then the last one on the way, roughly (at r->lambda).
 * volume (nc) and f (nn x 3): chamber volumes and nodal forces at
 * the solution. */
enum pm_status pm_equilibrium(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                              const struct pm_guess *guess, struct pm_config *c, double *volume,
                              double *f, struct pm_solve_report *r, struct pm_err *err);

#endif
