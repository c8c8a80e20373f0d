#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/symmetry.h"
#include "tools/trstep/penalty.h"
#include "tools/trstep/subproblem.h"
#include "tools/trstep/trstep.h"

/* LEAST_GAIN: share of the largest linear gain that the constraints must leave to the measure.
 * ROUNDS: times that the watch lists are widened because the step met a violation outside of them.
 */
static const double LEAST_GAIN = 0.1, STIFFNESS = 200;
enum { ROUNDS = 3, LOWERINGS = 8 };

struct proposal {
    struct pm_step *s;
    struct penalty penalty;
    struct penalty_watch watch;
    ptrdiff_t N;
    double *phi;   /* accepted control points (N x 3) [mm] */
    double *step;  /* (N x 3) [mm] */
    double *trial; /* phi + step, scratch (N x 3) */
    double *mass;  /* (N) */
};

static double penalise(void *context, const double *step, double *gradient)
{
    struct proposal *p = context;
    struct penalty_value v;
    for (ptrdiff_t i = 0; i < 3 * p->N; i++)
        p->trial[i] = p->phi[i] + step[i];
    penalty_at(&p->penalty, &p->watch, p->trial, p->s->weight, gradient, &v);
    return p->s->weight[0] * v.curvature + p->s->weight[1] * v.wall;
}

static void project(void *context, double *v)
{
    const struct proposal *p = context;
    pm_symmetrise_vectors(&p->s->accepted, v);
}

/* All violations at phi, whether watched or not. */
static enum pm_status full_penalty(struct proposal *p, const double *phi, double sum[2],
                                   double worst[2], struct pm_err *err)
{
    enum pm_status status;
    struct penalty_value v;
    struct penalty_watch all = {0};
    const double none[2] = {0, 0};

    PM_TRY(penalty_collect(&p->penalty, &all, phi, 0, 1, err));
    penalty_at(&p->penalty, &all, phi, none, NULL, &v);
    sum[0] = v.curvature;
    sum[1] = v.wall;
    worst[0] = v.worst_curvature;
    worst[1] = v.worst_wall;
done:
    penalty_watch_release(&all);
    return status;
}

static double weighted(const struct pm_step *s, const double sum[2])
{
    return s->weight[0] * sum[0] + s->weight[1] * sum[1];
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

/* How far from a limit pairs are watched from the start; others are found when a step meets them.
 */
static double reach(const struct pm_step *s)
{
    return fmin(s->radius, s->accepted.pcase.wall_min) / 4;
}

/* The step for the present weights; the watch lists grow until the step meets no violation outside
 * them. */
static enum pm_status solve(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    const struct subproblem problem = subproblem_of(p);
    const double unit = s->radius * subproblem_dual_norm(&problem, s->gradient);

    memset(p->step, 0, (size_t)(3 * p->N) * sizeof *p->step);
    for (int round = 0; round < ROUNDS; round++) {
        PM_TRY(subproblem_solve(&problem, p->step, err));
        const double known = penalise(p, p->step, NULL);
        PM_TRY(penalty_collect(&p->penalty, &p->watch, p->trial, reach(s), 0.8, err));
        const double part = penalty_safe_part(&p->penalty, &p->watch, p->phi, p->step);
        for (ptrdiff_t i = 0; i < 3 * p->N; i++) {
            p->step[i] *= part;
            p->trial[i] = p->phi[i] + p->step[i];
        }
        PM_TRY(full_penalty(p, p->trial, s->trial_penalty, s->trial_worst, err));
        if (weighted(s, s->trial_penalty) <= known + 0.02 * unit)
            break;
    }
    s->gain = 0;
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

static enum pm_status search(struct proposal *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step *s = p->s;
    const struct subproblem problem = subproblem_of(p);
    const double unit = s->radius * subproblem_dual_norm(&problem, s->gradient);

    PM_TRY(penalty_collect(&p->penalty, &p->watch, p->phi, reach(s), 0.7, err));
    for (int k = 0;; k++) {
        PM_TRY(solve(p, err));
        const double gain = s->gain - weighted(s, s->trial_penalty) + weighted(s, s->penalty);
        pm_log(
            2,
            "sub-problem: gain of T %.4g of %.4g, of merit %.4g, violations %.3g %.3g, %td pairs",
            s->gain, unit, gain, s->trial_worst[0], s->trial_worst[1], p->watch.npair);
        if (gain > 0 && s->gain > LEAST_GAIN * unit)
            break;
        if (k == LOWERINGS) {
            snprintf(s->verdict, sizeof s->verdict, "stalled");
            break;
        }
        s->weight[0] /= 3;
        s->weight[1] /= 3;
    }
done:
    return status;
}

static void stiffen(struct proposal *p)
{
    const struct subproblem problem = subproblem_of(p);
    const double slope = subproblem_dual_norm(&problem, p->s->gradient);
    for (int k = 0; k < 2; k++)
        p->s->weight[k] = fmax(p->s->weight[k], STIFFNESS * slope);
}

enum pm_status trstep_propose(struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    struct proposal p = {.s = s, .N = s->accepted.offset[s->accepted.ns]};

    PM_TRY(PM_NEW(p.phi, 3 * p.N, err));
    PM_TRY(PM_NEW(p.step, 3 * p.N, err));
    PM_TRY(PM_NEW(p.trial, 3 * p.N, err));
    PM_TRY(PM_NEW(p.mass, p.N, err));
    pm_surfaces_gather(&s->accepted, p.phi);
    PM_TRY(penalty_new(&s->accepted, &p.penalty, err));
    subproblem_mass(&s->accepted, &p.penalty.samples, p.mass);
    stiffen(&p);
    PM_TRY(full_penalty(&p, p.phi, s->penalty, s->worst, err));
    if (strcmp(s->verdict, "continue") == 0)
        PM_TRY(search(&p, err));
    PM_TRY(pm_surfaces_copy(&s->accepted, &s->trial, err));
    if (strcmp(s->verdict, "continue") == 0) {
        for (ptrdiff_t i = 0; i < 3 * p.N; i++)
            p.trial[i] = p.phi[i] + p.step[i];
        pm_symmetrise_points(&s->accepted, p.trial);
        pm_surfaces_scatter(&s->trial, p.trial);
    } else {
        s->gain = s->rms_step = s->max_step = 0;
        memcpy(s->trial_penalty, s->penalty, sizeof s->penalty);
        memcpy(s->trial_worst, s->worst, sizeof s->worst);
    }
done:
    penalty_watch_release(&p.watch);
    penalty_release(&p.penalty);
    pm_free(p.phi);
    pm_free(p.step);
    pm_free(p.trial);
    pm_free(p.mass);
    return status;
}
