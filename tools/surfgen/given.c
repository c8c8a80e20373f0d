#include "tools/surfgen/given.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/distance.h"
#include "common/geometry/fit.h"
#include "common/geometry/parametrise.h"
#include "common/geometry/parametrise_parts.h"
#include "common/geometry/remesh.h"
#include "tools/surfgen/body.h"

enum {
    ITERATIONS = 20, /* of the fit: the given surface is wanted itself */
    DEGREE_MAX = 16, /* triangles around a node where the remesher starts */
    PASSES = 1000    /* nodes with more that are thinned; the remesher refuses what is left */
};

/* The given surface with parameters, and points on it: its nodes and the middles of its triangles.
 */
struct given {
    struct pm_trimesh m;
    double *S; /* (nn x 3) */
    ptrdiff_t nq;
    double *x, *T, *weight; /* points (nq x 3) [mm], parameters (nq x 3), areas (nq) [mm2] */
};

static void release(struct given *g)
{
    pm_trimesh_release(&g->m);
    pm_free(g->S);
    pm_free(g->x);
    pm_free(g->T);
    pm_free(g->weight);
}

/* Parameter in the middle of triangle t. */
static void middle(const struct given *g, int32_t type, ptrdiff_t t, double T[3])
{
    double length = 0;

    for (int j = 0; j < 3; j++) {
        T[j] = 0;
        for (int k = 0; k < 3; k++)
            T[j] += g->S[3 * (ptrdiff_t)g->m.tri[3 * t + k] + j] / 3;
    }
    for (int j = 0; j < (type == PM_SURFACE_SPHERE ? 3 : 2); j++)
        length += T[j] * T[j];
    for (int j = 0; j < (type == PM_SURFACE_SPHERE ? 3 : 2); j++)
        T[j] /= sqrt(length);
}

static enum pm_status sample(struct given *g, int32_t type, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t nn = g->m.nn;

    g->nq = nn + g->m.nt;
    PM_TRY(PM_NEW(g->x, 3 * g->nq, err));
    PM_TRY(PM_NEW(g->T, 3 * g->nq, err));
    PM_TRY(PM_NEW(g->weight, g->nq, err));
    memcpy(g->x, g->m.x, 3 * (size_t)nn * sizeof *g->x);
    memcpy(g->T, g->S, 3 * (size_t)nn * sizeof *g->T);
    for (ptrdiff_t t = 0; t < g->m.nt; t++) {
        double n[3], area;
        pm_triangle_area(&g->m, t, n);
        area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        middle(g, type, t, &g->T[3 * (nn + t)]);
        g->weight[nn + t] = area / 2;
        for (int k = 0; k < 3; k++) {
            ptrdiff_t a = g->m.tri[3 * t + k];
            g->weight[a] += area / 6;
            for (int j = 0; j < 3; j++)
                g->x[3 * (nn + t) + j] += g->m.x[3 * a + j] / 3;
        }
    }
done:
    return status;
}

static enum pm_status fit(const struct given *g, struct pm_surface *s, double alpha,
                          const uint8_t *fixed, struct pm_misfit *misfit, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double error[2], total = 0;
    const struct pm_fit job = {.nq = g->nq,
                               .S = g->T,
                               .weight = g->weight,
                               .target = g->x,
                               .alpha = alpha,
                               .iterations = ITERATIONS,
                               .fixed = fixed};

    *misfit = (struct pm_misfit){.max = -1};
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(pm_fit_points(map, s->n, &job, s->phi, error, err));
    for (ptrdiff_t q = 0; q < g->nq; q++) {
        double S[3], r[3], d;
        memcpy(S, &g->T[3 * q], sizeof S);
        PM_TRY(pm_distance_project(map, s->type, s->phi, &g->x[3 * q], &work, S, r, &d, err));
        total += g->weight[q];
        misfit->mean += g->weight[q] * d;
        if (d <= misfit->max)
            continue;
        misfit->max = d;
        memcpy(misfit->at, &g->x[3 * q], sizeof misfit->at);
    }
    misfit->mean /= total;
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

static int is_edge(const struct pm_trimesh *m, int32_t a, int32_t b)
{
    for (ptrdiff_t k = 0; k < 3 * m->nt; k++)
        if (m->tri[k] == a &&
            (m->tri[k / 3 * 3 + (k + 1) % 3] == b || m->tri[k / 3 * 3 + (k + 2) % 3] == b))
            return 1;
    return 0;
}

/* Every other edge of node v flipped where its triangles on the sphere allow; fan (degree): its
 * triangles, in order. Returns how many. */
static ptrdiff_t thin_fan(struct pm_trimesh *m, const double *S, int32_t v, ptrdiff_t degree,
                          const ptrdiff_t *fan, const int32_t *ring)
{
    ptrdiff_t flips = 0;

    for (ptrdiff_t k = 1; k < degree; k += 2) {
        const int32_t p = ring[k - 1], a = ring[k], q = ring[(k + 1) % degree];
        const int32_t first[3] = {v, p, q}, second[3] = {p, a, q};
        if (degree - flips <= DEGREE_MAX / 2 || is_edge(m, p, q) ||
            !(pm_parameter_orientation(PM_SURFACE_SPHERE, &S[3 * (ptrdiff_t)v],
                                       &S[3 * (ptrdiff_t)p], &S[3 * (ptrdiff_t)q]) > 0) ||
            !(pm_parameter_orientation(PM_SURFACE_SPHERE, &S[3 * (ptrdiff_t)p],
                                       &S[3 * (ptrdiff_t)a], &S[3 * (ptrdiff_t)q]) > 0))
            continue;
        memcpy(&m->tri[3 * fan[k - 1]], first, sizeof first);
        memcpy(&m->tri[3 * fan[k]], second, sizeof second);
        flips++;
    }
    return flips;
}

/* The remesher takes no fans of many triangles, files from CAD have them. */
static enum pm_status thin_fans(struct pm_trimesh *m, const double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_star star = {0};
    ptrdiff_t *fan = NULL, flips = 1;
    int32_t *ring = NULL;

    PM_TRY(PM_NEW(fan, m->nt, err));
    PM_TRY(PM_NEW(ring, m->nt, err));
    for (int pass = 0; pass < PASSES && flips > 0; pass++) {
        flips = 0;
        pm_star_release(&star);
        PM_TRY(pm_star_new(m, &star, err));
        for (int32_t v = 0; v < m->nn && flips == 0; v++) {
            const ptrdiff_t degree = star.ptr[v + 1] - star.ptr[v];
            if (degree <= DEGREE_MAX)
                continue;
            ring[0] = star.next[star.ptr[v]];
            for (ptrdiff_t k = 1; k < degree; k++)
                ring[k] = pm_star_after(&star, v, ring[k - 1]);
            for (ptrdiff_t t = 0; t < m->nt; t++)
                for (int j = 0; j < 3; j++)
                    for (ptrdiff_t k = 0; m->tri[3 * t + j] == v && k < degree; k++)
                        if (ring[k] == m->tri[3 * t + (j + 1) % 3])
                            fan[k] = t;
            flips = thin_fan(m, S, v, degree, fan, ring);
        }
    }
done:
    pm_star_release(&star);
    pm_free(fan);
    pm_free(ring);
    return status;
}

/* Control points at `spacing` on the given surface: remeshed over the map that has all its nodes as
 * control points. */
static enum pm_status spread(const struct given *g, double spacing, struct pm_surface *s,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surface dense = {.type = PM_SURFACE_SPHERE, .n = g->m.nn, .nt = g->m.nt};
    struct pm_patch p = {0};
    struct pm_remesh_opts o = {
        .size = spacing, .size_min = spacing, .crest = 1, .growth = 1, .sweeps = 12};
    struct pm_trimesh begin = {.nn = g->m.nn, .nt = g->m.nt};

    PM_TRY(PM_NEW(begin.tri, 3 * begin.nt, err));
    memcpy(begin.tri, g->m.tri, 3 * (size_t)begin.nt * sizeof *begin.tri);
    PM_TRY(thin_fans(&begin, g->S, err));
    dense.phi = g->m.x;
    dense.Phi = g->S;
    dense.tri = begin.tri;
    PM_TRY(PM_NEW(dense.d0, dense.n, err));
    PM_TRY(pm_map_support(dense.n, dense.Phi, PM_MAP_NEIGHBOURS, dense.d0, err));
    PM_TRY(pm_remesh(&dense, 0, &o, &p, err));
    PM_TRY(pm_surface_new(PM_SURFACE_SPHERE, p.nn, p.nt, s, err));
    memcpy(s->phi, p.x, 3 * (size_t)s->n * sizeof *s->phi);
    memcpy(s->Phi, p.S, 3 * (size_t)s->n * sizeof *s->Phi);
    memcpy(s->tri, p.tri, 3 * (size_t)s->nt * sizeof *s->tri);
    PM_TRY(pm_map_support(s->n, s->Phi, PM_MAP_NEIGHBOURS, s->d0, err));
done:
    pm_patch_release(&p);
    pm_free(begin.tri);
    pm_free(dense.d0);
    return status;
}

enum pm_status pm_given_chamber(const struct pm_trimesh *m, double spacing, const int *mirror,
                                struct pm_surface *s, struct pm_misfit *misfit, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct given g = {0};

    PM_TRY(pm_trimesh_refine(m, spacing / 2, &g.m, err));
    PM_TRY(PM_NEW(g.S, 3 * g.m.nn, err));
    PM_TRY(pm_parametrise_sphere(&g.m, mirror, g.S, err));
    PM_TRY(spread(&g, spacing, s, err));
    PM_TRY(sample(&g, PM_SURFACE_SPHERE, err));
    PM_TRY(fit(&g, s, 0.1, NULL, misfit, err));
done:
    release(&g);
    return status;
}

/* All of the mesh but the triangles in the planes of both ends. */
static enum pm_status side_wall(const struct pm_trimesh *m, double height, struct pm_trimesh *side,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double slack = 1e-6 * height;
    double low[3], high[3];
    int32_t *id = NULL;

    pm_trimesh_box(m, low, high);
    if (fabs(low[2]) > slack || fabs(high[2] - height) > slack)
        return pm_fail(err, PM_INPUT, "body reaches from z = %.6g to %.6g, expected 0 to %g",
                       low[2], high[2], height);
    PM_TRY(PM_NEW(side->x, 3 * m->nn, err));
    PM_TRY(PM_NEW(side->tri, 3 * m->nt, err));
    PM_TRY(PM_NEW(id, m->nn, err));
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = &m->tri[3 * t];
        int base = 1, tip = 1;
        for (int k = 0; k < 3; k++) {
            base &= m->x[3 * (ptrdiff_t)v[k] + 2] < slack;
            tip &= m->x[3 * (ptrdiff_t)v[k] + 2] > height - slack;
        }
        if (base || tip)
            continue;
        for (int k = 0; k < 3; k++) {
            if (id[v[k]] == 0) { /* number + 1 */
                memcpy(&side->x[3 * side->nn], &m->x[3 * (ptrdiff_t)v[k]], 3 * sizeof *side->x);
                id[v[k]] = (int32_t)++side->nn;
            }
            side->tri[3 * side->nt + k] = id[v[k]] - 1;
        }
        side->nt++;
    }
done:
    pm_free(id);
    return status;
}

/* Control points start at the nodes of the given surface with the nearest parameters; the rims lie
 * in their planes. */
static void start(const struct given *g, double height, struct pm_surface *s, uint8_t *fixed)
{
    for (ptrdiff_t i = 0; i < s->n; i++) {
        const double *P = &s->Phi[3 * i];
        double best = HUGE_VAL;
        for (ptrdiff_t a = 0; a < g->m.nn; a++) {
            const double *S = &g->S[3 * a];
            double d = pow(S[0] - P[0], 2) + pow(S[1] - P[1], 2) + pow(6 * (S[2] - P[2]), 2);
            if (d >= best)
                continue;
            best = d;
            memcpy(&s->phi[3 * i], &g->m.x[3 * a], 3 * sizeof *s->phi);
        }
        const int base = i < s->nu, tip = i >= s->n - s->nu;
        if (base || tip)
            s->phi[3 * i + 2] = tip ? height : 0;
        fixed[3 * i + 2] = base || tip;
    }
}

enum pm_status pm_given_body(const struct pm_trimesh *m, const struct pm_case *c,
                             struct pm_surface *s, struct pm_misfit *misfit, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct given g = {0};
    struct pm_trimesh side = {0};
    uint8_t *fixed = NULL;
    double low[3], high[3];

    PM_TRY(side_wall(m, c->height, &side, err));
    pm_trimesh_box(&side, low, high);
    const double round = 3.14 * fmax(high[0] - low[0], high[1] - low[1]);
    PM_TRY(pm_trimesh_refine(
        &side, fmin(round / (double)c->around, c->height / (double)c->rows) / 2, &g.m, err));
    PM_TRY(PM_NEW(g.S, 3 * g.m.nn, err));
    PM_TRY(pm_parametrise_tube(&g.m, NULL, g.S, err));
    PM_TRY(pm_body_grid(c, s, err));
    PM_TRY(PM_NEW(fixed, 3 * s->n, err));
    start(&g, c->height, s, fixed);
    PM_TRY(sample(&g, PM_SURFACE_BSPLINE, err));
    PM_TRY(fit(&g, s, 1e-3, fixed, misfit, err));
done:
    pm_trimesh_release(&side);
    pm_free(fixed);
    release(&g);
    return status;
}
