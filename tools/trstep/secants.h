/* Curvature of the objective from the last accepted steps: s_k = phi_k+1 - phi_k, y_k = the change
 * of the gradient. The symmetric B of least change (Powell's symmetric Broyden update, oldest pair
 * first, B = 0 before) in the metric M of the steps:
 *
 *   B <- B + (r z' + z r')/(z.s) - (r.s) z z'/(z.s)^2,  r = y - B s,  z = M s   [model 8]
 *
 * so that B s = y for the last pair; unlike positive definite updates it keeps both signs. */
#ifndef TRSTEP_SECANTS_H
#define TRSTEP_SECANTS_H

#include "common/files/step.h"

struct secants {
    ptrdiff_t n, count; /* unknowns 3 N, pairs */
    double *r, *z;      /* (count x n) */
    double *zs, *rs;    /* (count) */
};

/* mass (N) as in subproblem.h. */
enum pm_status secants_new(const struct pm_step *s, const double *mass, struct secants *m,
                           struct pm_err *err);
void secants_release(struct secants *m);
/* d.B d/2 */
double secants_value(const struct secants *m, const double *d);
/* The same; slope (n) += factor B d. */
double secants_at(const struct secants *m, const double *d, double factor, double *slope);

/* The pairs of the previous step and, where there was one, that of the step now accepted, at most
 * `most`; none where the control points are others. */
enum pm_status secants_collect(const struct pm_step *before, ptrdiff_t most, struct pm_step *s,
                               struct pm_err *err);

#endif
