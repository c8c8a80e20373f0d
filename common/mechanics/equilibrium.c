#include "common/mechanics/equilibrium.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/newton.h"
#include "common/mechanics/path.h"

const struct pm_solve_options pm_solve_default = {.tolerance = 1e-8,
                                                  .first_step = 1.0 / 3,
                                                  .min_step = 1.0 / 512,
                                                  .min_det = 0.2,
                                                  .max_newton = 12};

/* Tolerance of load steps on the way: they only have to stay on the path. After a refusal the base
 * of the step is made better than that. */
static const double path_tolerance = 1e-1, polished = 1e-3;
/* A predictor with a residual of more loads than this times kappa/mu is shortened; after a refusal
 * the limit is half of what was refused. */
static const double long_residual = 3.0;

/* Tangents of a guess that need not be definite: its way is no path of equilibria. */
enum { SETTLES = 3 };

/* Pressures from (1 - lambda) + to lambda (nc) [MPa], and the derivatives of the path by lambda at
 * its base. */
struct path {
    const double *from, *to;
    double first_step;
    double longest;        /* residual of a predictor beyond which it is shortened */
    double predicted;      /* that of the last one */
    double *dp;            /* to - from (nc) */
    double *du1, *du2;     /* nodal fields (nn x 3) */
    double *step1, *step2; /* their parts of a load step (nn x 3) */
    struct pm_config base;
};

static void set_pressure(struct pm_newton *s, const struct path *path, double lambda)
{
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        s->p[r] = (1.0 - lambda) * path->from[r] + lambda * path->to[r];
}

/* c = base moved by the predictor of step h, of first or second order, whichever leaves the smaller
 * residual; that is s->residual (infinite: inverted element). */
static enum pm_status predictor(struct pm_newton *s, struct path *path, double lambda, double h,
                                struct pm_config *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    set_pressure(s, path, lambda + h);
    for (ptrdiff_t k = 0; k < 3 * s->m->nn; k++) {
        path->step1[k] = h * path->du1[k];
        path->step2[k] = h * h * path->du2[k];
    }
    if (s->warp == NULL)
        PM_TRY(pm_warp_new(s->m, &s->warp, err));
    PM_TRY(pm_warp_move(s->warp, &path->base, path->step1, NULL, &s->trial, err));
    PM_TRY(pm_warp_move(s->warp, &path->base, path->step1, path->step2, c, err));
    pm_newton_evaluate(s, &s->trial);
    double first = s->residual;
    pm_newton_evaluate(s, c);
    if (first < s->residual) {
        pm_config_copy(s->m, &s->trial, c);
        s->residual = first;
    }
done:
    return status;
}

/* One load step from the base (load parameter lambda), at most of length h: c, or a refusal. A
 * predictor that is too long is seen by its residual before a factorisation is spent on it. The
 * strain that it leaves would spoil the tangent: stresses linearised along its first order are free
 * of it. */
static enum pm_status load_step(struct pm_newton *s, struct path *path, double lambda, double *h,
                                struct pm_config *c, int *reached, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(predictor(s, path, lambda, *h, c, err));
    while (s->residual > path->longest && *h > s->o->min_step) {
        *h *= fmax(0.25, 0.9 * cbrt(path->longest / s->residual));
        PM_TRY(predictor(s, path, lambda, *h, c, err));
    }
    double next = lambda + *h > 1.0 - 1e-9 ? 1.0 : lambda + *h;
    s->r->lambda = next;
    path->predicted = s->residual;
    pm_log(2, "load %.4f: predicted, residual %.2e", next, s->residual);
    pm_model_mixed(s->m, &path->base, path->step1, s->mixed);
    /* what the base leaves must not use up the limit of the next predictor */
    double rough = fmin(path_tolerance, 0.1 * path->longest);
    status = pm_newton_solve(s, c, next < 1.0 ? rough : s->o->tolerance, 1, reached, err);
done:
    return status;
}

/* Path derivatives at the base; *reached = 0: its tangent is not positive definite. */
static enum pm_status predict(struct pm_newton *s, struct path *path, double lambda, int *reached,
                              struct pm_err *err)
{
    enum pm_status status;
    set_pressure(s, path, lambda);
    pm_newton_evaluate(s, &path->base);
    PM_TRY(pm_path_derivatives(s->m, &path->base, s->p, s->f, path->dp, path->du1, path->du2,
                               reached, err));
    if (!*reached)
        pm_newton_refuse(s, "the equilibrium is unstable at load", lambda);
done:
    return status;
}

/* After a refusal: the base as an equilibrium of higher accuracy, and its derivatives. */
static enum pm_status polish(struct pm_newton *s, struct path *path, double lambda, int *reached,
                             struct pm_err *err)
{
    enum pm_status status;
    set_pressure(s, path, lambda);
    s->r->lambda = lambda;
    PM_TRY(pm_newton_solve(s, &path->base, polished, 0, reached, err));
    if (*reached)
        PM_TRY(predict(s, path, lambda, reached, err));
done:
    return status;
}

static enum pm_status path_new(struct pm_newton *s, struct path *path, const struct pm_config *c,
                               struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t n = 3 * s->m->nn;
    PM_TRY(PM_NEW(path->dp, s->m->mesh->nc, err));
    PM_TRY(PM_NEW(path->du1, n, err));
    PM_TRY(PM_NEW(path->du2, n, err));
    PM_TRY(PM_NEW(path->step1, n, err));
    PM_TRY(PM_NEW(path->step2, n, err));
    PM_TRY(pm_config_new(s->m, &path->base, err));
    pm_config_copy(s->m, c, &path->base);
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        path->dp[r] = path->to[r] - path->from[r];
done:
    return status;
}

static void path_release(struct path *path)
{
    pm_config_release(&path->base);
    pm_free(path->dp);
    pm_free(path->du1);
    pm_free(path->du2);
    pm_free(path->step1);
    pm_free(path->step2);
}

/* Continuation from the equilibrium c at path->from to path->to. */
static enum pm_status follow(struct pm_newton *s, struct path *path, struct pm_config *c,
                             int *reached, struct pm_err *err)
{
    enum pm_status status;
    double lambda = 0.0, step = path->first_step;
    int rough = 0;
    PM_TRY(path_new(s, path, c, err));
    path->longest = long_residual * s->m->law.kappa / s->m->law.mu;
    PM_TRY(predict(s, path, lambda, reached, err));
    while (lambda < 1.0 && *reached && step >= s->o->min_step) {
        long before = s->r->newton_steps;
        step = lambda + 1.1 * step > 1.0 ? 1.0 - lambda : step;
        PM_TRY(load_step(s, path, lambda, &step, c, reached, err));
        if (!*reached) {
            s->r->backoffs++;
            step *= 0.5;
            path->longest = fmin(path->longest, 0.5 * path->predicted);
            *reached = 1;
            if (rough)
                PM_TRY(polish(s, path, lambda, reached, err));
            rough = 0;
            continue;
        }
        pm_config_copy(s->m, c, &path->base);
        lambda = s->r->lambda;
        s->r->load_steps++;
        step *= s->r->newton_steps - before <= 3 ? 2.0 : 1.0;
        rough = 1;
        if (lambda < 1.0)
            PM_TRY(predict(s, path, lambda, reached, err));
    }
    *reached = lambda == 1.0;
    s->r->lambda = lambda;
    pm_config_copy(s->m, &path->base, c);
done:
    path_release(path);
    return status;
}

/* Exact tangent at the solution: stability, and solves for the Jacobian. */
static enum pm_status finish(struct pm_newton *s, const double *p, struct pm_config *c,
                             struct pm_err *err)
{
    enum pm_status status;
    int definite;
    memcpy(s->p, p, (size_t)s->m->mesh->nc * sizeof *p);
    pm_newton_evaluate(s, c);
    s->r->residual = s->load_norm > 0.0 ? s->residual : 0.0;
    pm_model_volume_gradient(s->m, c, 0, s->nodal);
    pm_model_reduce(s->m, c, s->nodal, s->dq);
    PM_TRY(pm_model_prepare(s->m, c, p, s->f, NULL, s->dq, 0.1, &definite, err));
    if (!definite)
        status =
            pm_fail(err, PM_NUMERIC,
                    "equilibrium at full load is unstable: its tangent is not positive definite");
    s->r->energy = s->Pi;
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        s->r->energy += p[r] * s->volume[r];
done:
    return status;
}

/* From a guess: corrected at its own loads, then followed to p. */
static enum pm_status start_from_guess(struct pm_newton *s, const struct pm_guess *guess,
                                       const double *p, struct pm_config *c, int *reached,
                                       struct pm_err *err)
{
    enum pm_status status;
    struct path path = {.from = guess->at, .to = p, .first_step = 1.0};
    int same = memcmp(guess->at, p, (size_t)s->m->mesh->nc * sizeof *p) == 0;
    set_pressure(s, &path, 0.0);
    if (guess->mixed != NULL)
        memcpy(s->mixed, guess->mixed,
               (size_t)(PM_MIXED * s->m->nb * s->m->space.type->nq) * sizeof *s->mixed);
    pm_model_place_tip(s->m, c); /* on this mesh */
    s->settles = SETTLES;
    PM_TRY(pm_newton_solve(s, c, same ? s->o->tolerance : path_tolerance, guess->mixed != NULL,
                           reached, err));
    s->settles = 0;
    if (*reached && !same)
        PM_TRY(follow(s, &path, c, reached, err));
    s->r->warm = *reached;
done:
    return status;
}

enum pm_status pm_equilibrium(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                              const struct pm_guess *guess, struct pm_config *c, double *volume,
                              double *f, struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_newton s;
    struct pm_config undeformed = {0};
    double *zero = NULL;
    long before = m->factorisations, solves = m->solves;
    int reached = 1;
    *r = (struct pm_solve_report){0};
    PM_TRY(pm_newton_new(m, o, r, f, volume, &s, err));
    PM_TRY(PM_NEW(zero, m->mesh->nc, err));
    PM_TRY(pm_config_new(m, &undeformed, err));
    pm_newton_measure_load(&s, p);
    if (s.load_norm == 0.0) { /* no pressure: the undeformed state */
        pm_config_copy(m, &undeformed, c);
    } else if (guess != NULL) {
        PM_TRY(start_from_guess(&s, guess, p, c, &reached, err));
        if (!reached)
            status =
                pm_fail(err, PM_NUMERIC, "the guess does not lead to an equilibrium: %s", r->why);
    } else {
        struct path path = {.from = zero, .to = p, .first_step = o->first_step};
        pm_config_copy(m, &undeformed, c);
        PM_TRY(follow(&s, &path, c, &reached, err));
        if (!reached)
            status = pm_fail(err, PM_NUMERIC,
                             "no stable equilibrium beyond load %.4f of the pressures: %s",
                             r->lambda, r->why);
    }
    if (reached)
        PM_TRY(finish(&s, p, c, err));
done:
    r->factorisations = m->factorisations - before;
    r->solves = m->solves - solves;
    pm_progress("%s", "");
    pm_newton_release(&s);
    pm_config_release(&undeformed);
    pm_free(zero);
    return status;
}
