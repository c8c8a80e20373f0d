#include "tools/invkin/pursue.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "tools/invkin/box.h"

static const double degree = 0.017453292519943295;
/* Steps below this part of the range of pressures say nothing more. */
static const double least_step = 1e-7;
/* Gains over predicted ones: below the first a step is refused, below the second the trust region
 * shrinks, above the third it grows. */
static const double poor = 0.05, fair = 0.25, good = 0.75;

/* Pressures without an equilibrium after which the way is blocked: each costs a whole search. */
enum { MOST_FAILURES = 4 };

static double norm(int n, const double *v)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += v[i] * v[i];
    return sqrt(sum);
}

static double weight(const struct pursue_task *t, int i)
{
    return t->dof[i] < 3 ? 1.0 : t->length;
}

static void deviation(const struct pursue_task *t, const double U[6], double *e)
{
    for (int i = 0; i < t->nd; i++)
        e[i] = weight(t, i) * (U[t->dof[i]] - t->target[i]);
}

double pursue_distance(const struct pursue_task *t, const double U[6])
{
    double e[6];
    deviation(t, U, e);
    return norm(t->nd, e);
}

/* The parts of e: positions [mm], rotation vectors [rad]. */
static void split(const struct pursue_task *t, const double *e, double error[2])
{
    error[0] = error[1] = 0.0;
    for (int i = 0; i < t->nd; i++) {
        double *part = &error[t->dof[i] >= 3];
        *part = hypot(*part, e[i] / weight(t, i));
    }
}

static int close_enough(const struct pursue_task *t, const double *e)
{
    double error[2];
    split(t, e, error);
    return error[0] <= t->tolerance && error[1] <= t->tolerance * degree;
}

/* The step dp from a pose within the bounds, no component longer than `longest`; returns its |D J
 * dp|. ahead = e + D J dp. */
static double propose(const struct pursue_task *t, const struct pursue_pose *at, const double *e,
                      double longest, double *dp, double *ahead)
{
    double A[6 * PM_MAX_CHAMBERS], low[PM_MAX_CHAMBERS], high[PM_MAX_CHAMBERS], move[6];
    for (int i = 0; i < t->nd; i++)
        for (int r = 0; r < t->n; r++)
            A[t->n * i + r] = weight(t, i) * at->J[t->n * t->dof[i] + r];
    for (int r = 0; r < t->n; r++) {
        low[r] = fmin(0.0, fmax(t->low - at->p[r], -longest));
        high[r] = fmax(0.0, fmin(t->high - at->p[r], longest));
    }
    box_least_squares(t->nd, t->n, A, e, low, high, dp);
    for (int i = 0; i < t->nd; i++) {
        move[i] = 0.0;
        for (int r = 0; r < t->n; r++)
            move[i] += A[t->n * i + r] * dp[r];
        ahead[i] = e[i] + move[i];
    }
    return norm(t->nd, move);
}

/* How far a pose may be from another one to be the same to the tolerance [mm]. */
static double stillness(const struct pursue_task *t)
{
    double still = INFINITY;
    for (int i = 0; i < t->nd; i++)
        still = fmin(still, weight(t, i) * t->tolerance * (t->dof[i] < 3 ? 1.0 : degree));
    return still;
}

/* The pose at best + dp: r->best where it is nearer, and the new trust region. */
static enum pm_status attempt(const struct pursue_task *t, const double *dp, double predicted,
                              double *longest, struct pursue_result *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_err why = {0};
    struct pursue_pose next;
    double size = 0.0;
    const double before = pursue_distance(t, r->best.U);
    for (int k = 0; k < t->n; k++) {
        next.p[k] = fmin(t->high, fmax(t->low, r->best.p[k] + dp[k]));
        size = fmax(size, fabs(dp[k]));
    }
    r->equilibria++;
    status = t->pose(t->data, next.p, next.U, next.J, &why);
    if (status == PM_NUMERIC) {
        r->failures++;
        snprintf(r->why, sizeof r->why, "%.191s", why.text);
        *longest = 0.5 * size;
        return PM_OK;
    }
    if (status != PM_OK) {
        *err = why;
        return status;
    }
    const double after = pursue_distance(t, next.U);
    const double ratio =
        (before * before - after * after) / (before * before - predicted * predicted);
    pm_log(2, "step %.3g: distance %.6g after %.6g, gain %.3f of the predicted one", size, after,
           before, ratio);
    if (ratio < fair)
        *longest = 0.5 * size * (ratio < 0.0 ? 0.5 : 1.0);
    else if (ratio > good)
        *longest = fmax(*longest, 2.0 * size);
    if (ratio >= poor && after < before) {
        r->best = next;
        r->iterations++;
    }
    return PM_OK;
}

static void mark_bounds(const struct pursue_task *t, struct pursue_result *r)
{
    const double room = least_step * (t->high - t->low);
    for (int k = 0; k < t->n; k++) {
        r->bound[k] = (r->best.p[k] >= t->high - room) - (r->best.p[k] <= t->low + room);
        if (r->verdict == PM_NEAREST && r->bound[k] != 0)
            r->verdict = PM_AT_BOUND;
    }
}

enum pm_status pursue(const struct pursue_task *t, const struct pursue_pose *start,
                      struct pursue_result *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double e[6], ahead[6], dp[PM_MAX_CHAMBERS], longest = t->high - t->low;
    *r = (struct pursue_result){.best = *start, .verdict = PM_UNFINISHED};
    for (;;) {
        deviation(t, r->best.U, e);
        if (close_enough(t, e)) {
            r->verdict = PM_REACHED;
            break;
        }
        const double move = propose(t, &r->best, e, INFINITY, dp, ahead);
        if (move <= stillness(t) && !close_enough(t, ahead)) {
            r->verdict = PM_NEAREST;
            break;
        }
        if (r->failures == MOST_FAILURES) {
            r->verdict = PM_NO_EQUILIBRIUM;
            break;
        }
        if (r->equilibria >= t->most || longest < least_step * (t->high - t->low))
            break;
        propose(t, &r->best, e, longest, dp, ahead);
        PM_TRY(attempt(t, dp, norm(t->nd, ahead), &longest, r, err));
    }
    deviation(t, r->best.U, e);
    split(t, e, r->error);
    mark_bounds(t, r);
done:
    return status;
}
