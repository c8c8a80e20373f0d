/* Decisions of the trust region [model 8]: accept or reject, radius, penalty weights, verdict. */
#ifndef TRSTEP_TRUST_H
#define TRSTEP_TRUST_H

#include "common/files/step.h"
#include "common/files/work.h"

struct judgement {
    int accepted;
    int renewed;      /* the accepted design on a new mesh: nothing to judge but that it works */
    int worn;         /* the mesh did not bear the step: it says nothing of the design */
    double ratio;     /* actual over predicted gain of merit, 0 where there is none */
    char reason[160]; /* of a rejection, "" */
};

/* What the failures of tetmesh --keep-mesh begin with. */
#define TRUST_WORN "tetmesh: worn mesh"

/* previous NULL: the first design, accepted unless it records a failure; so is a renewed one.
 * Otherwise accepted if T itself rose, unless the step gave it up for less violation, and the merit
 * rose by at least a tenth of the prediction, and no state pierces itself where the case wants
 * that and those of the last accepted design did not. */
void trust_judge(const struct pm_step *previous, const struct pm_work *work, struct judgement *j);
/* Radius after a judged trial: ratio below 0.1 or rejected: a third of the step; up to 0.3: 1/1.5;
 * above 0.75 with the step at a bound: 1.5 times, at most radius_max of the case; kept where the
 * design was renewed, and where the mesh was worn unless it was new. */
double trust_radius(const struct pm_step *previous, const struct judgement *j);
/* Is it time to renew control points and mesh before the next trial? Where the mesh was worn (and
 * not new), and at every remesh_every-th trial. trials (n), the last one just judged by j. */
int trust_renew(const struct pm_case *c, const struct pm_trial *trials, ptrdiff_t n,
                const struct judgement *j);
/* "converged": T changed by less than the tolerance over five accepted trials that moved the
 * surfaces by the first radius together, renewals not counted; "stalled": the
 * radius is below a hundredth of its start; "continue". */
const char *trust_verdict(const struct pm_case *c, const struct pm_trial *trials, ptrdiff_t n,
                          double radius);
/* T - rho_c C_c - rho_t C_t. */
double trust_merit(double value, const double weight[2], const double penalty[2]);

#endif
