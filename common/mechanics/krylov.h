/* Systems with the tangent at hand by conjugate gradients, preconditioned by an earlier factor. */
#ifndef PM_KRYLOV_H
#define PM_KRYLOV_H

#include "common/mechanics/model.h"

struct pm_krylov_report {
    int steps;             /* of conjugate gradients, each one triangular solve */
    int good;              /* 1: converged within the limit and without negative curvature */
    double gamma;          /* of the stiffening */
    double least, largest; /* Ritz values: bounds from inside on the eigenvalues of factor^-1 K */
};

/* x (nq x n, column after column) holds K^-1 x on return, K in m->value, where report->good; else
 * the best found. To residuals of `tolerance` relative to the given; at most `limit` steps. All
 * columns go in step: a triangular solve of many costs little more than of one.
 */
enum pm_status pm_krylov_solve(struct pm_model *m, double *x, ptrdiff_t n, double tolerance,
                               int limit, struct pm_krylov_report *report, struct pm_err *err);

/* The same with K + gamma b b^T (b: nq) for K, gamma = 10 over b . factor^-1 b: the solutions with
 * prescribed b . x are those of K, and it is positive definite where K is so for b . x = 0, as past
 * a limit point. */
enum pm_status pm_krylov_solve_stiffened(struct pm_model *m, const double *b, double *x,
                                         ptrdiff_t n, double tolerance, int limit,
                                         struct pm_krylov_report *report, struct pm_err *err);

#endif
