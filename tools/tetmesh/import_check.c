#include "tools/tetmesh/import_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/quality.h"

/* Nodes closer than this part of the body's extent are one. */
static const double coincide = 1e-10;

static double extent(const struct pm_mesh *m)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double lo = INFINITY, hi = -INFINITY;
        for (ptrdiff_t a = 0; a < m->nn; a++) {
            lo = fmin(lo, m->x[3 * a + i]);
            hi = fmax(hi, m->x[3 * a + i]);
        }
        sum += (hi - lo) * (hi - lo);
    }
    return sqrt(sum);
}

/* A node by its place along a direction in which the nodes of a regular grid differ. */
struct place {
    double at;
    ptrdiff_t a;
};

static const double along[3] = {1, 0.618033988749895, 0.267949192431123};

static int by_place(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return (p->a > q->a) - (p->a < q->a);
}

static int near(const double *x, const double *y, double limit)
{
    return fabs(x[0] - y[0]) <= limit && fabs(x[1] - y[1]) <= limit && fabs(x[2] - y[2]) <= limit;
}

enum pm_status pm_import_check_nodes(const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct place *p = NULL;
    PM_TRY(PM_NEW(p, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const double *x = m->x + 3 * a;
        p[a] = (struct place){along[0] * x[0] + along[1] * x[1] + along[2] * x[2], a};
        if (!isfinite(p[a].at))
            PM_TRY(pm_fail(err, PM_INPUT, "node %lld is at (%g, %g, %g)", (long long)m->tag[a],
                           x[0], x[1], x[2]));
    }
    const double limit = coincide * extent(m);
    qsort(p, (size_t)m->nn, sizeof *p, by_place);
    for (ptrdiff_t i = 0; i < m->nn; i++)
        for (ptrdiff_t j = i + 1; j < m->nn && p[j].at - p[i].at <= 2 * limit; j++) {
            const double *x = m->x + 3 * p[i].a;
            if (near(x, m->x + 3 * p[j].a, limit))
                PM_TRY(pm_fail(err, PM_INPUT, "nodes %lld and %lld coincide at (%g, %g, %g)",
                               (long long)m->tag[p[i].a], (long long)m->tag[p[j].a], x[0], x[1],
                               x[2]));
        }
done:
    pm_free(p);
    return status;
}

enum pm_status pm_import_check_elements(const struct pm_mesh *m, struct pm_err *err)
{
    static const double at[11][3] = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},      {0, 0, 1},
                                     {.5, 0, 0},  {.5, .5, 0}, {0, .5, 0},     {0, 0, .5},
                                     {0, .5, .5}, {.5, 0, .5}, {.25, .25, .25}};
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        const int32_t *v = m->tet + m->npe * e;
        double X[30], dN[30], low = INFINITY, size = 0;
        pm_quality_gather(m, m->x, e, X);
        for (int q = 0; q < 11 + PM_TET_POINTS; q++)
            low = fmin(low, pm_tet10_gradient(X, q < 11 ? at[q] : pm_tet_xi[q - 11], dN));
        for (int k = 1; k < 4; k++)
            for (int i = 0; i < 3; i++)
                size += (X[3 * k + i] - X[i]) * (X[3 * k + i] - X[i]);
        const double least = 1e-9 * size * sqrt(size);
        if (!(low > least))
            return pm_fail(
                err, PM_INPUT,
                "the tetrahedron of nodes %lld %lld %lld %lld is %s: smallest det dX/dxi = %g mm3",
                (long long)m->tag[v[0]], (long long)m->tag[v[1]], (long long)m->tag[v[2]],
                (long long)m->tag[v[3]], low < -least ? "inverted" : "flat", low);
    }
    return PM_OK;
}

static int32_t root(int32_t *parent, int32_t a)
{
    while (parent[a] != a)
        a = parent[a] = parent[parent[a]];
    return a;
}

/* Faces of the same vertices: two elements on the same side of them overlap. */
static enum pm_status check_sides(const struct pm_mesh *m, const int32_t *vertices,
                                  const struct pm_face *f, ptrdiff_t n, struct pm_err *err)
{
    for (ptrdiff_t i = 0; i < n; i++)
        for (ptrdiff_t j = i + 1; j < n; j++) {
            const int32_t *v = vertices + 4 * (ptrdiff_t)f[i].element,
                          *w = vertices + 4 * (ptrdiff_t)f[j].element;
            const int64_t *tag = m->tag;
            if (f[i].turned == f[j].turned)
                return pm_fail(err, PM_INPUT,
                               "the tetrahedra of nodes %lld %lld %lld %lld and %lld %lld %lld "
                               "%lld overlap",
                               (long long)tag[v[0]], (long long)tag[v[1]], (long long)tag[v[2]],
                               (long long)tag[v[3]], (long long)tag[w[0]], (long long)tag[w[1]],
                               (long long)tag[w[2]], (long long)tag[w[3]]);
        }
    return PM_OK;
}

enum pm_status pm_import_check_parts(const struct pm_mesh *m, const int32_t *vertices,
                                     struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *parent = NULL;
    struct pm_face *f = NULL;
    PM_TRY(PM_NEW(parent, m->ne, err));
    for (ptrdiff_t e = 0; e < m->ne; e++)
        parent[e] = (int32_t)e;
    PM_TRY(pm_sorted_faces(m->ne, vertices, &f, err));
    for (ptrdiff_t k = 0, n; k < 4 * m->ne; k += n) {
        n = pm_same_faces(f, k, 4 * m->ne);
        PM_TRY(check_sides(m, vertices, f + k, n, err));
        if (n == 2)
            parent[root(parent, f[k + 1].element)] = root(parent, f[k].element);
    }
    for (ptrdiff_t e = 1; e < m->ne; e++)
        if (root(parent, (int32_t)e) != root(parent, 0))
            PM_TRY(pm_fail(err, PM_INPUT,
                           "the body is in parts: no faces join the tetrahedra at nodes %lld and "
                           "%lld",
                           (long long)m->tag[vertices[0]], (long long)m->tag[vertices[4 * e]]));
done:
    pm_free(parent);
    pm_free(f);
    return status;
}

enum pm_status pm_import_check_middles(const struct pm_mesh *m, const int32_t *vertices,
                                       struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_edges edges = {0};
    int32_t *middle = NULL;
    if (m->npe == 4)
        return PM_OK;
    PM_TRY(pm_edges_new(m->nn, m->ne, vertices, &edges, err));
    PM_TRY(PM_NEW(middle, edges.n, err));
    memset(middle, 0xff, (size_t)edges.n * sizeof *middle);
    for (ptrdiff_t k = 0; k < 6 * m->ne; k++) {
        const int32_t *v = m->tet + 10 * (k / 6), a = v[4 + k % 6];
        const ptrdiff_t e =
            pm_edges_find(&edges, v[pm_tet10_edge[k % 6][0]], v[pm_tet10_edge[k % 6][1]]);
        if (middle[e] >= 0 && middle[e] != a)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "the edge of nodes %lld and %lld has two middle nodes, %lld and %lld",
                           (long long)m->tag[edges.low[e]], (long long)m->tag[edges.high[e]],
                           (long long)m->tag[middle[e]], (long long)m->tag[a]));
        middle[e] = a;
    }
done:
    pm_edges_release(&edges);
    pm_free(middle);
    return status;
}

/* One side of a boundary face. */
struct side {
    int32_t low, high, tag;
};

static int by_side(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

/* Sides of the faces, those on one edge together. */
static enum pm_status sorted_sides(const struct pm_mesh *m, struct side **out, struct pm_err *err)
{
    struct side *s = NULL;
    *out = NULL;
    if (PM_NEW(s, 3 * m->nf, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t k = 0; k < 3 * m->nf; k++) {
        const int32_t *v = m->tri + m->npf * (k / 3);
        const int32_t a = v[k % 3], b = v[(k + 1) % 3];
        s[k] = (struct side){a < b ? a : b, a < b ? b : a, m->tri_tag[k / 3]};
    }
    qsort(s, (size_t)(3 * m->nf), sizeof *s, by_side);
    *out = s;
    return PM_OK;
}

enum pm_status pm_import_check_closed(const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct side *s = NULL;
    PM_TRY(sorted_sides(m, &s, err));
    for (ptrdiff_t i = 0, j; i < 3 * m->nf; i = j) {
        int symmetry = 0;
        for (j = i; j < 3 * m->nf && s[j].low == s[i].low && s[j].high == s[i].high; j++)
            symmetry |= s[j].tag <= PM_FACE_SYM_X;
        for (ptrdiff_t k = i, n; k < j; k += n) {
            for (n = 1; k + n < j && s[k + n].tag == s[k].tag; n++)
                ;
            const double *p = m->x + 3 * (ptrdiff_t)s[i].low;
            if (s[k].tag > 0 && n % 2 != 0 && !symmetry)
                PM_TRY(pm_fail(err, PM_INPUT,
                               "group 'chamber%d' is not closed at the edge of nodes %lld and %lld "
                               "near (%g, %g, %g)",
                               (int)s[k].tag, (long long)m->tag[s[i].low],
                               (long long)m->tag[s[i].high], p[0], p[1], p[2]));
        }
    }
done:
    pm_free(s);
    return status;
}

enum pm_status pm_import_check_held(const struct pm_mesh *m, struct pm_err *err)
{
    int base = 0, plane[3] = {0};
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        base |= m->tri_tag[f] == PM_FACE_BASE;
        for (int axis = 0; axis < 3; axis++)
            plane[axis] |= m->tri_tag[f] == PM_FACE_SYM_X - axis;
    }
    if (base || (plane[0] && plane[1] && plane[2]))
        return PM_OK;
    return pm_fail(err, PM_INPUT,
                   "nothing holds the body: expected the group 'base', or 'symmetry-x', "
                   "'symmetry-y' and 'symmetry-z'");
}

enum pm_status pm_import_check_planes(const struct pm_mesh *m, struct pm_err *err)
{
    const double limit = 1e-6 * extent(m);
    double plane[3] = {NAN, NAN, NAN};
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int axis = PM_FACE_SYM_X - m->tri_tag[f];
        for (ptrdiff_t k = 0; k < m->npf && axis >= 0 && axis < 3; k++) {
            const int32_t a = m->tri[m->npf * f + k];
            const double x = m->x[3 * (ptrdiff_t)a + axis];
            if (isnan(plane[axis]))
                plane[axis] = x;
            if (fabs(x - plane[axis]) > limit)
                return pm_fail(
                    err, PM_INPUT,
                    "group 'symmetry-%c' is not planar: node %lld has %c = %.9g, expected %.9g",
                    "xyz"[axis], (long long)(m->tag[a]), "xyz"[axis], x, plane[axis]);
        }
    }
    return PM_OK;
}
