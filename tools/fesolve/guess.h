/* An equilibrium of another load, a neighbouring shape or another mesh as a first guess. */
#ifndef PM_FESOLVE_GUESS_H
#define PM_FESOLVE_GUESS_H

#include "common/files/state.h"
#include "common/mechanics/equilibrium.h"

struct guess {
    struct pm_state from;
    double *at;      /* its pressures (nc) [MPa] */
    pm_lanes *mixed; /* of the elements where it was carried to [MPa] */
    int usable;
    int same_mesh; /* but for the positions of its nodes */
};

/* The one of the files (ends with NULL) whose pressures are nearest to p (nc) [MPa]; usable = 0,
 * with warnings, where all record a failure or have other chambers. */
enum pm_status guess_choose(const char *const *paths, const struct pm_mesh *mesh, const double *p,
                            struct guess *g, struct pm_err *err);
void guess_release(struct guess *g);
/* c = the guess carried to the mesh of m. The same connectivity: pm_warp_carry, with g->mixed;
 * another one: transfer.h and relax.h, no g->mixed. *good = 0 where that fails. The counts of r
 * grow by theirs. */
enum pm_status guess_carry(struct guess *g, struct pm_model *m, struct pm_config *c, int *good,
                           struct pm_solve_report *r, struct pm_err *err);

#endif
