#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/penalty.h"
#include "common/geometry/symmetry.h"
#include "tools/trstep/gaps.h"
#include "tools/trstep/secants.h"
#include "tools/trstep/subproblem.h"
#include "tools/trstep/trstep.h"

/* Largest relative violations of curvature and walls: where the multipliers are left, and what no
 * proposal exceeds unless its start does. */
static const double WANTED[2] = {0.02, 0.008}, ALLOWED[2] = {0.05, 0.02};
/* rho of the augmented Lagrangian at the start over slope * wall_min, its growth where a round
 * leaves more than SLOW of a violation. Weights of the merit over slope * wall_min. A proposal that
 * gains less than LEAST_GAIN of the measure is none. */
static const double STIFFNESS = 150, GROWTH = 3, SLOW = 0.3, MERIT = 40, LEAST_GAIN = 1e-6;
/* A proposal that the constraints make shorter than the radius leaves it at most so much longer. */
static const double SHORTER = 4;
enum { ROUNDS = 12, HALVINGS = 8, REVISIONS = 3 };

struct proposal {
    struct pm_step *s;
    struct pm_penalty penalty;
    struct secants secants;
    ptrdiff_t N;
    double rho[2];
    double peak;   /* violation of curvature that new samples see: recorded, not refused */
    double *phi;   /* accepted control points (N x 3) [mm] */
    double *step;  /* (N x 3) [mm] */
    double *trial; /* phi + step, scratch (N x 3) */
    double *mass;  /* (N) */
};

static void move(struct proposal *p, const double *step)
{
    for (ptrdiff_t i = 0; i < 3 * p->N; i++)
        p->trial[i] = p->phi[i] + step[i];
}

/* All but the linear term. */
static double penalise(void *context, const double *step, double *gradient)
{
    struct proposal *p = context;
    struct pm_penalty_value v;
    move(p, step);
    pm_penalty_at(&p->penalty, p->trial, p->rho, gradient, &v);
    return v.lagrangian - secants_at(&p->secants, step, -1, gradient) +
           gaps_at(p->s, step, 1, gradient);
}

static void project(void *context, double *v)
{
    const struct proposal *p = context;
    pm_symmetrise_vectors(&p->s->accepted, v);
}

static struct subproblem subproblem_of(struct proposal *p)
{
    return (struct subproblem){.N = p->N,
                               .gradient = p->s->gradient,
                               .mass = p->mass,
                               .radius = p->s->radius,
                               .penalty = penalise,
                               .project = project,
                               .context = p};
}

static double weighted(const struct pm_step *s, const double sum[2])
{
    return s->weight[0] * sum[0] + s->weight[1] * sum[1];
}

/* No point moves further than 2 radii: what is within reach cannot be crossed unseen. */
static double reach(const struct pm_step *s)
{
    return fmax(4 * s->radius - s->accepted.pcase.wall_min, s->radius / 2);
}

/* All constraints at phi, as the samples of q see them. */
static enum pm_status measure(const struct proposal *p, struct pm_penalty *q, const double *phi,
                              double sum[2], double worst[2], struct pm_err *err)
{
    enum pm_status status;
    struct pm_penalty_value v;

    PM_TRY(pm_penalty_collect(q, phi, reach(p->s), 0.8, err));
    pm_penalty_at(q, phi, p->rho, NULL, &v);
    memcpy(sum, v.sum, sizeof v.sum);
    memcpy(worst, v.worst, sizeof v.worst);
done:
    return status;
}

/* Is the proposal fit for use? What the start violates must not get worse. */
static int fit(const struct pm_step *s, const double limit[2])
{
    for (int k = 0; k < 2; k++)
        if (s->trial_worst[k] > limit[k] && !(s->trial_worst[k] <= s->worst[k] && limit != WANTED))
            return 0;
    return 1;
}

static enum pm_status complete(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    const struct subproblem problem = subproblem_of(p);

    PM_TRY(measure(p, &p->penalty, p->trial, s->trial_penalty, s->trial_worst, err));
    s->gain = secants_value(&p->secants, p->step) - gaps_at(s, p->step, 0, NULL);
    s->max_step = 0;
    for (ptrdiff_t i = 0; i < 3 * p->N; i++)
        s->gain += s->gradient[i] * p->step[i];
    for (ptrdiff_t m = 0; m < p->N; m++) {
        const double *d = p->step + 3 * m;
        s->max_step = fmax(s->max_step, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    }
    s->rms_step = subproblem_norm(&problem, p->step);
done:
    return status;
}

/* Method of multipliers at the present radius [model 8]; feet follow the surfaces between the
 * rounds. */
static enum pm_status solve(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    const struct subproblem problem = subproblem_of(p);
    double last[2] = {HUGE_VAL, HUGE_VAL};

    for (int round = 0; round < ROUNDS; round++) {
        PM_TRY(subproblem_solve(&problem, p->step, err));
        const double part = pm_penalty_safe_part(&p->penalty, p->phi, p->step);
        for (ptrdiff_t i = 0; i < 3 * p->N; i++)
            p->step[i] *= part;
        move(p, p->step);
        pm_penalty_raise(&p->penalty, p->trial, p->rho);
        PM_TRY(complete(p, err));
        pm_log(2, "round %d: gain %.4g, violations %.4f %.4f, %td walls, step %.3g, part %g", round,
               s->gain, s->trial_worst[0], s->trial_worst[1], p->penalty.nwall, s->rms_step, part);
        if (fit(s, WANTED))
            break;
        for (int k = 0; k < 2; k++) {
            if (s->trial_worst[k] > fmax(WANTED[k], SLOW * last[k]))
                p->rho[k] *= GROWTH;
            last[k] = s->trial_worst[k];
        }
    }
done:
    return status;
}

/* Samples placed for the proposal, with its constraints and what they see of it. */
static enum pm_status look(struct proposal *p, struct pm_penalty *fresh, double seen[2],
                           struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    double sum[2];

    move(p, p->step);
    pm_symmetrise_points(&s->accepted, p->trial);
    pm_surfaces_scatter(&s->trial, p->trial);
    PM_TRY(pm_penalty_new(&s->trial, fresh, err));
    PM_TRY(measure(p, fresh, p->trial, sum, seen, err));
done:
    return status;
}

/* Solves, and again with samples placed for the proposal where these see it violate what the
 * earlier ones did not. */
static enum pm_status solve_seen(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    struct pm_penalty fresh = {.s = NULL};
    double seen[2] = {0};

    p->peak = 0;
    for (int k = 0; k <= REVISIONS; k++) {
        PM_TRY(solve(p, err));
        if (!fit(s, ALLOWED))
            goto done;
        pm_penalty_release(&fresh);
        PM_TRY(look(p, &fresh, seen, err));
        pm_log(2, "seen: %.4f %.4f", seen[0], seen[1]);
        const double held = s->trial_worst[0];
        for (int j = 0; j < 2; j++)
            s->trial_worst[j] = fmax(s->trial_worst[j], seen[j]);
        const int good = fit(s, ALLOWED);
        s->trial_worst[0] = held; /* peaks of curvature that only new samples see are recorded */
        p->peak = seen[0];
        if (good)
            break;
        const struct pm_penalty old = p->penalty;
        p->penalty = fresh;
        fresh = old;
        /* what they see of the start is part of it */
        PM_TRY(measure(p, &p->penalty, p->phi, s->penalty, seen, err));
        for (int j = 0; j < 2; j++)
            s->worst[j] = fmax(s->worst[j], seen[j]);
    }
done:
    pm_penalty_release(&fresh);
    return status;
}

/* Halves the radius until the constraints can be held. */
static enum pm_status search(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    const double start[2] = {p->rho[0], p->rho[1]}, trust = s->radius;

    for (int k = 0;; k++) {
        PM_TRY(solve_seen(p, err));
        if (fit(s, ALLOWED))
            break;
        if (k == HALVINGS) {
            pm_log(1, "no step holds the constraints: violations %.3g %.3g, at the start %.3g %.3g",
                   s->trial_worst[0], s->trial_worst[1], s->worst[0], s->worst[1]);
            snprintf(s->verdict, sizeof s->verdict, "stalled");
            break;
        }
        s->radius /= 2;
        memcpy(p->rho, start, sizeof start);
        for (ptrdiff_t i = 0; i < 3 * p->N; i++)
            p->step[i] /= 2;
        move(p, p->step);
        pm_penalty_relax(&p->penalty);
        PM_TRY(complete(p, err));
    }
    /* The constraints make this step short, not distrust: the next may be longer. */
    s->radius = fmin(trust, SHORTER * s->radius);
    s->trial_worst[0] = fmax(s->trial_worst[0], p->peak);
    /* What a step gives up for less violation must count as a gain of merit. */
    const double eased = s->penalty[0] + s->penalty[1] - s->trial_penalty[0] - s->trial_penalty[1];
    for (int k = 0; k < HALVINGS && s->gain < 0 && eased > 0 &&
                    s->gain + weighted(s, s->penalty) - weighted(s, s->trial_penalty) < -s->gain;
         k++) {
        s->weight[0] *= GROWTH;
        s->weight[1] *= GROWTH;
    }
    if (!(s->gain + weighted(s, s->penalty) - weighted(s, s->trial_penalty) >
          LEAST_GAIN * fabs(s->value)))
        snprintf(s->verdict, sizeof s->verdict, "stalled");
done:
    return status;
}

static enum pm_status prepare(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;

    PM_TRY(PM_NEW(p->phi, 3 * p->N, err));
    PM_TRY(PM_NEW(p->step, 3 * p->N, err));
    PM_TRY(PM_NEW(p->trial, 3 * p->N, err));
    PM_TRY(PM_NEW(p->mass, p->N, err));
    pm_surfaces_gather(&s->accepted, p->phi);
    PM_TRY(pm_penalty_new(&s->accepted, &p->penalty, err));
    pm_penalty_mass(&p->penalty, p->mass);
    PM_TRY(secants_new(s, p->mass, &p->secants, err));
    const struct subproblem problem = subproblem_of(p);
    const double scale = subproblem_dual_norm(&problem, s->gradient) * s->accepted.pcase.wall_min;
    for (int k = 0; k < 2; k++) {
        p->rho[k] = STIFFNESS * scale;
        s->weight[k] = fmax(s->weight[k], MERIT * scale);
    }
    PM_TRY(measure(p, &p->penalty, p->phi, s->penalty, s->worst, err));
done:
    return status;
}

enum pm_status trstep_propose(struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    struct proposal p = {.s = s, .N = s->accepted.offset[s->accepted.ns]};

    PM_TRY(prepare(&p, err));
    PM_TRY(pm_surfaces_copy(&s->accepted, &s->trial, err));
    const int moves = !s->renew && strcmp(s->verdict, "continue") == 0;
    if (moves)
        PM_TRY(search(&p, err));
    if (strcmp(s->verdict, "continue") != 0) {
        pm_surfaces_scatter(&s->trial, p.phi);
        s->gain = s->rms_step = s->max_step = 0;
        memcpy(s->trial_penalty, s->penalty, sizeof s->penalty);
        memcpy(s->trial_worst, s->worst, sizeof s->worst);
    }
done:
    pm_penalty_release(&p.penalty);
    secants_release(&p.secants);
    pm_free(p.phi);
    pm_free(p.step);
    pm_free(p.trial);
    pm_free(p.mass);
    return status;
}
