#include "common/mechanics/equilibrium.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/path.h"

const struct pm_solve_options pm_solve_default = {.tolerance = 1e-8,
                                                  .first_step = 1.0 / 3,
                                                  .min_step = 1.0 / 512,
                                                  .min_det = 0.2,
                                                  .max_newton = 12};

/* Tolerance of load steps on the way: they only have to stay on the path. */
static const double path_tolerance = 1e-1;
/* A predictor with a residual of more loads than this is shortened: beyond a few hundred the
 * tangent was found to lose definiteness at bellows bodies (kappa = 100 mu). */
static const double long_residual = 300.0;
/* Below this residual the factor at hand serves for further corrections while each gains a factor
 * of 10. */
static const double chord_residual = 1e-3;

struct solver {
    struct pm_model *m;
    const struct pm_solve_options *o;
    struct pm_solve_report *r;
    double *p;              /* pressures of the load step (nc) */
    double *f, *volume;     /* nodal forces (nn x 3), chamber volumes (nc) */
    double *g, *dq;         /* q-vectors: residual, correction */
    double *first, *second; /* derivatives of the path by the load parameter */
    double *nodal;          /* (nn x 3) */
    pm_lanes *pressure;     /* MIP, as pm_model_pressure */
    struct pm_config trial;
    double Pi, load_norm;
};

enum outcome { CONVERGED, REFUSED };

/* Pressures from (1 - lambda) + to lambda (nc) [MPa]. */
struct path {
    const double *from, *to;
    double first_step;
};

static double norm_inf(const double *v, ptrdiff_t n)
{
    double s = 0.0;
    for (ptrdiff_t k = 0; k < n; k++)
        s = fmax(s, fabs(v[k]));
    return s;
}

static enum outcome refuse(struct solver *s, const char *why, double value)
{
    snprintf(s->r->why, sizeof s->r->why, "%s %.4g", why, value);
    pm_log(2, "load %.4f refused: %s", s->r->lambda, s->r->why);
    return REFUSED;
}

static void set_pressure(struct solver *s, const struct path *path, double lambda)
{
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        s->p[r] = (1.0 - lambda) * path->from[r] + lambda * path->to[r];
}

/* Residual at c: g, f, Pi; false if an element is inverted or too flat. */
static int evaluate(struct solver *s, const struct pm_config *c)
{
    double det;
    s->Pi = pm_model_potential(s->m, c, s->p, s->f, s->volume, &det);
    s->r->min_det_F = det;
    if (!(det > s->o->min_det))
        return 0;
    pm_model_reduce(s->m, c, s->f, s->g);
    return 1;
}

/* Largest generalised load of the pressures p on the undeformed state. */
static void measure_load(struct solver *s, const struct pm_config *undeformed, const double *p)
{
    s->load_norm = 0.0;
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++) {
        pm_model_volume_gradient(s->m, undeformed, r, s->nodal);
        pm_model_reduce(s->m, undeformed, s->nodal, s->g);
        s->load_norm = fmax(s->load_norm, fabs(p[r]) * norm_inf(s->g, s->m->nq));
    }
}

/* Moves c by a fraction of dq that lowers the potential (Armijo 1e-4), or, where rounding hides the
 * potential, the residual. Leaves f, g, Pi at the new c. */
static enum outcome search_line(struct solver *s, struct pm_config *c, double g0)
{
    struct pm_model *m = s->m;
    double slope = 0.0, Pi0 = s->Pi, alpha = 1.0;
    for (ptrdiff_t k = 0; k < m->nq; k++)
        slope += s->g[k] * s->dq[k];
    for (int k = 0; k < 6; k++, alpha *= 0.5) {
        pm_model_move(m, c, s->dq, alpha, &s->trial);
        if (!evaluate(s, &s->trial))
            continue;
        double rounding = 1e-12 * (fabs(Pi0) + fabs(slope));
        if (s->Pi <= Pi0 + 1e-4 * alpha * slope + rounding || norm_inf(s->g, m->nq) < 0.5 * g0) {
            pm_config_copy(m, &s->trial, c);
            pm_log(2, "load %.4f: step %.4g, residual %.2e, smallest det F %.3f", s->r->lambda,
                   alpha, norm_inf(s->g, m->nq) / s->load_norm, s->r->min_det_F);
            return CONVERGED;
        }
    }
    return refuse(s, "line search on the potential failed, smallest det F", s->r->min_det_F);
}

/* Corrections with the factor at hand while they gain a factor of 10 each; keeps the best c. */
static enum pm_status chord(struct solver *s, struct pm_config *c, double tolerance, double *g0,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    while (*g0 > tolerance) {
        for (ptrdiff_t k = 0; k < s->m->nq; k++)
            s->dq[k] = -s->g[k];
        PM_TRY(pm_model_solve(s->m, s->dq, 1, err));
        pm_model_move(s->m, c, s->dq, 1.0, &s->trial);
        double g1 = evaluate(s, &s->trial) ? norm_inf(s->g, s->m->nq) : 2.0 * *g0;
        if (!(g1 < *g0)) {
            evaluate(s, c);
            break;
        }
        pm_config_copy(s->m, &s->trial, c);
        double gain = g1 / *g0;
        *g0 = g1;
        if (gain > 0.1)
            break;
    }
done:
    return status;
}

/* Newton at the pressures s->p from c; mixed: s->pressure holds the pressures for the first
 * tangent. */
static enum pm_status newton(struct solver *s, struct pm_config *c, double tolerance, int mixed,
                             enum outcome *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_model *m = s->m;
    double tol = tolerance * s->load_norm, chord_at = chord_residual * s->load_norm;
    int definite;
    if (!evaluate(s, c)) {
        *out = refuse(s, "inverted element, det F", s->r->min_det_F);
        return PM_OK;
    }
    double g0 = norm_inf(s->g, m->nq);
    for (int k = 0; g0 > tol; k++) {
        if (k == s->o->max_newton) {
            *out = refuse(s, "no convergence, relative residual", g0 / s->load_norm);
            return PM_OK;
        }
        pm_progress("load %.4f newton %d residual %.2e", s->r->lambda, k + 1, g0 / s->load_norm);
        PM_TRY(pm_model_factor(m, c, s->p, s->f, mixed ? s->pressure : NULL, &definite, err));
        s->r->newton_steps++;
        if (!definite) {
            *out = refuse(s, "tangent lost definiteness at relative residual", g0 / s->load_norm);
            return PM_OK;
        }
        for (ptrdiff_t i = 0; i < m->nq; i++)
            s->dq[i] = -s->g[i];
        PM_TRY(pm_model_solve(m, s->dq, 1, err));
        pm_model_expand(m, c, s->dq, s->nodal);
        pm_model_pressure(m, c, s->nodal, s->pressure);
        mixed = 1;
        *out = search_line(s, c, g0);
        if (*out != CONVERGED)
            return PM_OK;
        g0 = norm_inf(s->g, m->nq);
        if (g0 < chord_at)
            PM_TRY(chord(s, c, tol, &g0, err));
    }
    s->r->residual = g0 / s->load_norm;
    *out = CONVERGED;
done:
    return status;
}

/* c = base moved by the second-order predictor of step h; the relative residual there (infinite:
 * inverted element). */
static double predictor(struct solver *s, const struct path *path, const struct pm_config *base,
                        double lambda, double h, struct pm_config *c)
{
    set_pressure(s, path, lambda + h);
    for (ptrdiff_t k = 0; k < s->m->nq; k++)
        s->dq[k] = h * (s->first[k] + 0.5 * h * s->second[k]);
    pm_model_move(s->m, base, s->dq, 1.0, c);
    return evaluate(s, c) ? norm_inf(s->g, s->m->nq) / s->load_norm : 8.0 * long_residual;
}

/* One load step from base (load parameter lambda), at most of length h: c, or a refusal. A
 * predictor that is too long is seen by its residual, which grows as h^3, before a factorisation is
 * spent on it. What the predictor leaves of volumetric strain would spoil the tangent: the
 * pressures linearised along its first order are free of it. */
static enum pm_status load_step(struct solver *s, const struct path *path,
                                const struct pm_config *base, double lambda, double *h,
                                struct pm_config *c, enum outcome *out, struct pm_err *err)
{
    double residual = predictor(s, path, base, lambda, *h, c);
    while (residual > long_residual && *h > s->o->min_step) {
        *h *= 0.9 * cbrt(long_residual / residual);
        residual = predictor(s, path, base, lambda, *h, c);
    }
    double next = lambda + *h > 1.0 - 1e-9 ? 1.0 : lambda + *h;
    s->r->lambda = next;
    pm_log(2, "load %.4f: predicted, residual %.2e", next, residual);
    pm_model_expand(s->m, base, s->first, s->nodal);
    for (ptrdiff_t k = 0; k < 3 * s->m->nn; k++)
        s->nodal[k] *= *h;
    pm_model_pressure(s->m, base, s->nodal, s->pressure);
    return newton(s, c, next < 1.0 ? path_tolerance : s->o->tolerance, 1, out, err);
}

/* Path derivatives at base. The factor at hand serves where it belongs to the last Newton iterate
 * of base; else it is made anew, and its failure is the end of a stable branch. */
static enum pm_status predict(struct solver *s, const struct path *path,
                              const struct pm_config *base, double lambda, int fresh,
                              enum outcome *out, struct pm_err *err)
{
    enum pm_status status;
    double *dp = NULL;
    int definite = 1;
    PM_TRY(PM_NEW(dp, s->m->mesh->nc, err));
    set_pressure(s, path, lambda);
    evaluate(s, base);
    if (!fresh)
        PM_TRY(pm_model_factor(s->m, base, s->p, s->f, NULL, &definite, err));
    *out = definite ? CONVERGED : refuse(s, "the equilibrium is unstable at load", lambda);
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        dp[r] = path->to[r] - path->from[r];
    if (definite)
        PM_TRY(pm_path_derivatives(s->m, base, s->p, s->f, dp, s->first, s->second, err));
done:
    pm_free(dp);
    return status;
}

/* Continuation from the equilibrium c at path->from to path->to. After a refusal the predictor of
 * base still holds. */
static enum pm_status follow_path(struct solver *s, const struct path *path, int fresh,
                                  struct pm_config *c, enum outcome *out, struct pm_err *err)
{
    enum pm_status status;
    struct pm_config base = {0};
    double lambda = 0.0, step = path->first_step;
    PM_TRY(pm_config_new(s->m, &base, err));
    pm_config_copy(s->m, c, &base);
    PM_TRY(predict(s, path, &base, lambda, fresh, out, err));
    while (lambda < 1.0 && *out == CONVERGED && step >= s->o->min_step) {
        long before = s->r->newton_steps;
        step = lambda + 1.1 * step > 1.0 ? 1.0 - lambda : step;
        PM_TRY(load_step(s, path, &base, lambda, &step, c, out, err));
        if (*out != CONVERGED) {
            s->r->backoffs++;
            step *= 0.5;
            *out = CONVERGED;
            continue;
        }
        pm_config_copy(s->m, c, &base);
        lambda = s->r->lambda;
        s->r->load_steps++;
        step *= s->r->newton_steps - before <= 3 ? 2.0 : 1.0;
        if (lambda < 1.0)
            PM_TRY(predict(s, path, &base, lambda, s->r->newton_steps > before, out, err));
    }
    *out = lambda < 1.0 ? REFUSED : CONVERGED;
    s->r->lambda = lambda;
done:
    pm_config_release(&base);
    return status;
}

static enum pm_status allocate(struct solver *s, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *mesh = s->m->mesh;
    PM_TRY(PM_NEW(s->p, mesh->nc, err));
    PM_TRY(PM_NEW(s->g, s->m->nq, err));
    PM_TRY(PM_NEW(s->dq, s->m->nq, err));
    PM_TRY(PM_NEW(s->first, s->m->nq, err));
    PM_TRY(PM_NEW(s->second, s->m->nq, err));
    PM_TRY(PM_NEW(s->nodal, 3 * s->m->nn, err));
    PM_TRY(pm_model_pressure_new(s->m, &s->pressure, err));
    PM_TRY(pm_config_new(s->m, &s->trial, err));
done:
    return status;
}

/* Exact tangent at the solution: stability, and the factor for the Jacobian. */
static enum pm_status finish(struct solver *s, const double *p, struct pm_config *c,
                             struct pm_err *err)
{
    int definite;
    memcpy(s->p, p, (size_t)s->m->mesh->nc * sizeof *p);
    evaluate(s, c);
    enum pm_status status = pm_model_factor(s->m, c, p, s->f, NULL, &definite, err);
    if (status == PM_OK && !definite)
        status =
            pm_fail(err, PM_NUMERIC,
                    "equilibrium at full load is unstable: its tangent is not positive definite");
    s->r->energy = s->Pi;
    for (ptrdiff_t r = 0; r < s->m->mesh->nc; r++)
        s->r->energy += p[r] * s->volume[r];
    return status;
}

/* From a guess: corrected at its own loads, then followed to p. */
static enum pm_status start_from_guess(struct solver *s, const struct pm_guess *guess,
                                       const double *p, struct pm_config *c, enum outcome *out,
                                       struct pm_err *err)
{
    enum pm_status status;
    const struct path path = {guess->at, p, 1.0};
    int same = memcmp(guess->at, p, (size_t)s->m->mesh->nc * sizeof *p) == 0;
    set_pressure(s, &path, 0.0);
    if (guess->pressure != NULL)
        memcpy(s->pressure, guess->pressure,
               (size_t)(s->m->nb * s->m->space.type->nq) * sizeof *s->pressure);
    pm_model_move(s->m, c, s->first, 0.0, c); /* places the end-effector's nodes on this mesh */
    PM_TRY(
        newton(s, c, same ? s->o->tolerance : path_tolerance, guess->pressure != NULL, out, err));
    if (*out == CONVERGED && !same)
        PM_TRY(follow_path(s, &path, s->r->newton_steps > 0, c, out, err));
    s->r->warm = *out == CONVERGED;
    if (*out != CONVERGED) {
        s->r->backoffs++;
        if (!guess->only)
            pm_warn("the guess does not lead to an equilibrium (%s): starting from the undeformed "
                    "state",
                    s->r->why);
    }
done:
    return status;
}

enum pm_status pm_equilibrium(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                              const struct pm_guess *guess, struct pm_config *c, double *volume,
                              double *f, struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    enum outcome out = REFUSED;
    struct solver s = {.m = m, .o = o, .r = r, .f = f, .volume = volume};
    struct pm_config undeformed = {0};
    double *zero = NULL;
    long before = m->factorisations;
    *r = (struct pm_solve_report){0};
    PM_TRY(allocate(&s, err));
    PM_TRY(PM_NEW(zero, m->mesh->nc, err));
    PM_TRY(pm_config_new(m, &undeformed, err));
    measure_load(&s, &undeformed, p);
    if (guess != NULL && s.load_norm > 0.0)
        PM_TRY(start_from_guess(&s, guess, p, c, &out, err));
    if (out != CONVERGED && guess != NULL && guess->only)
        PM_TRY(pm_fail(err, PM_NUMERIC, "the guess does not lead to an equilibrium: %s", r->why));
    if (out != CONVERGED) {
        const struct path path = {zero, p, o->first_step};
        pm_config_copy(m, &undeformed, c);
        if (s.load_norm > 0.0)
            PM_TRY(follow_path(&s, &path, 0, c, &out, err));
        else
            out = CONVERGED; /* no pressure: the undeformed state */
    }
    if (out == CONVERGED)
        PM_TRY(finish(&s, p, c, err));
    else
        status =
            pm_fail(err, PM_NUMERIC, "no stable equilibrium beyond load %.4f of the pressures: %s",
                    r->lambda, r->why);
done:
    r->factorisations = m->factorisations - before;
    pm_progress("%s", "");
    pm_config_release(&s.trial);
    pm_config_release(&undeformed);
    pm_free(zero);
    pm_free(s.p);
    pm_free(s.g);
    pm_free(s.dq);
    pm_free(s.first);
    pm_free(s.second);
    pm_free(s.nodal);
    pm_free(s.pressure);
    return status;
}
