/* Gauss sets of the actuation box [pmin, pmax]^n, reduced by the symmetry of the case [theory 7.3, 7.4]. */
#ifndef PM_LOADS_H
#define PM_LOADS_H

#include "common/files/case.h"

struct pm_load {
    double p[PM_MAX_CHAMBERS]; /* [p/mu] */
    int face;      /* boundary form: r of the face p_r = const; -1 in the volume form */
    int sign;      /* boundary form: +1 on p_r = pmax, -1 on p_r = pmin; volume form: +1 */
    double weight; /* tau = multiplicity * quadrature weight [(p/mu)^(n-1) or (p/mu)^n] */
};

/* The points of one form, in a fixed order; *loads is new memory (pm_free). */
enum pm_status pm_load_set(const struct pm_case *c, enum pm_form form, struct pm_load **loads,
                           ptrdiff_t *n, struct pm_err *err);

#endif
