#include "common/geometry/distance.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Newton step to the foot of d = p - r with the Hessian g_ab - d.r_ab where that is positive
 * definite, else with g; at most 2 mm long, which keeps it inside a few control points. */
static double foot_step(const double d[3], const double r_a[6], const double r_ab[9], double y[2])
{
    double g[3] = {dot(r_a, r_a), dot(r_a, r_a + 3), dot(r_a + 3, r_a + 3)}, h[3], det, len;
    double f[2] = {dot(r_a, d), dot(r_a + 3, d)};

    for (int k = 0; k < 3; k++)
        h[k] = g[k] - dot(d, &r_ab[3 * k]);
    if (!(h[0] > 0.1 * g[0] && h[0] * h[2] - h[1] * h[1] > 0.01 * (g[0] * g[2] - g[1] * g[1])))
        memcpy(h, g, sizeof h);
    det = h[0] * h[2] - h[1] * h[1];
    y[0] = (h[2] * f[0] - h[1] * f[1]) / det;
    y[1] = (h[0] * f[1] - h[1] * f[0]) / det;
    len = sqrt(fmax(0, g[0] * y[0] * y[0] + 2 * g[1] * y[0] * y[1] + g[2] * y[1] * y[1]));
    if (len > 2) {
        y[0] *= 2 / len;
        y[1] *= 2 / len;
    }
    return len;
}

enum pm_status pm_distance_project(const struct pm_map *map, int32_t type, const double *phi,
                                   const double p[3], struct pm_basis *work, double S[3],
                                   double r[3], double *distance, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double r_a[6], r_ab[9], d[3], y[2], trial[3], x[3], x_a[6], x_ab[9], len;

    PM_TRY(pm_map_point(map, phi, S, work, r, r_a, r_ab, err));
    *distance = hypot(hypot(p[0] - r[0], p[1] - r[1]), p[2] - r[2]);
    for (int it = 0; it < 30; it++) {
        double best = *distance;
        for (int j = 0; j < 3; j++)
            d[j] = p[j] - r[j];
        len = foot_step(d, r_a, r_ab, y);
        for (int cut = 0; cut < 8 && len > 1e-6; cut++, y[0] /= 2, y[1] /= 2, len /= 2) {
            pm_map_move(type, S, y, trial);
            PM_TRY(pm_map_point(map, phi, trial, work, x, x_a, x_ab, err));
            *distance = hypot(hypot(p[0] - x[0], p[1] - x[1]), p[2] - x[2]);
            if (*distance < best)
                break;
        }
        if (!(*distance < best)) {
            *distance = best;
            break;
        }
        memcpy(S, trial, sizeof trial);
        memcpy(r, x, sizeof x);
        memcpy(r_a, x_a, sizeof x_a);
        memcpy(r_ab, x_ab, sizeof x_ab);
    }
done:
    return status;
}

/* Alternating projections from a pair of samples. */
static enum pm_status refine(const struct pm_surfaces *s, const struct pm_samples *m,
                             struct pm_map *const *map, struct pm_pair pair, struct pm_approach *a,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *f = &s->s[a->a], *g = &s->s[a->b];
    struct pm_basis work = {0};
    double S[3], R[3], before;

    memcpy(S, &m->S[3 * (ptrdiff_t)pair.i], sizeof S);
    memcpy(R, &m->S[3 * (ptrdiff_t)pair.j], sizeof R);
    PM_TRY(pm_map_point(map[a->a], f->phi, S, &work, a->x, NULL, NULL, err));
    a->distance = pair.distance;
    for (int it = 0; it < 50; it++) {
        before = a->distance;
        PM_TRY(pm_distance_project(map[a->b], g->type, g->phi, a->x, &work, R, a->y, &a->distance,
                                   err));
        PM_TRY(pm_distance_project(map[a->a], f->type, f->phi, a->y, &work, S, a->x, &a->distance,
                                   err));
        if (before - a->distance < 1e-6 && it > 0)
            break;
    }
done:
    pm_basis_release(&work);
    return status;
}

enum pm_status pm_distance_nearest(const struct pm_surfaces *s, const struct pm_samples *samples,
                                   double cutoff, struct pm_approach *near, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map[PM_MAX_CHAMBERS + 1] = {0};
    struct pm_pair *best = NULL;
    double *phi = NULL, *x = NULL;
    const ptrdiff_t ns = s->ns;

    PM_TRY(PM_NEW(best, ns * ns, err));
    PM_TRY(PM_NEW(phi, 3 * s->offset[ns], err));
    PM_TRY(PM_NEW(x, 3 * samples->n, err));
    pm_surfaces_gather(s, phi);
    pm_samples_all(samples, phi, x, NULL);
    PM_TRY(pm_samples_closest(samples, ns, x, cutoff, best, err));
    for (ptrdiff_t k = 0; k < ns; k++)
        PM_TRY(pm_map_new(&s->s[k], &map[k], err));
    for (ptrdiff_t k = 0; k < ns * ns; k++) {
        near[k] = (struct pm_approach){
            .a = (int32_t)(k / ns), .b = (int32_t)(k % ns), .distance = INFINITY};
        if (best[k].i >= 0)
            PM_TRY(refine(s, samples, map, best[k], &near[k], err));
    }
done:
    for (ptrdiff_t k = 0; k < ns; k++)
        pm_map_free(map[k]);
    pm_free(best);
    pm_free(phi);
    pm_free(x);
    return status;
}

double pm_samples_area(const struct pm_samples *samples, const double *phi, ptrdiff_t k)
{
    struct pm_curvature c;
    double sum = 0, r_a[6];

    for (ptrdiff_t i = samples->first[k]; i < samples->first[k + 1]; i++) {
        pm_samples_at(samples, i, phi, NULL, r_a, NULL);
        pm_curvature_at(r_a, NULL, &c);
        sum += samples->w[i] * c.A;
    }
    return sum;
}

/* The field (x, y, 0)/2 has divergence 1 and no flux through planes of constant z. */
double pm_samples_volume(const struct pm_samples *samples, const double *phi, ptrdiff_t k)
{
    struct pm_curvature c;
    double sum = 0, r[3], r_a[6];

    for (ptrdiff_t i = samples->first[k]; i < samples->first[k + 1]; i++) {
        pm_samples_at(samples, i, phi, r, r_a, NULL);
        pm_curvature_at(r_a, NULL, &c);
        sum += samples->w[i] * c.A * (r[0] * c.n[0] + r[1] * c.n[1]) / 2;
    }
    return sum;
}
