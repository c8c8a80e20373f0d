/* The trust-region sub-problem [paper 81, model 8]: minimise -G.step + rho_c C_c + rho_t C_t over
 * the symmetric free steps with |step|_M <= radius and no control point moved by more than 2
 * radius, |step|_M^2 = sum_m M_m |step_m|^2 / area, M lumped: the mean square displacement of the
 * surfaces.
 */
#ifndef TRSTEP_SUBPROBLEM_H
#define TRSTEP_SUBPROBLEM_H

#include "common/geometry/penalty.h"

/* What the solver minimises besides the linear term; gradient += , returns the value. */
typedef double (*subproblem_penalty)(void *context, const double *step, double *gradient);

struct subproblem {
    ptrdiff_t N;            /* control points */
    const double *gradient; /* G, projected on the symmetric free subspace (N x 3) */
    const double *mass;     /* M_m / area, equal on every symmetry orbit (N) */
    double radius;          /* [mm] */
    subproblem_penalty penalty;
    void (*project)(void *context,
                    double *v); /* on the symmetric free subspace, in place (N x 3) */
    void *context;
};

/* step (N x 3): in the start, out the minimiser (L-BFGS; the bounds by penalties, then exactly by
 * scaling and clipping). PM_NUMERIC if the gradient is zero. */
enum pm_status subproblem_solve(const struct subproblem *s, double *step, struct pm_err *err);
double subproblem_norm(const struct subproblem *s, const double *step);
/* Dual norm of a gradient: the largest G.step with |step|_M <= 1. */
double subproblem_dual_norm(const struct subproblem *s, const double *gradient);

#endif
