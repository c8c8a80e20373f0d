#include "common/geometry/annulus.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/base/sparse.h"
#include "common/geometry/parametrise_parts.h"

static const double TWO_PI = 6.283185307179586476925;
/* Least weight of an edge: obtuse triangles would make the sum of the cotangents negative. */
static const double WEIGHT_MIN = 0.05;
/* Theta rises along a rim by at least this part of what the length of the edge says. */
static const double RISE_MIN = 0.05;

/* Undirected edges both ways, by node. */
struct graph {
    ptrdiff_t n;
    ptrdiff_t *ptr; /* (n + 1) */
    ptrdiff_t *to;  /* ascending for every node */
    double *w;
    int8_t *jump; /* the edge i -> j runs across the cut: theta_j - theta_i - 2 pi jump is small */
};

static void graph_release(struct graph *g)
{
    pm_free(g->ptr);
    pm_free(g->to);
    pm_free(g->w);
    pm_free(g->jump);
}

static ptrdiff_t find(const struct graph *g, ptrdiff_t i, ptrdiff_t j)
{
    ptrdiff_t lo = g->ptr[i], hi = g->ptr[i + 1];

    while (hi - lo > 1) {
        ptrdiff_t mid = (lo + hi) / 2;
        *(g->to[mid] <= j ? &lo : &hi) = mid;
    }
    return lo;
}

static int outside(const struct pm_annulus *a, const int32_t *v)
{
    return a->out != NULL && (a->out[v[0]] || a->out[v[1]] || a->out[v[2]]);
}

static int compare(const void *p, const void *q)
{
    const ptrdiff_t *a = p, *b = q;

    return (*a > *b) - (*a < *b);
}

/* Neighbours of all nodes: every edge is met once or twice in each direction. */
static enum pm_status connect(struct graph *g, const struct pm_annulus *a, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_trimesh *m = a->mesh;
    ptrdiff_t n = 0;

    g->n = m->nn;
    PM_TRY(PM_NEW(g->ptr, m->nn + 1, err));
    PM_TRY(PM_NEW(g->to, 6 * m->nt, err));
    for (ptrdiff_t i = 0; i < m->nn; i++) {
        ptrdiff_t from = n;
        g->ptr[i] = n;
        for (ptrdiff_t k = a->star->ptr[i]; k < a->star->ptr[i + 1]; k++) {
            const int32_t v[3] = {(int32_t)i, a->star->next[k], a->star->after[k]};
            if (outside(a, v))
                continue;
            g->to[n++] = v[1];
            g->to[n++] = v[2];
        }
        qsort(&g->to[from], (size_t)(n - from), sizeof *g->to, compare);
        ptrdiff_t last = from;
        for (ptrdiff_t k = from; k < n; k++)
            if (last == from || g->to[last - 1] != g->to[k])
                g->to[last++] = g->to[k];
        n = last;
    }
    g->ptr[m->nn] = n;
    PM_TRY(PM_NEW(g->w, n, err));
    PM_TRY(PM_NEW(g->jump, n, err));
done:
    return status;
}

/* Cotangent of the angle at c of the triangle a b c. */
static double cotangent(const double *a, const double *b, const double *c)
{
    double u[3], v[3], dot = 0, n[3];

    for (int j = 0; j < 3; j++) {
        u[j] = a[j] - c[j];
        v[j] = b[j] - c[j];
        dot += u[j] * v[j];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    const double cross = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return cross > 0 ? dot / cross : 0;
}

static void weigh(struct graph *g, const struct pm_annulus *a)
{
    const struct pm_trimesh *m = a->mesh;

    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = &m->tri[3 * t];
        for (int k = 0; k < 3 && !outside(a, v); k++) {
            ptrdiff_t i = v[k], j = v[(k + 1) % 3], l = v[(k + 2) % 3];
            double w = cotangent(&m->x[3 * i], &m->x[3 * j], &m->x[3 * l]) / 2;
            g->w[find(g, i, j)] += w;
            g->w[find(g, j, i)] += w;
        }
    }
    for (ptrdiff_t e = 0; e < g->ptr[g->n]; e++) /* slivers may have any cotangent */
        g->w[e] = fmin(fmax(g->w[e], WEIGHT_MIN), 1 / WEIGHT_MIN);
}

/* A shortest path from rim 0 to rim 1: came[i] is the node before i on it, going[i] the one after;
 * -1 elsewhere and at its ends. */
static enum pm_status cut(const struct graph *g, const struct pm_annulus *a, int32_t *came,
                          int32_t *going, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *queue = NULL, *before = NULL, end = -1;
    uint8_t *high = NULL;
    ptrdiff_t n = 0;

    PM_TRY(PM_NEW(queue, g->n, err));
    PM_TRY(PM_NEW(before, g->n, err));
    PM_TRY(PM_NEW(high, g->n, err));
    for (ptrdiff_t i = 0; i < g->n; i++)
        before[i] = came[i] = going[i] = -1;
    for (ptrdiff_t k = 0; k < a->nrim[1]; k++)
        high[a->rim[1][k]] = 1;
    for (ptrdiff_t k = 0; k < a->nrim[0]; k++) {
        queue[n++] = a->rim[0][k];
        before[a->rim[0][k]] = a->rim[0][k];
    }
    for (ptrdiff_t at = 0; at < n && end < 0; at++)
        for (ptrdiff_t e = g->ptr[queue[at]]; e < g->ptr[queue[at] + 1] && end < 0; e++) {
            int32_t j = (int32_t)g->to[e];
            if (before[j] >= 0)
                continue;
            before[j] = queue[at];
            queue[n++] = j;
            end = high[j] ? j : -1;
        }
    if (end < 0)
        PM_TRY(pm_fail(err, PM_INPUT, "surface does not join its two ends, or they touch"));
    for (int32_t i = end; before[i] != i; i = before[i]) {
        came[i] = before[i];
        going[before[i]] = i;
    }
done:
    pm_free(queue);
    pm_free(before);
    pm_free(high);
    return status;
}

static void mark(struct graph *g, ptrdiff_t i, ptrdiff_t j)
{
    g->jump[find(g, i, j)] = 1;
    g->jump[find(g, j, i)] = -1;
}

/* Edges from the path to the nodes on its left, where theta comes round to 2 pi. */
static void set_jumps(struct graph *g, const struct pm_annulus *a, const int32_t *came,
                      const int32_t *going)
{
    for (ptrdiff_t i = 0; i < g->n; i++) {
        int32_t j;
        if (going[i] >= 0) { /* counter-clockwise from the way on */
            for (j = pm_star_after(a->star, i, going[i]);
                 j >= 0 && j != came[i] && !(a->out != NULL && a->out[j]);
                 j = pm_star_after(a->star, i, j))
                mark(g, i, j);
        } else if (came[i] >= 0) { /* the end: clockwise from the way back */
            for (j = pm_star_after(a->star, came[i], i); j >= 0 && !(a->out != NULL && a->out[j]);
                 j = pm_star_after(a->star, j, i))
                mark(g, i, j);
        }
    }
}

/* Free nodes in elimination order: place[i] >= 0, node perm[place[i]] = i. */
static enum pm_status order(const struct graph *g, const uint8_t *fixed, ptrdiff_t *place,
                            ptrdiff_t **perm, ptrdiff_t *count, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *ptr = NULL, *adj = NULL, *node = NULL, *number = NULL, n = 0, na = 0;

    PM_TRY(PM_NEW(ptr, g->n + 1, err));
    PM_TRY(PM_NEW(adj, g->ptr[g->n], err));
    PM_TRY(PM_NEW(node, g->n, err));
    PM_TRY(PM_NEW(number, g->n, err));
    PM_TRY(PM_NEW(*perm, g->n, err));
    for (ptrdiff_t i = 0; i < g->n; i++) {
        number[i] = place[i] = -1;
        if (!fixed[i] && g->ptr[i + 1] > g->ptr[i]) {
            node[n] = i;
            number[i] = n++;
        }
    }
    for (ptrdiff_t k = 0; k < n; k++) {
        for (ptrdiff_t e = g->ptr[node[k]]; e < g->ptr[node[k] + 1]; e++)
            if (number[g->to[e]] >= 0)
                adj[na++] = number[g->to[e]];
        ptr[k + 1] = na;
    }
    PM_TRY(pm_order_nodes(n, ptr, adj, *perm, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        (*perm)[k] = node[(*perm)[k]];
        place[(*perm)[k]] = k;
    }
    *count = n;
done:
    pm_free(ptr);
    pm_free(adj);
    pm_free(node);
    pm_free(number);
    return status;
}

/* Lower triangle of the Laplacian of the free nodes. */
static void assemble(const struct graph *g, const ptrdiff_t *place, const ptrdiff_t *perm,
                     ptrdiff_t n, ptrdiff_t *ptr, ptrdiff_t *row, double *value)
{
    ptrdiff_t na = 0;

    for (ptrdiff_t k = 0; k < n; k++) {
        const ptrdiff_t first = na++;
        row[first] = k;
        value[first] = 0;
        for (ptrdiff_t e = g->ptr[perm[k]]; e < g->ptr[perm[k] + 1]; e++) {
            value[first] += g->w[e];
            ptrdiff_t j = place[g->to[e]], at = na;
            if (j <= k)
                continue;
            for (; at > first + 1 && row[at - 1] > j; at--) { /* rows ascend */
                row[at] = row[at - 1];
                value[at] = value[at - 1];
            }
            row[at] = j;
            value[at] = -g->w[e];
            na++;
        }
        ptr[k + 1] = na;
    }
}

/* f of the nodes that are not fixed: sum_j w_ij (f_i - f_j + period jump_ij) = 0. */
static enum pm_status harmonic(const struct graph *g, const uint8_t *fixed, double period,
                               double *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *place = NULL, *perm = NULL, *ptr = NULL, *row = NULL, n = 0;
    double *value = NULL, *rhs = NULL;
    struct pm_cholesky *factor = NULL;
    int definite;

    PM_TRY(PM_NEW(place, g->n, err));
    PM_TRY(order(g, fixed, place, &perm, &n, err));
    if (n == 0)
        goto done;
    PM_TRY(PM_NEW(ptr, n + 1, err));
    PM_TRY(PM_NEW(row, n + g->ptr[g->n], err));
    PM_TRY(PM_NEW(value, n + g->ptr[g->n], err));
    PM_TRY(PM_NEW(rhs, n, err));
    assemble(g, place, perm, n, ptr, row, value);
    for (ptrdiff_t k = 0; k < n; k++)
        for (ptrdiff_t e = g->ptr[perm[k]]; e < g->ptr[perm[k] + 1]; e++)
            rhs[k] += g->w[e] * ((place[g->to[e]] < 0 ? f[g->to[e]] : 0) - period * g->jump[e]);
    PM_TRY(pm_cholesky_new(n, ptr, row, &factor, err));
    PM_TRY(pm_cholesky_factor(factor, value, &definite, NULL, err));
    if (!definite)
        PM_TRY(pm_fail(err, PM_NUMERIC, "Laplacian of a surface with %td nodes is singular", g->n));
    PM_TRY(pm_cholesky_solve(factor, rhs, 1, err));
    for (ptrdiff_t k = 0; k < n; k++)
        f[perm[k]] = rhs[k];
done:
    pm_cholesky_free(factor);
    pm_free(place);
    pm_free(perm);
    pm_free(ptr);
    pm_free(row);
    pm_free(value);
    pm_free(rhs);
    return status;
}

/* |grad f|^2 in a triangle from its differences f along the edges u, v, times 4 area^2. */
static double gradient(const double u[3], const double v[3], const double f[2])
{
    double sum = 0;

    for (int j = 0; j < 3; j++)
        sum += pow(f[0] * v[j] - f[1] * u[j], 2);
    return sum;
}

/* The length of the cylinder: |grad psi| = |grad theta| in the geometric mean over the area. The
 * energies of psi and theta would say it too, but much of theirs lies in a few triangles at the
 * poles. */
static double length_of(const struct graph *g, const struct pm_annulus *a, const double *p,
                        const double *theta)
{
    const struct pm_trimesh *m = a->mesh;
    double sum = 0, total = 0;

    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *i = &m->tri[3 * t];
        double e[2][3], dp[2], dt[2], n[3];
        if (outside(a, i))
            continue;
        for (int k = 0; k < 2; k++) {
            ptrdiff_t j = i[k + 1];
            for (int l = 0; l < 3; l++)
                e[k][l] = m->x[3 * j + l] - m->x[3 * (ptrdiff_t)i[0] + l];
            dp[k] = p[j] - p[i[0]];
            dt[k] = theta[j] - theta[i[0]] - TWO_PI * g->jump[find(g, i[0], j)];
        }
        const double gp = gradient(e[0], e[1], dp), gt = gradient(e[0], e[1], dt);
        pm_triangle_area(m, t, n);
        const double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (!(gp > 0) || !(gt > 0))
            continue;
        sum += area * log(gt / gp) / 2;
        total += area;
    }
    return exp(sum / total);
}

static double edge_length(const struct pm_annulus *a, ptrdiff_t i, ptrdiff_t j)
{
    const double *p = &a->mesh->x[3 * i], *q = &a->mesh->x[3 * j];

    return hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

/* Where theta does not rise everywhere along a rim, by its length instead, turned to fit best on
 * average; returns whether it was so. */
static int straighten(const struct graph *g, const struct pm_annulus *a, int side, double *theta)
{
    const int32_t *rim = a->rim[side];
    ptrdiff_t n = a->nrim[side];
    double total = 0, at = 0, now = 0, turn = 0;
    int rises = 1;

    for (ptrdiff_t k = 0; k < n; k++)
        total += edge_length(a, rim[k], rim[(k + 1) % n]);
    for (ptrdiff_t k = 0; k < n; k++) {
        ptrdiff_t i = rim[k], j = rim[(k + 1) % n], e = find(g, i, j);
        double length = TWO_PI * edge_length(a, i, j) / total;
        double rise = theta[j] - theta[i] - TWO_PI * g->jump[e];
        rises &= rise > RISE_MIN * length;
        turn += (now - at) / (double)n;
        at += length;
        now += rise;
    }
    if (rises)
        return 0;
    at = theta[rim[0]] + turn;
    for (ptrdiff_t k = 0, cross = 0; k < n; k++) {
        ptrdiff_t i = rim[k], j = rim[(k + 1) % n];
        theta[i] = at + TWO_PI * (double)cross;
        cross += g->jump[find(g, i, j)];
        at += TWO_PI * edge_length(a, i, j) / total;
    }
    return 1;
}

static enum pm_status solve(const struct graph *g, const struct pm_annulus *a, double *psi,
                            double *theta, double *modulus, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    uint8_t *fixed = NULL;
    double *p = NULL, *t = NULL;

    PM_TRY(PM_NEW(fixed, g->n, err));
    PM_TRY(PM_NEW(p, g->n, err));
    PM_TRY(PM_NEW(t, g->n, err));
    fixed[a->rim[0][0]] = 1;
    PM_TRY(harmonic(g, fixed, TWO_PI, t, err));
    if (straighten(g, a, 0, t) | straighten(g, a, 1, t)) {
        for (int side = 0; side < 2; side++)
            for (ptrdiff_t k = 0; k < a->nrim[side]; k++)
                fixed[a->rim[side][k]] = 1;
        PM_TRY(harmonic(g, fixed, TWO_PI, t, err));
    }
    for (int side = 0; side < 2; side++)
        for (ptrdiff_t k = 0; k < a->nrim[side]; k++) {
            fixed[a->rim[side][k]] = 1;
            p[a->rim[side][k]] = side;
        }
    PM_TRY(harmonic(g, fixed, 0, p, err));
    *modulus = length_of(g, a, p, t);
    for (ptrdiff_t i = 0; i < g->n; i++) {
        if (a->out != NULL && a->out[i])
            continue;
        psi[i] = *modulus * p[i];
        theta[i] = t[i] - TWO_PI * floor(t[i] / TWO_PI);
    }
done:
    pm_free(fixed);
    pm_free(p);
    pm_free(t);
    return status;
}

enum pm_status pm_annulus_map(const struct pm_annulus *a, double *psi, double *theta,
                              double *modulus, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct graph g = {0};
    int32_t *came = NULL, *going = NULL;

    PM_TRY(connect(&g, a, err));
    weigh(&g, a);
    PM_TRY(PM_NEW(came, g.n, err));
    PM_TRY(PM_NEW(going, g.n, err));
    PM_TRY(cut(&g, a, came, going, err));
    set_jumps(&g, a, came, going);
    PM_TRY(solve(&g, a, psi, theta, modulus, err));
done:
    graph_release(&g);
    pm_free(came);
    pm_free(going);
    return status;
}
