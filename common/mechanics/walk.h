/* Equilibria of one mesh at one set of pressures after the other, each by continuation from the
 * last. */
#ifndef PM_WALK_H
#define PM_WALK_H

#include "common/files/sweep.h"
#include "common/mechanics/equilibrium.h"

struct pm_walk {
    struct pm_model *m;
    struct pm_solve_options options;
    const char *const *guess; /* states for the first point, ends with NULL; borrowed */
    struct pm_config last;    /* the last equilibrium, the undeformed state before the first */
    double *at;               /* its pressures                          (nc) [MPa] */
    double *J;                /* its dU/d(p/mu)                     (6 x nc) [mm, rad] */
    double *volume;           /* its chambers                           (nc) [mm3] */
    int begun;                /* there is one */
    struct pm_solve_report r; /* of the last step */
    struct pm_config c;       /* what follows is memory for a step */
    double *p, *f, *Jq;
};

/* At rest; `mesh` and `guess` stay the caller's. */
enum pm_status pm_walk_new(const struct pm_mesh *mesh, const char *element, double tolerance,
                           const char *const *guess, struct pm_walk *w, struct pm_err *err);
/* The equilibrium at the pressures p (nc) [p/mu], with its Jacobian. PM_NUMERIC: there is none that
 * the last one leads to, and that stays the last one. */
enum pm_status pm_walk_step(struct pm_walk *w, const double *p, struct pm_err *err);
/* The last equilibrium as point i of s, but for its pressures and its factorisations. */
enum pm_status pm_walk_record(const struct pm_walk *w, struct pm_sweep *s, ptrdiff_t i,
                              struct pm_err *err);
void pm_walk_release(struct pm_walk *w);

#endif
