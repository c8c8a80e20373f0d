#include "tools/trstep/subproblem.h"

#include <lbfgs.h>
#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"

/* Weights of the two bounds relative to the largest linear gain: 4 BALL t (t^2 - 1) = 1 at the end
 * of an unconstrained step, t = 1.012, which the scaling removes. */
static const double BALL = 10, POINT = 100;

struct scaled {
    const struct subproblem *s;
    double gain;   /* largest linear gain |G|* radius, the unit of the objective */
    double *step;  /* (N x 3) */
    double *slope; /* derivative by step (N x 3) */
    ptrdiff_t evaluations;
};

double subproblem_norm(const struct subproblem *s, const double *step)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < 3 * s->N; i++)
        sum += s->mass[i / 3] * step[i] * step[i];
    return sqrt(sum);
}

double subproblem_dual_norm(const struct subproblem *s, const double *gradient)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < 3 * s->N; i++)
        sum += gradient[i] * gradient[i] / s->mass[i / 3];
    return sqrt(sum);
}

static double point_square(const double *step)
{
    return step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
}

/* Unknowns z = M^(1/2) step/radius: the ball is |z| <= 1, and the result does not depend on how
 * dense the control points are. */
static lbfgsfloatval_t evaluate(void *instance, const lbfgsfloatval_t *z, lbfgsfloatval_t *g,
                                const int n, const lbfgsfloatval_t length)
{
    struct scaled *c = instance;
    const struct subproblem *s = c->s;
    const double cap = 4 * s->radius * s->radius;
    double f = 0, ball = -1;

    (void)length;
    c->evaluations++;
    for (ptrdiff_t i = 3 * s->N; i < n; i++) /* SSE builds of the library round n up */
        g[i] = 0;
    for (ptrdiff_t i = 0; i < 3 * s->N; i++) {
        c->step[i] = z[i] * s->radius / sqrt(s->mass[i / 3]);
        c->slope[i] = -s->gradient[i];
        f -= s->gradient[i] * c->step[i];
        ball += z[i] * z[i];
    }
    f += s->penalty(s->context, c->step, c->slope);
    f /= c->gain;
    for (ptrdiff_t m = 0; m < s->N; m++) {
        const double excess = point_square(c->step + 3 * m) / cap - 1;
        if (!(excess > 0))
            continue;
        f += POINT * s->mass[m] * excess * excess;
        for (ptrdiff_t i = 3 * m; i < 3 * m + 3; i++)
            c->slope[i] += c->gain * POINT * s->mass[m] * 4 * excess * c->step[i] / cap;
    }
    s->project(s->context, c->slope);
    const double over = fmax(ball, 0);
    f += BALL * over * over;
    for (ptrdiff_t i = 0; i < 3 * s->N; i++)
        g[i] = c->slope[i] * s->radius / sqrt(s->mass[i / 3]) / c->gain + 4 * BALL * over * z[i];
    return isfinite(f) ? f + 2 : HUGE_VAL; /* positive, as the relative stopping rule wants it */
}

static void bound_step(const struct subproblem *s, double *step)
{
    const double cap = 2 * s->radius;
    for (ptrdiff_t m = 0; m < s->N; m++) {
        const double length = sqrt(point_square(step + 3 * m));
        for (ptrdiff_t i = 3 * m; i < 3 * m + 3 && length > cap; i++)
            step[i] *= cap / length;
    }
    const double norm = subproblem_norm(s, step);
    for (ptrdiff_t i = 0; i < 3 * s->N && norm > s->radius; i++)
        step[i] *= s->radius / norm;
}

/* Interpolation cannot bracket where a step folds a surface (infinite curvature); halving survives
 * that but may miss the narrow range of a steep penalty. Each takes over where the other gives up,
 * from the best point so far. */
static enum pm_status minimise(struct scaled *c, ptrdiff_t n, lbfgsfloatval_t *z,
                               struct pm_err *err)
{
    static const int searches[] = {LBFGS_LINESEARCH_MORETHUENTE,
                                   LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE,
                                   LBFGS_LINESEARCH_MORETHUENTE};
    lbfgs_parameter_t parameter;
    lbfgsfloatval_t f = 0;
    int end = -1;

    lbfgs_parameter_init(&parameter);
    parameter.m = 10;
    parameter.max_iterations = 50;
    parameter.epsilon = 1e-3;
    parameter.past = 5; /* also ends where five iterations gain less than 3e-4 of the objective */
    parameter.delta = 3e-4;
    for (int k = 0; k < 3 && end < 0 && end != LBFGSERR_MAXIMUMITERATION; k++) {
        parameter.linesearch = searches[k];
        end = lbfgs((int)n, z, &f, evaluate, NULL, c, &parameter);
        pm_log(2, "L-BFGS: code %d after %td evaluations, objective %.4g", end, c->evaluations,
               f - 2);
        if (end == LBFGSERR_OUTOFMEMORY)
            return pm_fail(err, PM_SYSTEM, "out of memory");
    }
    return PM_OK;
}

enum pm_status subproblem_solve(const struct subproblem *s, double *step, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t n = 3 * s->N;
    struct scaled c = {
        .s = s, .gain = s->radius * subproblem_dual_norm(s, s->gradient), .step = step};
    lbfgsfloatval_t *z = lbfgs_malloc((int)n);

    if (z == NULL)
        return pm_fail(err, PM_SYSTEM, "out of memory");
    PM_TRY(PM_NEW(c.slope, n, err));
    if (!(c.gain > 0) || !isfinite(c.gain))
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "the gradient of the measure is %g, expected a positive norm", c.gain));
    for (ptrdiff_t i = 0; i < n; i++)
        z[i] = step[i] * sqrt(s->mass[i / 3]) / s->radius;
    PM_TRY(minimise(&c, n, z, err));
    for (ptrdiff_t i = 0; i < n; i++)
        step[i] = z[i] * s->radius / sqrt(s->mass[i / 3]);
    s->project(s->context, step);
    bound_step(s, step);
done:
    pm_free(c.slope);
    lbfgs_free(z);
    return status;
}

void subproblem_mass(const struct pm_surfaces *s, const struct pm_samples *samples, double *mass)
{
    const ptrdiff_t N = s->offset[s->ns], nops = s->pcase.symmetry.nops;
    double area = 0;

    memset(mass, 0, (size_t)N * sizeof *mass);
    for (ptrdiff_t q = 0; q < samples->n; q++) {
        area += samples->area[q];
        for (ptrdiff_t w = samples->ptr[q]; w < samples->ptr[q + 1]; w++)
            mass[samples->col[w]] += samples->area[q] * samples->c[w];
    }
    /* Orbits: images are visited from their first member, every member gets the mean. A floor keeps
     * points that hardly move a surface from taking all of a step. */
    for (ptrdiff_t i = 0; i < N; i++) {
        ptrdiff_t first = i;
        double sum = 0;
        for (ptrdiff_t g = 0; g < nops; g++)
            first = s->perm[g * N + i] < first ? s->perm[g * N + i] : first;
        if (first < i)
            continue;
        for (ptrdiff_t g = 0; g < nops; g++)
            sum += mass[s->perm[g * N + i]];
        const double mean = fmax(sum / (double)nops / area, 0.01 / (double)N);
        for (ptrdiff_t g = 0; g < nops; g++)
            mass[s->perm[g * N + i]] = mean;
    }
}
