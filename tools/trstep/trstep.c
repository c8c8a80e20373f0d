#include "tools/trstep/trstep.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/sens.h"
#include "common/geometry/symmetry.h"
#include "tools/trstep/gaps.h"
#include "tools/trstep/secants.h"

struct trial {
    struct pm_surfaces surfaces;
    struct pm_work work;
    struct pm_step previous;
    const struct pm_step *before; /* &previous or NULL */
    int rebuilt;                  /* its control points are not those of the proposal */
    struct judgement judgement;
};

static void trial_release(struct trial *t)
{
    pm_surfaces_release(&t->surfaces);
    pm_work_release(&t->work);
    pm_step_release(&t->previous);
}

static enum pm_status same_case(const struct pm_case *expected, const struct pm_case *found,
                                const char *path, struct pm_err *err)
{
    if (strcmp(expected->text, found->text) == 0)
        return PM_OK;
    return pm_fail(err, PM_INPUT, "cannot use '%s': its case differs from that of the surfaces",
                   path);
}

/* Only a renewed design may have other control points than those proposed. */
static enum pm_status compare_surfaces(struct trial *t, const char *path, struct pm_err *err)
{
    const struct pm_surfaces *a = &t->previous.trial, *b = &t->surfaces;

    t->rebuilt = a->ns != b->ns;
    for (ptrdiff_t k = 0; k < a->ns && !t->rebuilt; k++)
        t->rebuilt =
            a->s[k].n != b->s[k].n ||
            memcmp(a->s[k].phi, b->s[k].phi, (size_t)(3 * b->s[k].n) * sizeof *b->s[k].phi) != 0;
    if (t->rebuilt && !t->previous.renew)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': it does not hold the surfaces proposed by "
                       "the previous step",
                       path);
    return PM_OK;
}

static enum pm_status load_trial(const struct trstep_opts *opts, char *const *paths,
                                 struct trial *t, struct pm_err *err)
{
    enum pm_status status;

    PM_TRY(pm_surfaces_load(paths[0], &t->surfaces, err));
    PM_TRY(pm_work_load(paths[1], 1, &t->work, err));
    PM_TRY(same_case(&t->surfaces.pcase, &t->work.pcase, paths[1], err));
    if (opts->previous != NULL) {
        PM_TRY(pm_step_load(opts->previous, &t->previous, err));
        PM_TRY(same_case(&t->surfaces.pcase, &t->previous.trial.pcase, opts->previous, err));
        if (strcmp(t->previous.verdict, "continue") != 0)
            PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': its verdict is '%s', expected continue",
                           opts->previous, t->previous.verdict));
        t->before = &t->previous;
        PM_TRY(compare_surfaces(t, paths[0], err));
    }
    trust_judge(t->before, &t->work, &t->judgement);
    if (t->before == NULL && !t->judgement.accepted)
        PM_TRY(pm_fail(err, PM_NUMERIC, "the first design failed: %s", t->judgement.reason));
    if (t->before == NULL && !(t->work.value > 0))
        PM_TRY(pm_fail(err, PM_NUMERIC, "the measure of the first design is %g, expected > 0",
                       t->work.value));
done:
    return status;
}

/* step->gradient = sum over the Gauss points without what closeness adds, which goes to its own
 * place; projected on the symmetric free subspace. */
static enum pm_status sum_gradient(const struct trial *t, char *const *paths, int n,
                                   struct pm_step *step, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t N = t->surfaces.offset[t->surfaces.ns];
    struct pm_sens s = {0};
    unsigned char *seen = NULL;

    PM_TRY(PM_NEW(seen, t->work.ng, err));
    if (n != t->work.ng)
        PM_TRY(pm_fail(err, PM_USAGE, "got %d sens files for an accepted trial, expected %td", n,
                       t->work.ng));
    for (int k = 0; k < n; k++) {
        PM_TRY(pm_sens_load(paths[k], &s, err));
        PM_TRY(same_case(&t->surfaces.pcase, &s.pcase, paths[k], err));
        if (s.N != N)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "cannot use '%s': it has %td control points, expected %td", paths[k],
                           s.N, N));
        if (s.form != t->work.form || s.load < 0 || s.load >= t->work.ng || seen[s.load])
            PM_TRY(pm_fail(
                err, PM_INPUT,
                "cannot use '%s': point %lld of form %lld, expected each point of form %lld once",
                paths[k], (long long)s.load, (long long)s.form, (long long)t->work.form));
        seen[s.load] = 1;
        const double weight = -t->work.dw_dG[s.load];
        for (ptrdiff_t i = 0; i < 3 * N; i++)
            step->gradient[i] += s.gradient[i];
        for (ptrdiff_t r = 0; r < s.nclose; r++) {
            double *g = s.close_gradient + 3 * N * r;
            for (ptrdiff_t i = 0; i < 3 * N; i++)
                step->gradient[i] += weight * g[i];
            pm_symmetrise_vectors(&t->surfaces, g);
            PM_TRY(gaps_add(step, weight, s.close_value[r], g, err));
        }
        pm_sens_release(&s);
    }
    pm_symmetrise_vectors(&t->surfaces, step->gradient);
done:
    pm_sens_release(&s);
    pm_free(seen);
    return status;
}

/* The base of the next proposal: this trial if accepted, else what the previous step had. */
static enum pm_status set_base(const struct trial *t, char *const *sens, int nsens,
                               struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_surfaces *from = t->judgement.accepted ? &t->surfaces : &t->previous.accepted;

    if (!t->judgement.accepted && nsens > 0)
        PM_TRY(
            pm_fail(err, PM_USAGE, "got %d sens files for a rejected trial, expected none", nsens));
    PM_TRY(pm_surfaces_copy(from, &s->accepted, err));
    const ptrdiff_t N = from->offset[from->ns];
    PM_TRY(PM_NEW(s->gradient, 3 * N, err));
    if (t->judgement.accepted)
        PM_TRY(sum_gradient(t, sens, nsens, s, err));
    else
        PM_TRY(gaps_copy(&t->previous, s, err));
    for (ptrdiff_t i = 0; i < 3 * N && !t->judgement.accepted; i++)
        s->gradient[i] = t->previous.gradient[i];
    PM_TRY(secants_collect(t->rebuilt && t->judgement.accepted ? NULL : t->before,
                           from->pcase.secants, s, err));
    s->value = t->judgement.accepted ? t->work.objective : t->previous.value;
    s->radius =
        t->before != NULL ? trust_radius(t->before, &t->judgement) : t->surfaces.pcase.radius;
    for (int k = 0; k < 2; k++)
        s->weight[k] = t->before != NULL ? t->before->weight[k] : 0;
done:
    return status;
}

static double least_gap(const struct pm_work *w)
{
    double least = -1;
    for (ptrdiff_t g = 0; g < w->ng; g++)
        if (w->gap[g] >= 0 && (least < 0 || w->gap[g] < least))
            least = w->gap[g];
    return least;
}

/* The history of the previous step and a row for this trial. */
static enum pm_status add_row(const struct trial *t, struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_step *b = t->before;
    const ptrdiff_t n = b != NULL ? b->ntrials : 0;
    struct pm_trial row = {.iteration = n,
                           .accepted = t->judgement.accepted,
                           .measure = t->work.value,
                           .amplification = t->work.amplification,
                           .gap = least_gap(&t->work)};

    PM_TRY(PM_NEW(s->trials, n + 1, err));
    if (b != NULL) {
        memcpy(s->trials, b->trials, (size_t)n * sizeof *b->trials);
        row.merit = trust_merit(t->work.objective, b->weight, b->trial_penalty);
        row.predicted = trust_merit(b->value + b->gain, b->weight, b->trial_penalty) -
                        trust_merit(b->value, b->weight, b->penalty);
        row.ratio = t->judgement.ratio;
        row.radius = b->radius;
        row.rms_step = b->rms_step;
        row.renewed = b->renew + t->rebuilt;
        row.jump = b->renew && t->judgement.accepted ? t->work.objective / b->value - 1 : 0;
        row.worst_curvature = b->trial_worst[0];
        row.worst_wall = b->trial_worst[1];
    } else {
        row.radius = s->radius;
    }
    if (t->work.failure[0] != '\0')
        row.measure = row.merit = 0;
    memcpy(row.reason, t->judgement.reason, sizeof row.reason);
    s->trials[n] = row;
    s->ntrials = n + 1;
done:
    return status;
}

/* The proposal knows the penalties of the design that it starts from: the rows of an accepted
 * design get them. */
static void complete_row(const struct trial *t, struct pm_step *s)
{
    struct pm_trial *row = &s->trials[s->ntrials - 1];
    if (!t->judgement.accepted)
        return;
    row->worst_curvature = s->worst[0];
    row->worst_wall = s->worst[1];
    if (t->before == NULL || row->renewed)
        row->merit = trust_merit(s->value, s->weight, s->penalty);
}

static enum pm_status make_step(const struct trstep_opts *opts, const struct pm_common *common,
                                const struct trial *t, struct pm_err *err)
{
    enum pm_status status;
    struct pm_step s = {0};
    struct pm_h5 *f = NULL;

    PM_TRY(set_base(t, common->operands + 2, common->noperands - 2, &s, err));
    PM_TRY(add_row(t, &s, err));
    snprintf(s.verdict, sizeof s.verdict, "%s",
             trust_verdict(&s.accepted.pcase, s.trials, s.ntrials, s.radius));
    s.renew = trust_renew(&s.accepted.pcase, s.trials, s.ntrials, &t->judgement);
    PM_TRY(trstep_propose(&s, err));
    complete_row(t, &s);
    PM_TRY(pm_h5_create(common->output, "step", common, (const char *const[]){opts->previous, NULL},
                        &f, err));
    PM_TRY(pm_step_write(f, &s, err));
    status = pm_h5_commit(f, err);
    f = NULL;
    const struct pm_trial *row = &s.trials[s.ntrials - 1];
    pm_log(1, "%s %s = %.6g %s, ratio %.3g%s%s; %s with radius %.3g mm, predicted %+.3g",
           row->accepted ? "accepted" : "rejected", t->work.name, row->measure, t->work.unit,
           row->ratio, row->reason[0] != '\0' ? ": " : "", row->reason, s.verdict, s.radius,
           s.gain);
done:
    pm_h5_close(f);
    pm_step_release(&s);
    return status;
}

static enum pm_status check_usage(const struct trstep_opts *o, const struct pm_common *c,
                                  struct pm_err *err)
{
    const int prints = (o->history != NULL) + (o->verdict != NULL) + (o->next != NULL);
    if (prints > 0 &&
        (prints > 1 || c->noperands > 0 || c->output != NULL || o->judge || o->previous != NULL))
        return pm_fail(err, PM_USAGE, "--history, --verdict and --next stand alone");
    if (o->judge && (c->noperands != 2 || c->output != NULL))
        return pm_fail(err, PM_USAGE, "--judge takes SURF.h5 WORK.h5 and no output");
    if (prints == 0 && c->noperands < 2)
        return pm_fail(err, PM_USAGE, "got %d operands, expected SURF.h5 WORK.h5 [SENS.h5..]",
                       c->noperands);
    if (prints == 0 && !o->judge && c->output == NULL)
        return pm_fail(err, PM_USAGE, "no output, expected -o FILE");
    return PM_OK;
}

enum pm_status trstep_run(const struct trstep_opts *opts, const struct pm_common *common,
                          struct pm_err *err)
{
    enum pm_status status;
    struct trial t = {.before = NULL};

    PM_TRY(check_usage(opts, common, err));
    if (opts->history != NULL || opts->verdict != NULL || opts->next != NULL)
        return trstep_print(opts, err);
    PM_TRY(load_trial(opts, common->operands, &t, err));
    if (opts->judge)
        puts(t.judgement.accepted ? "accept" : "reject");
    else
        PM_TRY(make_step(opts, common, &t, err));
done:
    trial_release(&t);
    return status;
}
