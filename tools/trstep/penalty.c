#include "tools/trstep/penalty.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"

/* VOID_SHARE: casting cores and grooves may be thinner than walls. GEODESIC: half a circle of
 * diameter d is pi/2 d long, so a fold of allowed curvature does not count as its own neighbour. */
enum { WATCH_BEND = 1, WATCH_END = 2, WATCH_PAIR = 4 };

static const double VOID_SHARE = 0.4, GEODESIC = 1.6, FOLD_SHARE = 0.2;

static double square(double x)
{
    return x * x;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int moves(const struct pm_surfaces *s, ptrdiff_t k, ptrdiff_t local)
{
    const uint8_t *f = s->s[k].free + 3 * local;
    return f[0] || f[1] || f[2];
}

enum pm_status penalty_new(const struct pm_surfaces *s, struct penalty *p, struct pm_err *err)
{
    enum pm_status status;
    const double d = s->pcase.wall_min;
    double area = 0;

    p->c = &s->pcase;
    PM_TRY(pm_samples_new(s, d / 2, 2, &p->samples, err));
    const struct pm_samples *q = &p->samples;
    PM_TRY(PM_NEW(p->share, q->n, err));
    PM_TRY(PM_NEW(p->x, 3 * q->n, err));
    PM_TRY(PM_NEW(p->force, 3 * q->n, err));
    for (ptrdiff_t i = 0; i < q->n; i++)
        area += q->area[i];
    for (ptrdiff_t i = 0; i < q->n; i++) {
        const ptrdiff_t k = q->surface[i];
        for (ptrdiff_t w = q->ptr[i]; w < q->ptr[i + 1]; w++)
            if (moves(s, k, q->col[w] - s->offset[k]))
                p->share[i] = q->area[i] / area;
    }
    /* Samples on two parallel surfaces with spacing h are at most h^2/(4 d) further apart than the
     * surfaces; h^2 = 4/sqrt(3) area for equilateral triangles. */
    p->margin = area / (double)q->n / (sqrt(3.0) * d);
done:
    return status;
}

void penalty_watch_release(struct penalty_watch *w)
{
    pm_free(w->flag);
    pm_free(w->pair);
    *w = (struct penalty_watch){0};
}

void penalty_release(struct penalty *p)
{
    pm_samples_release(&p->samples);
    pm_free(p->share);
    pm_free(p->x);
    pm_free(p->force);
    *p = (struct penalty){0};
}

/* Largest depth of z beyond the end planes: chambers keep cap_min, the exterior ends at the planes.
 */
static double end_depth(const struct penalty *p, ptrdiff_t i, double z, double *sign)
{
    const double cap = p->samples.surface[i] > 0 ? p->c->cap_min : 0;
    const double below = cap - z, above = z - (p->c->height - cap);
    *sign = below > above ? -1 : 1;
    return fmax(below, above);
}

/* The distance that a pair has to keep, 0 for none. */
static double pair_limit(const struct penalty *p, const double *x, const double *normal,
                         const struct pm_pair *q)
{
    const int32_t a = p->samples.surface[q->i], b = p->samples.surface[q->j];
    const double d = p->c->wall_min + p->margin;
    double across[3];

    if (p->share[q->i] == 0 && p->share[q->j] == 0)
        return 0;
    if (a != b)
        return d;
    for (int k = 0; k < 3; k++)
        across[k] = x[3 * q->j + k] - x[3 * q->i + k];
    /* chambers: the normal points into the solid; exterior: out of it */
    const double side = a > 0 ? 1 : -1;
    const double leave = side * dot(normal + 3 * q->i, across),
                 enter = -side * dot(normal + 3 * q->j, across);
    if (leave > 0 && enter > 0)
        return d;
    return leave < 0 && enter < 0 ? VOID_SHARE * d : 0;
}

static int before(const struct penalty_pair *a, const struct penalty_pair *b)
{
    return a->i != b->i ? a->i < b->i : a->j < b->j;
}

/* Union of two sorted lists, the old entry where both have one. */
static enum pm_status merge_pairs(struct penalty_watch *w, const struct penalty_pair *new,
                                  ptrdiff_t n, struct pm_err *err)
{
    enum pm_status status;
    struct penalty_pair *both = NULL;
    ptrdiff_t a = 0, b = 0, count = 0;

    PM_TRY(PM_NEW(both, w->npair + n, err));
    while (a < w->npair || b < n) {
        const int old = b == n || (a < w->npair && !before(&new[b], &w->pair[a]));
        if (old && b < n && !before(&w->pair[a], &new[b]))
            b++;
        both[count++] = old ? w->pair[a++] : new[b++];
    }
    pm_free(w->pair);
    w->pair = both;
    w->npair = count;
done:
    return status;
}

static enum pm_status collect_pairs(struct penalty *p, struct penalty_watch *w, double reach,
                                    const double *normal, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_samples *q = &p->samples;
    const double cutoff = p->c->wall_min + p->margin + 2 * reach;
    struct pm_pair *all = NULL;
    struct penalty_pair *new = NULL;
    ptrdiff_t n = 0, count = 0;

    PM_TRY(pm_samples_pairs(q, p->x, cutoff, GEODESIC * p->c->wall_min, &all, &n, err));
    PM_TRY(PM_NEW(new, n, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        const double limit = pair_limit(p, p->x, normal, &all[k]);
        if (limit == 0 || all[k].distance > limit + 2 * reach)
            continue;
        const int32_t i = all[k].i, j = all[k].j;
        const double share = fmax(p->share[i], p->share[j]); /* one side may be fixed */
        const double area = fmin(q->area[i], q->area[j]);
        new[count++] = (struct penalty_pair){
            .i = i, .j = j, .limit = limit, .weight = share * area / square(p->c->wall_min)};
        w->flag[i] |= WATCH_PAIR;
        w->flag[j] |= WATCH_PAIR;
    }
    PM_TRY(merge_pairs(w, new, count, err));
done:
    pm_free(all);
    pm_free(new);
    return status;
}

enum pm_status penalty_collect(struct penalty *p, struct penalty_watch *w, const double *phi,
                               double reach, double calm, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_samples *q = &p->samples;
    const double quiet = square(calm * p->c->curvature_max);
    double *normal = NULL, sign;

    PM_TRY(PM_NEW(normal, 3 * q->n, err));
    if (w->flag == NULL)
        PM_TRY(PM_NEW(w->flag, q->n, err));
    for (ptrdiff_t i = 0; i < q->n; i++) {
        double r_a[6], r_ab[9];
        struct pm_curvature c;
        pm_samples_at(q, i, phi, p->x + 3 * i, r_a, r_ab);
        pm_curvature_at(r_a, r_ab, &c);
        memcpy(normal + 3 * i, c.n, sizeof c.n);
        if (p->share[i] > 0 && c.Q > quiet)
            w->flag[i] |= WATCH_BEND;
        if (p->share[i] > 0 && end_depth(p, i, p->x[3 * i + 2], &sign) + reach > 0)
            w->flag[i] |= WATCH_END;
    }
    PM_TRY(collect_pairs(p, w, reach, normal, err));
done:
    pm_free(normal);
    return status;
}

static void add_curvature(const struct penalty *p, const struct penalty_watch *watch,
                          const double *phi, double rho, double *gradient, struct penalty_value *v)
{
    const struct pm_samples *q = &p->samples;
    const double limit = square(p->c->curvature_max);

    for (ptrdiff_t i = 0; i < q->n; i++) {
        if (!(watch->flag[i] & WATCH_BEND))
            continue;
        double r_a[6], r_ab[9], Q_a[6], Q_ab[9];
        pm_samples_at(q, i, phi, NULL, r_a, r_ab);
        const double Q = pm_curvature_gradient(r_a, r_ab, Q_a, Q_ab), excess = Q - limit;
        if (!(excess > 0))
            continue;
        v->curvature += p->share[i] * square(excess / limit);
        v->worst_curvature = fmax(v->worst_curvature, sqrt(Q / limit) - 1);
        if (gradient == NULL)
            continue;
        const double f = 2 * rho * p->share[i] * excess / square(limit);
        for (ptrdiff_t w = q->ptr[i]; w < q->ptr[i + 1]; w++)
            for (int j = 0; j < 3; j++) {
                const double *c_a = q->c_a + 2 * w, *c_ab = q->c_ab + 3 * w;
                gradient[3 * q->col[w] + j] +=
                    f * (c_a[0] * Q_a[j] + c_a[1] * Q_a[3 + j] + c_ab[0] * Q_ab[j] +
                         c_ab[1] * Q_ab[3 + j] + c_ab[2] * Q_ab[6 + j]);
            }
    }
}

static void add_pairs(struct penalty *p, const struct penalty_watch *watch, double rho,
                      struct penalty_value *v)
{
    for (ptrdiff_t k = 0; k < watch->npair; k++) {
        const struct penalty_pair *t = &watch->pair[k];
        const double *a = p->x + 3 * t->i, *b = p->x + 3 * t->j, limit = square(t->limit);
        const double e[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        const double lack = limit - dot(e, e);
        if (!(lack > 0))
            continue;
        v->wall += t->weight * square(lack / limit);
        v->worst_wall = fmax(v->worst_wall, 1 - sqrt(dot(e, e)) / t->limit);
        for (int j = 0; j < 3; j++) {
            const double f = -4 * rho * t->weight * lack / square(limit) * e[j];
            p->force[3 * t->i + j] += f;
            p->force[3 * t->j + j] -= f;
        }
    }
}

static void add_ends(struct penalty *p, const struct penalty_watch *watch, double rho,
                     struct penalty_value *v)
{
    for (ptrdiff_t i = 0; i < p->samples.n; i++) {
        double sign;
        if (!(watch->flag[i] & WATCH_END))
            continue;
        const double depth = end_depth(p, i, p->x[3 * i + 2], &sign) / p->c->wall_min;
        if (!(depth > 0))
            continue;
        v->wall += p->share[i] * square(depth);
        v->worst_wall = fmax(v->worst_wall, depth);
        p->force[3 * i + 2] += 2 * rho * p->share[i] * depth * sign / p->c->wall_min;
    }
}

void penalty_at(struct penalty *p, const struct penalty_watch *watch, const double *phi,
                const double rho[2], double *gradient, struct penalty_value *v)
{
    const struct pm_samples *q = &p->samples;

    *v = (struct penalty_value){0};
    add_curvature(p, watch, phi, rho[0], gradient, v);
    for (ptrdiff_t i = 0; i < q->n; i++) {
        if (!(watch->flag[i] & (WATCH_END | WATCH_PAIR)))
            continue;
        pm_samples_at(q, i, phi, p->x + 3 * i, NULL, NULL);
        memset(p->force + 3 * i, 0, 3 * sizeof *p->force);
    }
    add_pairs(p, watch, rho[1], v);
    add_ends(p, watch, rho[1], v);
    for (ptrdiff_t i = 0; i < q->n && gradient != NULL; i++)
        for (ptrdiff_t w = q->ptr[i];
             w < q->ptr[i + 1] && watch->flag[i] & (WATCH_END | WATCH_PAIR); w++)
            for (int j = 0; j < 3; j++)
                gradient[3 * q->col[w] + j] += q->c[w] * p->force[3 * i + j];
}

double penalty_safe_part(struct penalty *p, const struct penalty_watch *watch, const double *phi,
                         const double *step)
{
    const struct pm_samples *q = &p->samples;
    double part = 1;

    for (ptrdiff_t i = 0; i < q->n; i++) {
        double r_a[6], d_a[6], full[6];
        struct pm_curvature old, new;
        pm_samples_at(q, i, phi, p->x + 3 * i, r_a, NULL);
        pm_samples_at(q, i, step, p->force + 3 * i, d_a, NULL);
        pm_curvature_at(r_a, NULL, &old);
        for (;; part /= 2) {
            for (int j = 0; j < 6; j++)
                full[j] = r_a[j] + part * d_a[j];
            pm_curvature_at(full, NULL, &new);
            if (part < 1e-6 || new.A * dot(new.n, old.n) > FOLD_SHARE *old.A)
                break;
        }
    }
    for (ptrdiff_t k = 0; k < watch->npair; k++) {
        const ptrdiff_t i = 3 * watch->pair[k].i, j = 3 * watch->pair[k].j;
        double e[3], d[3];
        for (int m = 0; m < 3; m++) {
            e[m] = p->x[i + m] - p->x[j + m];
            d[m] = p->force[i + m] - p->force[j + m];
        }
        const double move = sqrt(dot(d, d)), gap = sqrt(dot(e, e));
        part = move * part > gap / 2 ? gap / (2 * move) : part;
    }
    return part;
}
