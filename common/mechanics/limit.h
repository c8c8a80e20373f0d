/* The limit point of an equilibrium path: the largest pressure that a body can bear, beyond which
 * it snaps through or balloons. Near it the volume is prescribed instead of the pressure. */
#ifndef PM_LIMIT_H
#define PM_LIMIT_H

#include "common/mechanics/equilibrium.h"

struct pm_limit {
    int found;      /* 0: the whole of p is reached */
    double factor;  /* limit pressures over p */
    double reached; /* those of c over p */
    long steps;     /* equilibria with prescribed volume */
};

/* Follows the pressures p (nc) [MPa] from zero. c: the equilibrium at p or the last stable one,
 * with volume and f as pm_equilibrium has them. The limit is where the slope of the load factor
 * over sum_r p_r V_r vanishes: secants on prescribed values of that sum, with the tangent K + gamma
 * b b^T (b its gradient), positive definite past the limit too. */
enum pm_status pm_limit_find(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                             struct pm_config *c, double *volume, double *f,
                             struct pm_solve_report *r, struct pm_limit *limit, struct pm_err *err);

#endif
