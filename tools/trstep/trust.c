#include "tools/trstep/trust.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WINDOW = 5 }; /* accepted trials of the convergence test (paper) */

double trust_merit(double value, const double weight[2], const double penalty[2])
{
    return value - weight[0] * penalty[0] - weight[1] * penalty[1];
}

static int count_pierced(const struct pm_work *work)
{
    int n = 0;
    for (ptrdiff_t g = 0; g < work->ng; g++)
        n += work->intersections[g] > 0;
    return n;
}

/* Does the design that the trial starts from pierce itself? */
static int starts_pierced(const struct pm_step *previous)
{
    for (ptrdiff_t i = previous->ntrials - 1; i >= 0; i--)
        if (previous->trials[i].accepted)
            return !(previous->trials[i].gap > 0 || previous->trials[i].gap < 0);
    return 0;
}

void trust_judge(const struct pm_step *previous, const struct pm_work *work, struct judgement *j)
{
    *j = (struct judgement){.renewed = previous != NULL && previous->renew};
    if (work->failure[0] != '\0') {
        snprintf(j->reason, sizeof j->reason, "%.150s", work->failure);
        j->worn = strncmp(work->failure, TRUST_WORN, strlen(TRUST_WORN)) == 0;
        return;
    }
    if (previous == NULL || j->renewed) {
        j->accepted = 1;
        return;
    }
    const int pierced = previous->trial.pcase.contact_rejects && !starts_pierced(previous)
                            ? count_pierced(work)
                            : 0;
    const double before = trust_merit(previous->value, previous->weight, previous->penalty);
    const double after = trust_merit(work->objective, previous->weight, previous->trial_penalty);
    const double promised =
        trust_merit(previous->value + previous->gain, previous->weight, previous->trial_penalty) -
        before;
    j->ratio = promised > 0 ? (after - before) / promised : 0;
    if (pierced > 0)
        snprintf(j->reason, sizeof j->reason, "the body penetrates itself in %d of %td states",
                 pierced, work->ng);
    else if (!(work->objective > previous->value) && !(previous->gain < 0))
        snprintf(j->reason, sizeof j->reason, "the objective fell by %.3g %%",
                 100 * (1 - work->objective / previous->value));
    else if (!(j->ratio >= 0.1))
        snprintf(j->reason, sizeof j->reason,
                 "the merit rose by %.2g of the prediction, expected 0.1", j->ratio);
    else
        j->accepted = 1;
}

/* Was the mesh of trial i new? */
static int fresh(const struct pm_trial *trials, ptrdiff_t i)
{
    return i == 0 || trials[i].renewed;
}

double trust_radius(const struct pm_step *previous, const struct judgement *j)
{
    const struct pm_case *c = &previous->trial.pcase;
    const double bound =
        fmax(previous->rms_step / previous->radius, previous->max_step / (2 * previous->radius));
    if ((j->renewed && j->accepted) || (j->worn && !fresh(previous->trials, previous->ntrials - 1)))
        return previous->radius;
    if (!j->accepted) { /* of the step itself: constraints may have made it shorter than the radius
                         */
        const double step = fmax(previous->rms_step, previous->max_step / 2);
        return (step > 0 ? fmin(step, previous->radius) : previous->radius) / 3;
    }
    if (j->ratio < 0.3)
        return previous->radius / 1.5;
    if (j->ratio > 0.75 && bound > 0.95)
        return fmin(previous->radius * 1.5, c->radius_max);
    return previous->radius;
}

int trust_renew(const struct pm_case *c, const struct pm_trial *trials, ptrdiff_t n,
                const struct judgement *j)
{
    ptrdiff_t since = 0;
    if (j->worn && n > 1 && !fresh(trials, n - 2))
        return 1;
    while (since < n - 1 && !trials[n - 1 - since].renewed)
        since++;
    return c->remesh_every > 0 && since >= c->remesh_every - 1 && since > 0;
}

const char *trust_verdict(const struct pm_case *c, const struct pm_trial *trials, ptrdiff_t n,
                          double radius)
{
    double last = 0, early = 0, way = 0;
    int count = 0;
    for (ptrdiff_t i = n - 1; i >= 0 && count <= WINDOW; i--)
        if (trials[i].accepted && (i == 0 || !trials[i].renewed)) {
            last = count == 0 ? trials[i].measure : last;
            early = trials[i].measure;
            way += count < WINDOW ? trials[i].rms_step : 0;
            count++;
        }
    if (count > WINDOW && trials[n - 1].accepted && way >= c->radius &&
        fabs(last - early) < c->tolerance * fabs(last))
        return "converged";
    return radius < c->radius / 100 ? "stalled" : "continue";
}
