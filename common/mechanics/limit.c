#include "common/mechanics/limit.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/krylov.h"
#include "common/mechanics/newton.h"
#include "common/mechanics/tensor.h"

/* Pressure control ends here, volume control begins: it needs no halving down to the limit. */
static const double last_step = 1.0 / 32;
/* The search ends where the factor would rise by less than this part of it. */
static const double rise = 1e-8;
/* The first step, of sum_r p_r V_r. */
static const double first_step = 0.02;
enum { MOST_STEPS = 40, MOST_CORRECTIONS = 12, MOST_HALVINGS = 8 };

/* Volume control: unknowns q and the load factor. */
struct control {
    struct pm_newton s;
    const double *p;
    double factor, work, slope; /* load factor, w = sum_r p_r V_r, d factor/dw */
    double *x, *b;              /* two right-hand sides and solutions (2 x nq); b = dw/dq (nq) */
    struct pm_config last;
};

static int evaluate(struct control *k, const struct pm_config *c)
{
    ptrdiff_t nc = k->s.m->mesh->nc;
    for (ptrdiff_t r = 0; r < nc; r++)
        k->s.p[r] = k->factor * k->p[r];
    if (!pm_newton_evaluate(&k->s, c))
        return 0;
    k->work = 0.0;
    for (ptrdiff_t r = 0; r < nc; r++)
        k->work += k->p[r] * k->s.volume[r];
    return 1;
}

/* b = dw/dq at c */
static void work_gradient(struct control *k, const struct pm_config *c)
{
    struct pm_model *m = k->s.m;
    memset(k->b, 0, (size_t)m->nq * sizeof *k->b);
    for (ptrdiff_t r = 0; r < m->mesh->nc; r++) {
        pm_model_volume_gradient(m, c, r, k->s.nodal);
        pm_model_reduce(m, c, k->s.nodal, k->s.dq);
        for (ptrdiff_t i = 0; i < m->nq; i++)
            k->b[i] += k->p[r] * k->s.dq[i];
    }
}

/* Newton correction at c to w = target: dq into s.dq, the change of the factor returned in *dl, the
 * slope in k->slope. *good = 0: no convergence of the linear solver. */
static enum pm_status correction(struct control *k, const struct pm_config *c, double target,
                                 double *dl, int *good, struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = k->s.m;
    ptrdiff_t nq = m->nq;
    struct pm_krylov_report report;
    double *y = k->x + nq, dw = target - k->work;
    work_gradient(k, c);
    pm_model_assemble(m, c, k->s.p, k->s.f, NULL);
    for (ptrdiff_t i = 0; i < nq; i++) {
        k->x[i] = -k->s.g[i];
        y[i] = k->b[i];
    }
    PM_TRY(pm_krylov_solve_stiffened(m, k->b, k->x, 2, 1e-8, 200, &report, err));
    *good = report.good;
    double by = pm_dot(nq, k->b, y), gamma = report.gamma;
    /* K_g dq = -g + (dl + gamma dw) b,  b . dq = dw */
    double a = (dw - pm_dot(nq, k->b, k->x)) / by;
    *dl = a - gamma * dw;
    k->slope = 1.0 / by - gamma; /* of K t = slope b, b . t = 1 */
    for (ptrdiff_t i = 0; i < nq; i++)
        k->s.dq[i] = k->x[i] + a * y[i];
done:
    return status;
}

/* Equilibrium with w = target from c. */
static enum pm_status prescribe(struct control *k, struct pm_config *c, double target, int *reached,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_model *m = k->s.m;
    double dl;
    *reached = 0;
    for (int n = 0; n < MOST_CORRECTIONS && !*reached; n++) {
        int good;
        if (!evaluate(k, c))
            break;
        PM_TRY(correction(k, c, target, &dl, &good, err));
        if (!good)
            break;
        *reached =
            k->s.residual < k->s.o->tolerance && fabs(target - k->work) < 1e-9 * fabs(target);
        if (*reached)
            break;
        if (k->s.warp == NULL)
            PM_TRY(pm_warp_new(m, &k->s.warp, err));
        pm_model_expand(m, c, k->s.dq, k->s.nodal);
        if (n == 0) /* the step itself may turn parts of the body */
            PM_TRY(pm_warp_move(k->s.warp, c, k->s.nodal, NULL, &k->s.trial, err));
        else
            pm_model_move(m, c, k->s.dq, 1.0, &k->s.trial);
        pm_config_copy(m, &k->s.trial, c);
        k->factor += dl;
    }
done:
    return status;
}

/* Secants for slope = 0 from the equilibrium c; first: the first change of w. */
static enum pm_status search(struct control *k, struct pm_config *c, double first,
                             struct pm_limit *limit, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double step = first;
    int reached;
    for (limit->steps = 0; limit->steps < MOST_STEPS; limit->steps++) {
        double work = k->work, slope = k->slope, factor = k->factor;
        pm_config_copy(k->s.m, c, &k->last);
        reached = 0;
        for (int n = 0; n < MOST_HALVINGS && !reached; n++) {
            PM_TRY(prescribe(k, c, work + step, &reached, err));
            if (!reached) {
                pm_config_copy(k->s.m, &k->last, c);
                k->factor = factor;
                step *= 0.5;
            }
        }
        if (!reached)
            return pm_fail(err, PM_NUMERIC,
                           "volume control stopped at %.6f of the pressures before their limit",
                           factor);
        double bend = (k->slope - slope) / (k->work - work);
        double gain = bend < 0.0 ? -0.5 * k->slope * k->slope / bend : (double)INFINITY;
        limit->factor = k->factor + gain;
        pm_log(2, "volume control: factor %.9f, it can rise by %.1e", k->factor, gain);
        if (gain < rise * k->factor)
            return PM_OK;
        /* to the zero of the secant, at most three times the last step */
        double next = bend < 0.0 ? -k->slope / bend : 3.0 * fabs(step);
        step = fmax(-3.0 * fabs(step), fmin(3.0 * fabs(step), next));
    }
    status = pm_fail(err, PM_NUMERIC,
                     "no limit found after %d steps of volume control, at %.6f of "
                     "the pressures",
                     (int)MOST_STEPS, k->factor);
done:
    return status;
}

static enum pm_status control_limit(struct pm_model *m, const double *p,
                                    const struct pm_solve_options *o, const struct pm_config *c,
                                    struct pm_solve_report *r, struct pm_limit *limit,
                                    struct pm_err *err)
{
    enum pm_status status;
    struct control k = {.p = p, .factor = r->lambda};
    struct pm_config at = {0};
    double *f = NULL, *volume = NULL, dl;
    int good;
    PM_TRY(PM_NEW(f, 3 * m->nn, err));
    PM_TRY(PM_NEW(volume, m->mesh->nc, err));
    PM_TRY(PM_NEW(k.x, 2 * m->nq, err));
    PM_TRY(PM_NEW(k.b, m->nq, err));
    PM_TRY(pm_config_new(m, &k.last, err));
    PM_TRY(pm_config_new(m, &at, err));
    PM_TRY(pm_newton_new(m, o, r, f, volume, &k.s, err));
    pm_newton_measure_load(&k.s, p);
    pm_config_copy(m, c, &at);
    evaluate(&k, &at);
    PM_TRY(correction(&k, &at, k.work, &dl, &good, err));
    if (good)
        PM_TRY(search(&k, &at, fmin(first_step * k.work, 0.25 * last_step / fabs(k.slope)), limit,
                      err));
    else
        status = pm_fail(err, PM_NUMERIC, "volume control cannot start at %.6f of the pressures",
                         r->lambda);
done:
    pm_newton_release(&k.s);
    pm_config_release(&k.last);
    pm_config_release(&at);
    pm_free(k.x);
    pm_free(k.b);
    pm_free(f);
    pm_free(volume);
    return status;
}

/* The end of the path that r describes, solved well: c. Close to the limit the rough one may lie
 * beyond it; then from zero to a little less. */
static enum pm_status last_stable(struct pm_model *m, const double *p, double *q,
                                  const struct pm_solve_options *o, struct pm_config *c,
                                  double *volume, double *f, struct pm_solve_report *r,
                                  struct pm_limit *limit, struct pm_err *err)
{
    enum pm_status status = PM_NUMERIC;
    struct pm_solve_report sum = *r;
    struct pm_err why = {0};
    const struct pm_guess guess = {.at = q};
    for (int n = 0; n < 4 && status == PM_NUMERIC; n++) {
        limit->reached = sum.lambda * (1.0 - 0.03 * n);
        for (ptrdiff_t i = 0; i < m->mesh->nc; i++)
            q[i] = limit->reached * p[i];
        status = pm_equilibrium(m, q, o, n == 0 ? &guess : NULL, c, volume, f, r, &why);
        sum.load_steps += r->load_steps;
        sum.newton_steps += r->newton_steps;
        sum.backoffs += r->backoffs;
        sum.factorisations += r->factorisations;
    }
    if (status != PM_OK)
        *err = why;
    r->load_steps = sum.load_steps;
    r->newton_steps = sum.newton_steps;
    r->backoffs = sum.backoffs;
    r->factorisations = sum.factorisations;
    r->lambda = limit->reached;
    r->warm = 0;
    return status;
}

enum pm_status pm_limit_find(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                             struct pm_config *c, double *volume, double *f,
                             struct pm_solve_report *r, struct pm_limit *limit, struct pm_err *err)
{
    enum pm_status status;
    struct pm_solve_options coarse = *o;
    struct pm_err why = {0};
    double *q = NULL;
    int definite;
    *limit = (struct pm_limit){.factor = 1.0, .reached = 1.0};
    coarse.min_step = last_step;
    PM_TRY(PM_NEW(q, m->mesh->nc, err));
    status = pm_equilibrium(m, p, &coarse, NULL, c, volume, f, r, &why);
    if (status == PM_NUMERIC && r->lambda > 0.0) {
        limit->found = 1;
        PM_TRY(last_stable(m, p, q, o, c, volume, f, r, limit, err));
        long before = m->factorisations;
        PM_TRY(control_limit(m, p, o, c, r, limit, err));
        PM_TRY(pm_model_factor(m, c, q, f, NULL, &definite, err));
        r->factorisations += m->factorisations - before;
    } else if (status != PM_OK) {
        *err = why;
    }
done:
    pm_free(q);
    return status;
}
