#include "common/geometry/check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"
#include "common/geometry/domain.h"

static const double OUTSIDE = 0.01; /* mm */

struct field {
    const struct pm_surfaces *s;
    struct pm_samples m;
    double *phi, *x, *normal; /* (N x 3), (n x 3), (n x 3) */
};

/* Signed distance of p from surface k, by its nearest sample: positive outside. */
static double side(const struct field *f, ptrdiff_t k, const double p[3])
{
    double best = INFINITY, sign = 0;

    for (ptrdiff_t i = f->m.first[k]; i < f->m.first[k + 1]; i++) {
        const double *x = &f->x[3 * i], *n = &f->normal[3 * i];
        double d[3] = {p[0] - x[0], p[1] - x[1], p[2] - x[2]};
        double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if (d2 >= best)
            continue;
        best = d2;
        sign = d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
    }
    return copysign(sqrt(best), sign);
}

__attribute__((format(printf, 2, 3))) static void fault(struct pm_check *c, const char *format, ...)
{
    va_list args;

    if (c->fault[0] != '\0')
        return;
    va_start(args, format);
    vsnprintf(c->fault, sizeof c->fault, format, args);
    va_end(args);
}

/* Some samples of chamber k against the exterior and the other chambers; the wall has the last
 * word: surfaces that cross have none. */
static void containment(const struct field *f, ptrdiff_t k, struct pm_check *c)
{
    double H = f->s->pcase.height;

    for (ptrdiff_t i = f->m.first[k]; i < f->m.first[k + 1]; i += 64) {
        const double *p = &f->x[3 * i];
        if (p[2] <= 0 || p[2] >= H || side(f, 0, p) >= 0)
            fault(c, "chamber %td leaves the body at (%.4g, %.4g, %.4g)", k, p[0], p[1], p[2]);
        for (ptrdiff_t l = 1; l < f->s->ns; l++)
            if (l != k && side(f, l, p) <= 0)
                fault(c, "chambers %td and %td meet at (%.4g, %.4g, %.4g)", k, l, p[0], p[1], p[2]);
    }
}

static enum pm_status walls(const struct field *f, struct pm_check *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_case *pc = &f->s->pcase;
    struct pm_approach *near = NULL;
    ptrdiff_t ns = f->s->ns;

    PM_TRY(PM_NEW(near, ns * ns, err));
    PM_TRY(pm_distance_nearest(f->s, &f->m, 2 * pc->wall_min, near, err));
    c->wall.distance = INFINITY;
    for (ptrdiff_t k = 0; k < ns * ns; k++)
        if (near[k].distance < c->wall.distance)
            c->wall = near[k];
    c->cap = INFINITY;
    for (ptrdiff_t i = f->m.first[1]; i < f->m.n; i++) {
        const double *p = &f->x[3 * i], gap = fmin(p[2], pc->height - p[2]);
        if (gap >= c->cap)
            continue;
        c->cap = gap;
        memcpy(c->cap_x, p, sizeof c->cap_x);
    }
done:
    pm_free(near);
    return status;
}

static void domain(const struct field *f, struct pm_check *c)
{
    double n[3];

    c->outside = -INFINITY;
    for (ptrdiff_t i = 0; i < f->m.first[1]; i++)
        for (int axis = 0; axis < 2; axis++) {
            const double depth = pm_domain_depth(&f->s->pcase, 0, axis, &f->x[3 * i], n);
            if (!(depth > c->outside))
                continue;
            c->outside = depth;
            memcpy(c->outside_x, &f->x[3 * i], sizeof c->outside_x);
        }
}

static enum pm_status maps(const struct field *f, ptrdiff_t k, struct pm_check *c,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    struct pm_curvature g;
    double r_a[6], r_ab[9], Z;

    PM_TRY(pm_map_new(&f->s->s[k], &map, err));
    for (ptrdiff_t i = f->m.first[k]; i < f->m.first[k + 1]; i++) {
        const double *p = &f->x[3 * i];
        Z = INFINITY; /* the tube covers by construction */
        if (f->s->s[k].type == PM_SURFACE_SPHERE)
            PM_TRY(pm_map_coverage(map, &f->m.S[3 * i], &work, &Z, err));
        pm_samples_at(&f->m, i, f->phi, NULL, r_a, r_ab);
        pm_curvature_at(r_a, r_ab, &g);
        c->coverage = fmin(c->coverage, Z);
        if (Z < 1)
            fault(c,
                  "surface %td has a hole in its cover at (%.4g, %.4g, %.4g): sum of kernels %.3g",
                  k, p[0], p[1], p[2], Z);
        if (!isfinite(g.Q))
            fault(c, "surface %td folds at (%.4g, %.4g, %.4g)", k, p[0], p[1], p[2]);
        if (sqrt(g.Q) > c->curvature) {
            c->curvature = sqrt(g.Q);
            memcpy(c->curvature_x, p, sizeof c->curvature_x);
        }
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

/* Parameter at the middle of the circle through the corners of a triangle of control points: where
 * the cover of a sphere map is least. */
static void circumcentre(const struct pm_surface *f, ptrdiff_t t, double S[3])
{
    const double *a = &f->Phi[3 * (ptrdiff_t)f->tri[3 * t]];
    const double *b = &f->Phi[3 * (ptrdiff_t)f->tri[3 * t + 1]];
    const double *c = &f->Phi[3 * (ptrdiff_t)f->tri[3 * t + 2]];
    double u[3], v[3], len;

    for (int j = 0; j < 3; j++) {
        u[j] = b[j] - a[j];
        v[j] = c[j] - a[j];
    }
    for (int j = 0; j < 3; j++)
        S[j] = u[(j + 1) % 3] * v[(j + 2) % 3] - u[(j + 2) % 3] * v[(j + 1) % 3];
    len = sqrt(S[0] * S[0] + S[1] * S[1] + S[2] * S[2]);
    for (int j = 0; j < 3; j++)
        S[j] = len > 0 ? S[j] / len : a[j];
}

static enum pm_status cover(const struct field *f, ptrdiff_t k, struct pm_check *c,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *s = &f->s->s[k];
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double S[3], Z;

    PM_TRY(pm_map_new(s, &map, err));
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        const double *p = &s->phi[3 * (ptrdiff_t)s->tri[3 * t]];
        circumcentre(s, t, S);
        PM_TRY(pm_map_coverage(map, S, &work, &Z, err));
        c->coverage = fmin(c->coverage, Z);
        if (Z < 1)
            fault(
                c,
                "surface %td has a hole in its cover near (%.4g, %.4g, %.4g): sum of kernels %.3g",
                k, p[0], p[1], p[2], Z);
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status pm_surfaces_measure(const struct pm_surfaces *s, struct pm_check *check,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct field f = {.s = s};

    *check = (struct pm_check){.coverage = INFINITY};
    PM_TRY(pm_samples_with_nodes(s, s->pcase.wall_min / 2, 1, &f.m, err));
    PM_TRY(PM_NEW(f.phi, 3 * s->offset[s->ns], err));
    PM_TRY(PM_NEW(f.x, 3 * f.m.n, err));
    PM_TRY(PM_NEW(f.normal, 3 * f.m.n, err));
    pm_surfaces_gather(s, f.phi);
    pm_samples_all(&f.m, f.phi, f.x, f.normal);
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(maps(&f, k, check, err));
    for (ptrdiff_t k = 1; k < s->ns; k++)
        PM_TRY(cover(&f, k, check, err));
    for (ptrdiff_t k = 1; k < s->ns; k++)
        containment(&f, k, check);
    domain(&f, check);
    PM_TRY(walls(&f, check, err));
done:
    pm_samples_release(&f.m);
    pm_free(f.phi);
    pm_free(f.x);
    pm_free(f.normal);
    return status;
}

enum pm_status pm_surfaces_check(const struct pm_surfaces *s, struct pm_check *check,
                                 struct pm_err *err)
{
    enum pm_status status = pm_surfaces_measure(s, check, err);
    const struct pm_approach *w = &check->wall;

    if (status != PM_OK)
        return status;
    if (check->fault[0] != '\0')
        return pm_fail(err, PM_INPUT, "%s", check->fault);
    if (w->distance < s->pcase.wall_min)
        return pm_fail(
            err, PM_INPUT,
            "wall between surfaces %d and %d is %.4g at (%.4g, %.4g, %.4g), expected >= %g", w->a,
            w->b, w->distance, w->x[0], w->x[1], w->x[2], s->pcase.wall_min);
    if (check->cap < s->pcase.cap_min)
        return pm_fail(err, PM_INPUT,
                       "chamber within %.4g of an end plane at (%.4g, %.4g, %.4g), expected >= %g",
                       check->cap, check->cap_x[0], check->cap_x[1], check->cap_x[2],
                       s->pcase.cap_min);
    if (check->outside > OUTSIDE)
        return pm_fail(
            err, PM_INPUT,
            "body leaves the design domain by %.4g at (%.4g, %.4g, %.4g), expected inside",
            check->outside, check->outside_x[0], check->outside_x[1], check->outside_x[2]);
    return PM_OK;
}
