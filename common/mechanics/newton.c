#include "common/mechanics/newton.h"

#include <math.h>
#include <stdio.h>

#include "common/base/log.h"
#include "common/base/memory.h"

/* Above this residual (in loads) corrections turn with the body; below it a straight step leaves
 * less strain than the correction itself. */
static const double turning_residual = 1.0;
/* Below it the tangent changes little: the factor at hand serves. */
static const double near_residual = 3.0;
/* Below it the exact tangent converges faster than the mixed one. */
static const double exact_residual = 0.1;

enum pm_status pm_newton_new(struct pm_model *m, const struct pm_solve_options *o,
                             struct pm_solve_report *r, double *f, double *volume,
                             struct pm_newton *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_newton){.m = m, .o = o, .r = r, .f = f, .volume = volume};
    PM_TRY(PM_NEW(s->p, m->mesh->nc, err));
    PM_TRY(PM_NEW(s->g, m->nq, err));
    PM_TRY(PM_NEW(s->dq, m->nq, err));
    PM_TRY(PM_NEW(s->nodal, 3 * m->nn, err));
    PM_TRY(pm_model_mixed_new(m, &s->mixed, err));
    PM_TRY(pm_config_new(m, &s->trial, err));
done:
    return status;
}

void pm_newton_release(struct pm_newton *s)
{
    pm_config_release(&s->trial);
    pm_warp_free(s->warp);
    pm_free(s->p);
    pm_free(s->g);
    pm_free(s->dq);
    pm_free(s->nodal);
    pm_free(s->mixed);
    *s = (struct pm_newton){0};
}

static double largest(const struct pm_newton *s)
{
    double most = 0.0;
    for (ptrdiff_t k = 0; k < s->m->nq; k++)
        most = fmax(most, fabs(s->g[k]));
    return most;
}

void pm_newton_measure_load(struct pm_newton *s, const double *p)
{
    for (ptrdiff_t k = 0; k < 3 * s->m->nn; k++)
        s->trial.u[k] = 0.0;
    for (int k = 0; k < 6; k++)
        s->trial.U[k] = 0.0;
    s->load_norm = 0.0;
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++) {
        pm_model_volume_gradient(s->m, &s->trial, r, s->nodal);
        pm_model_reduce(s->m, &s->trial, s->nodal, s->g);
        s->load_norm = fmax(s->load_norm, fabs(p[r]) * largest(s));
    }
}

int pm_newton_refuse(struct pm_newton *s, const char *why, double value)
{
    snprintf(s->r->why, sizeof s->r->why, "%s %.4g", why, value);
    pm_log(2, "load %.4f refused: %s", s->r->lambda, s->r->why);
    return 0;
}

int pm_newton_evaluate(struct pm_newton *s, const struct pm_config *c)
{
    s->Pi = pm_model_potential(s->m, c, s->p, s->f, s->volume, &s->r->min_det_F);
    s->residual = INFINITY;
    if (!(s->r->min_det_F > s->o->min_det) || !isfinite(s->Pi))
        return 0;
    pm_model_reduce(s->m, c, s->f, s->g);
    s->residual = largest(s) / s->load_norm;
    return 1;
}

/* Correction at c into s->dq: by the mixed tangent far from the solution, by the exact one near it.
 */
static enum pm_status correct(struct pm_newton *s, const struct pm_config *c, double tolerance,
                              int mixed, int *definite, struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = s->m;
    for (ptrdiff_t k = 0; k < m->nq; k++)
        s->dq[k] = -s->g[k];
    const pm_lanes *stress = mixed && s->residual > exact_residual ? s->mixed : NULL;
    if (m->factored && s->residual < near_residual) {
        double forcing = fmin(0.1, fmax(1e-3, 0.3 * tolerance / s->residual));
        PM_TRY(pm_model_prepare(m, c, s->p, s->f, stress, s->dq, forcing, definite, err));
    } else {
        PM_TRY(pm_model_factor(m, c, s->p, s->f, stress, definite, err));
        if (*definite)
            PM_TRY(pm_model_solve(m, s->dq, 1, 0.0, err));
    }
    s->r->newton_steps++;
done:
    return status;
}

/* Correction at c into s->dq by the stiffness that its material has without stress, and without the
 * pressures: definite where the exact one is not, for the stresses of a guess are wrong. */
static enum pm_status settle(struct pm_newton *s, const struct pm_config *c, int *definite,
                             struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = s->m;
    pm_lanes *stress = NULL;
    double *none = NULL;
    PM_TRY(pm_model_mixed_new(m, &stress, err));
    PM_TRY(PM_NEW(none, 3 * m->nn, err));
    PM_TRY(pm_model_factor(m, c, none, none, stress, definite, err));
    for (ptrdiff_t k = 0; k < m->nq; k++)
        s->dq[k] = -s->g[k];
    if (*definite)
        PM_TRY(pm_model_solve(m, s->dq, 1, 0.0, err));
    s->r->backoffs++;
    pm_log(2, "load %.4f: settling at relative residual %.4g", s->r->lambda, s->residual);
done:
    pm_free(none);
    pm_free(stress);
    return status;
}

/* c moved by the largest of dq, dq/2, .. that inverts no element; the mixed stresses follow. */
static enum pm_status advance(struct pm_newton *s, struct pm_config *c, int *moved,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_model *m = s->m;
    int turning = s->residual > turning_residual;
    if (turning && s->warp == NULL)
        PM_TRY(pm_warp_new(m, &s->warp, err));
    pm_model_expand(m, c, s->dq, s->nodal);
    pm_model_mixed(m, c, s->nodal, s->mixed);
    *moved = 0;
    for (int k = 0; k < 6 && !*moved; k++) {
        if (turning)
            PM_TRY(pm_warp_move(s->warp, c, s->nodal, NULL, &s->trial, err));
        else
            pm_model_move(m, c, s->dq, 1.0, &s->trial);
        *moved = pm_newton_evaluate(s, &s->trial);
        for (ptrdiff_t i = 0; i < m->nq && !*moved; i++)
            s->dq[i] *= 0.5;
        for (ptrdiff_t i = 0; i < 3 * m->nn && !*moved; i++)
            s->nodal[i] *= 0.5;
    }
    if (*moved)
        pm_config_copy(m, &s->trial, c);
    pm_log(2, "load %.4f: residual %.2e, smallest det F %.3f", s->r->lambda, s->residual,
           s->r->min_det_F);
done:
    return status;
}

enum pm_status pm_newton_solve(struct pm_newton *s, struct pm_config *c, double tolerance,
                               int mixed, int *reached, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int definite, moved;
    *reached = pm_newton_evaluate(s, c);
    if (!*reached)
        pm_newton_refuse(s, "inverted element, det F", s->r->min_det_F);
    for (int k = 0; *reached && s->residual > tolerance; k++, mixed = 1) {
        pm_progress("load %.4f newton %d residual %.2e", s->r->lambda, k + 1, s->residual);
        if (k == s->o->max_newton) {
            *reached = pm_newton_refuse(s, "no convergence, relative residual", s->residual);
            break;
        }
        PM_TRY(correct(s, c, tolerance, mixed, &definite, err));
        if (!definite && s->settles > 0) {
            s->settles--;
            PM_TRY(settle(s, c, &definite, err));
        }
        if (!definite) {
            *reached =
                pm_newton_refuse(s, "tangent lost definiteness at relative residual", s->residual);
            break;
        }
        PM_TRY(advance(s, c, &moved, err));
        if (!moved)
            *reached = pm_newton_refuse(s, "inverted element, det F", s->r->min_det_F);
    }
done:
    return status;
}
