/* Which constraints may become active, and the feet of the walls. */
#include "common/geometry/feet.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"
#include "common/geometry/distance.h"
#include "common/geometry/domain.h"

/* GEODESIC: half a circle of diameter d is pi/2 d long, so a fold of allowed curvature, or as wide
 * as a wall, does not count as its own neighbour. Further along the surface the least distance
 * grows from the diameter of such a fold by RISE per length, so that the end of a fin need not be
 * thicker than its fold and no limit comes into force at once. TIGHT: further from its limit, a
 * sample's nearest sample will do for a foot. */
static const double GEODESIC = 1.6, RISE = 0.25, TIGHT = 0.15;

int pm_feet_moves(const struct pm_surfaces *s, ptrdiff_t m)
{
    ptrdiff_t k = 0;
    while (m >= s->offset[k + 1])
        k++;
    const uint8_t *f = s->s[k].free + 3 * (m - s->offset[k]);
    return f[0] || f[1] || f[2];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The list of walls while it is made anew: the old one gives starts and multipliers. */
struct collection {
    struct pm_penalty *p;
    const double *phi;
    double reach;
    const struct pm_penalty_wall *old, *end;
    struct pm_penalty_wall *wall;
    ptrdiff_t n;
};

/* Diameter of the sharpest fold that is not its own neighbour. */
static double fold(const struct pm_case *c)
{
    return fmin(c->wall_min, 2 / c->curvature_max);
}

static double limit_of(const struct pm_penalty *p, const struct pm_near *q)
{
    const int inside = p->samples.surface[q->i] > 0 ? PM_NEAR_INSIDE : PM_NEAR_OUTSIDE;
    const double limit = q->other == inside ? p->c->void_min : p->c->wall_min;
    return fmin(limit, fold(p->c) + RISE * (q->along - GEODESIC * fold(p->c)));
}

/* Foot of sample q->i near q->j, from S; the sample j itself where the search slides along a
 * surface that bends back to sample i. */
static enum pm_status find_foot(struct collection *c, const struct pm_near *q, double S[3],
                                double r[3], struct pm_err *err)
{
    enum pm_status status;
    struct pm_penalty *p = c->p;
    const int32_t b = p->samples.surface[q->j];
    const double *phi = c->phi + 3 * p->s->offset[b], *x = &p->x[3 * q->j];
    double distance;

    PM_TRY(pm_distance_project(p->map[b], p->s->s[b].type, phi, &p->x[3 * q->i], &p->work, S, r,
                               &distance, err));
    const double slide = hypot(hypot(r[0] - x[0], r[1] - x[1]), r[2] - x[2]);
    const int lost = q->other < 0 && (slide > p->cover || distance < q->distance / 2);
    if (lost || !(distance <= q->distance)) {
        memcpy(S, &p->samples.S[3 * q->j], 3 * sizeof *S);
        memcpy(r, x, 3 * sizeof *r);
    }
done:
    return status;
}

/* m: along the line to the foot; on another surface the side of the solid has the last word. */
static void direct(const struct pm_penalty *p, const struct pm_near *q, const double r[3],
                   const double n[3], double m[3])
{
    const double side = p->samples.surface[q->j] > 0 ? 1 : -1;
    for (int k = 0; k < 3; k++)
        m[k] = p->x[3 * q->i + k] - r[k];
    const double length = sqrt(dot(m, m));
    const double sign = q->other < 0 || side * dot(m, n) > 0 ? 1 : -1;
    for (int k = 0; k < 3; k++)
        m[k] = length > 1e-3 * p->c->wall_min ? sign * m[k] / length : side * n[k];
}

static enum pm_status keep_weights(struct collection *c, int32_t surface, int *moves,
                                   struct pm_err *err)
{
    struct pm_penalty *p = c->p;
    const struct pm_basis *b = &p->work;

    if (p->nw + b->n > p->capacity) {
        const ptrdiff_t more = 2 * p->capacity + 1024 + b->n;
        int32_t *col = pm_realloc(p->col, more, sizeof *col, err);
        p->col = col != NULL ? col : p->col;
        double *weight = pm_realloc(p->weight, more, sizeof *weight, err);
        p->weight = weight != NULL ? weight : p->weight;
        if (col == NULL || weight == NULL)
            return PM_SYSTEM;
        p->capacity = more;
    }
    for (ptrdiff_t k = 0; k < b->n; k++) {
        p->col[p->nw] = (int32_t)(p->s->offset[surface] + b->id[k]);
        *moves |= pm_feet_moves(p->s, p->col[p->nw]);
        p->weight[p->nw++] = b->c[k];
    }
    return PM_OK;
}

static int before(const struct pm_penalty_wall *a, const struct pm_near *b)
{
    return a->i != b->i ? a->i < b->i : a->other < b->other;
}

static enum pm_status add_wall(struct collection *c, const struct pm_near *q, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_penalty *p = c->p;
    const int32_t b = p->samples.surface[q->j];
    const double *phi = c->phi + 3 * p->s->offset[b];
    const struct pm_penalty_wall *old = NULL;
    struct pm_penalty_wall *t = &c->wall[c->n];
    double r[3], r_a[6];
    struct pm_curvature at;
    int moves = p->from[q->i] == 2;

    while (c->old < c->end && before(c->old, q))
        c->old++;
    if (c->old < c->end && c->old->i == q->i && c->old->other == q->other)
        old = c->old;
    *t = (struct pm_penalty_wall){.i = q->i, .other = q->other, .limit = limit_of(p, q)};
    if (q->distance > hypot(t->limit + c->reach, p->cover))
        return PM_OK;
    memcpy(t->S, &p->samples.S[3 * q->j], sizeof t->S);
    memcpy(r, &p->x[3 * q->j], sizeof r);
    if (q->distance < hypot(t->limit * (1 + TIGHT), p->cover)) {
        if (old != NULL)
            memcpy(t->S, old->S, sizeof t->S);
        PM_TRY(find_foot(c, q, t->S, r, err));
    }
    PM_TRY(pm_map_basis(p->map[b], t->S, 1, &p->work, err));
    pm_basis_apply(&p->work, phi, NULL, r_a, NULL);
    pm_curvature_at(r_a, NULL, &at);
    direct(p, q, r, at.n, t->m);
    const double e[3] = {p->x[3 * q->i] - r[0], p->x[3 * q->i + 1] - r[1],
                         p->x[3 * q->i + 2] - r[2]};
    if (dot(e, t->m) > t->limit + c->reach)
        goto done;
    t->multiplier = old != NULL ? old->multiplier : 0;
    t->first = p->nw;
    PM_TRY(keep_weights(c, b, &moves, err));
    if (moves)
        c->n++;
    else
        p->nw = t->first;
done:
    return status;
}

static enum pm_status collect_walls(struct pm_penalty *p, const double *phi, double reach,
                                    struct pm_err *err)
{
    enum pm_status status;
    struct collection c = {
        .p = p, .phi = phi, .reach = reach, .old = p->wall, .end = p->wall + p->nwall};
    struct pm_near *near = NULL;
    ptrdiff_t n = 0;

    const double wall = p->c->wall_min, cutoff[2] = {hypot(wall + reach, p->cover),
                                                     hypot(p->c->void_min + reach, p->cover)};
    PM_TRY(pm_samples_near(&p->samples, p->s->ns, p->x, p->normal, p->from, cutoff,
                           GEODESIC * fold(p->c), &near, &n, err));
    PM_TRY(PM_NEW(c.wall, n + 1, err));
    p->nw = 0;
    for (ptrdiff_t k = 0; k < n; k++)
        PM_TRY(add_wall(&c, &near[k], err));
    c.wall[c.n] = (struct pm_penalty_wall){.i = -1, .first = p->nw};
    pm_free(p->wall);
    p->wall = c.wall;
    p->nwall = c.n;
    c.wall = NULL;
done:
    pm_free(c.wall);
    pm_free(near);
    return status;
}

enum pm_status pm_penalty_collect(struct pm_penalty *p, const double *phi, double reach,
                                  double calm, struct pm_err *err)
{
    const struct pm_samples *q = &p->samples;
    const double quiet = calm * calm * p->c->curvature_max * p->c->curvature_max;
    double n[3], r_a[6], r_ab[9] = {0};
    struct pm_curvature c;

    for (ptrdiff_t i = 0; i < q->n; i++) {
        pm_samples_at(q, i, phi, &p->x[3 * i], r_a, p->from[i] ? r_ab : NULL);
        pm_samples_metric(&p->samples, i, r_a);
        pm_curvature_at(r_a, p->from[i] ? r_ab : NULL, &c);
        memcpy(&p->normal[3 * i], c.n, sizeof c.n);
        p->flag[i] = 0;
        if (p->from[i] != 2)
            continue;
        if (c.Q > quiet || p->bend[i] > 0)
            p->flag[i] |= PM_FEET_BEND;
        for (int k = 0; k < 3; k++)
            if (pm_domain_depth(p->c, q->surface[i] > 0, k, &p->x[3 * i], n) + reach > 0 ||
                p->bound[3 * i + k] > 0)
                p->flag[i] |= PM_FEET_BOUND;
    }
    return collect_walls(p, phi, reach, err);
}
