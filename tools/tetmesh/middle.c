#include "tools/tetmesh/middle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/geometry/remesh.h"

enum pm_status pm_middles_init(struct pm_middles *m, const struct pm_surfaces *s, unsigned planes,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    *m = (struct pm_middles){.s = s, .planes = planes};
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(pm_map_new(&s->s[k], &m->map[k], err));
done:
    if (status != PM_OK)
        pm_middles_release(m);
    return status;
}

void pm_middles_release(struct pm_middles *m)
{
    for (ptrdiff_t k = 0; k <= PM_MAX_CHAMBERS; k++)
        pm_map_free(m->map[k]);
    pm_basis_release(&m->basis);
    *m = (struct pm_middles){0};
}

/* Rims (remesh.h) of an edge. */
static unsigned rims_of(const struct pm_middles *m, int32_t type, const struct pm_edge_ends *e)
{
    const double *Sa = e->S[0], *Sb = e->S[1];
    unsigned rim = 0;
    if (type == PM_SURFACE_BSPLINE && Sa[2] == Sb[2])
        rim = Sa[2] == 0 ? 1 : Sa[2] == 1 ? 2 : 0;
    for (int j = 0; j < 2; j++)
        if (m->planes >> j & 1 && e->x[0][j] == 0 && e->x[1][j] == 0)
            rim |= pm_rim_plane(type, j);
    return rim;
}

/* Newton for r_a . (r - p) = 0; on a rim v stays, on a mirror plane the steps are in it by symmetry
 * but for rounding. */
enum pm_status pm_middle_foot(struct pm_middles *m, ptrdiff_t k, unsigned rims, const double p[3],
                              double chord, double S[3], struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *s = &m->s->s[k];
    const int rim = s->type == PM_SURFACE_BSPLINE && (rims & 3) != 0;
    pm_rim_constrain(s->type, rims, S);
    for (int it = 0; it < 20; it++) {
        double r[3], r_a[6], r_ab[9], f[2] = {0}, g[3] = {0}, h[3], d[2];
        PM_TRY(pm_map_point(m->map[k], s->phi, S, &m->basis, r, r_a, r_ab, err));
        for (int i = 0; i < 3; i++) {
            f[0] -= r_a[i] * (r[i] - p[i]);
            f[1] -= r_a[3 + i] * (r[i] - p[i]);
            g[0] += r_a[i] * r_a[i];
            g[1] += r_a[i] * r_a[3 + i];
            g[2] += r_a[3 + i] * r_a[3 + i];
        }
        for (int j = 0; j < 3; j++) {
            h[j] = g[j];
            for (int i = 0; i < 3; i++)
                h[j] += r_ab[3 * j + i] * (r[i] - p[i]);
        }
        /* Gauss-Newton where the Hessian is not positive */
        if (!(h[0] > 0.1 * g[0]) ||
            !(h[0] * h[2] - h[1] * h[1] > 0.1 * (g[0] * g[2] - g[1] * g[1])))
            memcpy(h, g, sizeof h);
        const double det = h[0] * h[2] - h[1] * h[1];
        d[0] = rim ? f[0] / h[0] : (h[2] * f[0] - h[1] * f[1]) / det;
        d[1] = rim ? 0 : (h[0] * f[1] - h[1] * f[0]) / det;
        const double step =
            sqrt(fmax(g[0] * d[0] * d[0] + 2 * g[1] * d[0] * d[1] + g[2] * d[1] * d[1], 0));
        const double cut = fmin(1, 0.25 * chord / step);
        if (!(step > 1e-12 * chord))
            break;
        d[0] *= cut;
        d[1] *= cut;
        double next[3];
        pm_map_move(s->type, S, d, next);
        memcpy(S, next, sizeof next);
        pm_rim_constrain(s->type, rims, S);
    }
done:
    return status;
}

enum pm_status pm_middle_find(struct pm_middles *m, ptrdiff_t k, const struct pm_edge_ends *e,
                              double S[3], double x[3], struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *s = &m->s->s[k];
    const unsigned rims = rims_of(m, s->type, e);
    double mid[3], chord = 0;
    for (int i = 0; i < 3; i++) {
        mid[i] = (e->x[0][i] + e->x[1][i]) / 2;
        chord += (e->x[0][i] - e->x[1][i]) * (e->x[0][i] - e->x[1][i]);
    }
    pm_map_middle(s->type, e->S[0], e->S[1], S);
    PM_TRY(pm_middle_foot(m, k, rims, mid, sqrt(chord), S, err));
    PM_TRY(pm_map_point(m->map[k], s->phi, S, &m->basis, x, NULL, NULL, err));
    for (int j = 0; j < 2; j++)
        if (rims & pm_rim_plane(s->type, j))
            x[j] = 0;
done:
    return status;
}

/* ---- the bent shell ---- */

struct edge {
    int32_t low, high, owner; /* owner: surface, -1 inside a planar face */
    int32_t triangle, side;
};

static int by_ends(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    if (p->owner != q->owner)
        return p->owner > q->owner ? -1 : 1; /* the surface of a rim first */
    const ptrdiff_t i = 3 * (ptrdiff_t)p->triangle + p->side,
                    j = 3 * (ptrdiff_t)q->triangle + q->side;
    return (i > j) - (i < j);
}

static enum pm_status add_middle(struct pm_middles *m, const struct edge *e, struct pm_shell *bent,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t a = e->low, b = e->high, n = bent->nn++;
    bent->surface[n] = e->owner;
    bent->size[n] = (bent->size[a] + bent->size[b]) / 2;
    for (int i = 0; i < 3; i++) {
        bent->x[3 * n + i] = (bent->x[3 * a + i] + bent->x[3 * b + i]) / 2;
        bent->S[3 * n + i] = 0;
    }
    const struct pm_edge_ends ends = {{bent->x + 3 * a, bent->x + 3 * b},
                                      {bent->S + 3 * a, bent->S + 3 * b}};
    if (e->owner >= 0)
        PM_TRY(pm_middle_find(m, e->owner, &ends, bent->S + 3 * n, bent->x + 3 * n, err));
done:
    return status;
}

/* Middles of the sides of all triangles: (nt x 3). */
static enum pm_status add_middles(struct pm_middles *m, const struct pm_shell *shell,
                                  struct pm_shell *bent, int32_t *middle, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct edge *e = NULL;
    PM_TRY(PM_NEW(e, 3 * shell->nt, err));
    for (ptrdiff_t i = 0; i < 3 * shell->nt; i++) {
        const ptrdiff_t t = i / 3, k = i % 3;
        const int32_t a = shell->tri[i], b = shell->tri[3 * t + (k + 1) % 3];
        const int32_t owner = shell->tag[t] >= 0 ? shell->tag[t] : -1;
        e[i] = (struct edge){a < b ? a : b, a < b ? b : a, owner, (int32_t)t, (int32_t)k};
    }
    qsort(e, (size_t)(3 * shell->nt), sizeof *e, by_ends);
    for (ptrdiff_t i = 0; i < 3 * shell->nt; i++) {
        if (i == 0 || e[i].low != e[i - 1].low || e[i].high != e[i - 1].high)
            PM_TRY(add_middle(m, &e[i], bent, err));
        middle[3 * (ptrdiff_t)e[i].triangle + e[i].side] = (int32_t)(bent->nn - 1);
    }
done:
    pm_free(e);
    return status;
}

enum pm_status pm_shell_bend(struct pm_middles *m, const struct pm_shell *shell,
                             struct pm_shell *bent, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *middle = NULL;
    const ptrdiff_t nn = shell->nn, nt = shell->nt;
    *bent = (struct pm_shell){.planes = shell->planes};
    PM_TRY(PM_NEW(middle, 3 * nt, err));
    PM_TRY(pm_shell_grow(bent, nn + 3 * nt, 4 * nt, err));
    memcpy(bent->x, shell->x, (size_t)(3 * nn) * sizeof *bent->x);
    memcpy(bent->S, shell->S, (size_t)(3 * nn) * sizeof *bent->S);
    memcpy(bent->size, shell->size, (size_t)nn * sizeof *bent->size);
    memcpy(bent->surface, shell->surface, (size_t)nn * sizeof *bent->surface);
    bent->nn = nn;
    PM_TRY(add_middles(m, shell, bent, middle, err));
    bent->nt = 4 * nt;
    for (ptrdiff_t t = 0; t < nt; t++) {
        const int32_t *v = shell->tri + 3 * t, *w = middle + 3 * t;
        const int32_t part[12] = {v[0], w[0], w[2], w[0], v[1], w[1],
                                  w[2], w[1], v[2], w[0], w[1], w[2]};
        memcpy(bent->tri + 12 * t, part, sizeof part);
        for (int k = 0; k < 4; k++)
            bent->tag[4 * t + k] = shell->tag[t];
    }
done:
    pm_free(middle);
    if (status != PM_OK)
        pm_shell_release(bent);
    return status;
}
