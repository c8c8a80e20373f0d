#include "tools/trstep/subproblem.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/base/minimise.h"

/* Weights of the two bounds relative to the largest linear gain: 4 BALL t (t^2 - 1) = 1 at the end
 * of an unconstrained step, t = 1.012, which the scaling removes. */
static const double BALL = 10, POINT = 100;

struct scaled {
    const struct subproblem *s;
    double gain;   /* largest linear gain |G|* radius, the unit of the objective */
    double *step;  /* (N x 3) */
    double *slope; /* derivative by step (N x 3) */
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
static double evaluate(void *context, const double *z, double *g)
{
    struct scaled *c = context;
    const struct subproblem *s = c->s;
    const double cap = 4 * s->radius * s->radius;
    double f = 0, ball = -1;

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

enum pm_status subproblem_solve(const struct subproblem *s, double *step, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t n = 3 * s->N;
    struct scaled c = {
        .s = s, .gain = s->radius * subproblem_dual_norm(s, s->gradient), .step = step};
    double *z = NULL;

    PM_TRY(PM_NEW(z, n, err));
    PM_TRY(PM_NEW(c.slope, n, err));
    if (!(c.gain > 0) || !isfinite(c.gain))
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "the gradient of the measure is %g, expected a positive norm", c.gain));
    for (ptrdiff_t i = 0; i < n; i++)
        z[i] = step[i] * sqrt(s->mass[i / 3]) / s->radius;
    PM_TRY(pm_minimise(n, z, evaluate, &c, err));
    for (ptrdiff_t i = 0; i < n; i++)
        step[i] = z[i] * s->radius / sqrt(s->mass[i / 3]);
    s->project(s->context, step);
    bound_step(s, step);
done:
    pm_free(c.slope);
    pm_free(z);
    return status;
}
