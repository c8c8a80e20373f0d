#include "common/geometry/hemispheres.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/base/sparse.h"
#include "common/files/surfaces.h"
#include "common/geometry/remesh.h"

static const double BAND = 0.25;

/* Neighbours of the nodes, and the Laplacian of the free ones in elimination order. */
struct graph {
    ptrdiff_t nn, n; /* nodes, free ones */
    ptrdiff_t *ptr;  /* (nn + 1) */
    int32_t *adj;
    ptrdiff_t *place; /* of a node in the elimination order, -1: held (nn) */
    ptrdiff_t *node;  /* at a place (n) */
    ptrdiff_t *lptr, *lrow;
    double *value, *rhs; /* rhs (2 x n) */
    struct pm_cholesky *factor;
};

static void release(struct graph *g)
{
    void *all[] = {g->ptr, g->adj, g->place, g->node, g->lptr, g->lrow, g->value, g->rhs};

    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        pm_free(all[k]);
    pm_cholesky_free(g->factor);
}

/* On a closed surface every neighbour follows a node in one triangle. */
static enum pm_status neighbours(struct graph *g, ptrdiff_t nt, const int32_t *tri,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;

    PM_TRY(PM_NEW(g->ptr, g->nn + 2, err));
    PM_TRY(PM_NEW(g->adj, 3 * nt, err));
    for (ptrdiff_t k = 0; k < 3 * nt; k++)
        g->ptr[tri[k] + 2]++;
    for (ptrdiff_t a = 0; a < g->nn; a++)
        g->ptr[a + 2] += g->ptr[a + 1];
    for (ptrdiff_t k = 0; k < 3 * nt; k++)
        g->adj[g->ptr[tri[k] + 1]++] = tri[k / 3 * 3 + (k + 1) % 3];
done:
    return status;
}

/* Elimination order of the free nodes: place and node. */
static enum pm_status order(struct graph *g, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *ptr = NULL, *adj = NULL, *perm = NULL, *free_node = NULL;

    PM_TRY(PM_NEW(ptr, g->n + 1, err));
    PM_TRY(PM_NEW(adj, g->ptr[g->nn], err));
    PM_TRY(PM_NEW(perm, g->n, err));
    PM_TRY(PM_NEW(free_node, g->n, err));
    for (ptrdiff_t a = 0; a < g->nn; a++) {
        const ptrdiff_t i = g->place[a];
        if (i < 0)
            continue;
        free_node[i] = a;
        ptr[i + 1] = ptr[i];
        for (ptrdiff_t k = g->ptr[a]; k < g->ptr[a + 1]; k++)
            if (g->place[g->adj[k]] >= 0)
                adj[ptr[i + 1]++] = g->place[g->adj[k]];
    }
    PM_TRY(pm_order_nodes(g->n, ptr, adj, perm, err));
    for (ptrdiff_t k = 0; k < g->n; k++) {
        g->node[k] = free_node[perm[k]];
        g->place[g->node[k]] = k;
    }
done:
    pm_free(ptr);
    pm_free(adj);
    pm_free(perm);
    pm_free(free_node);
    return status;
}

/* Column k: the number of neighbours, then -1 at the later places, ascending. */
static enum pm_status laplacian(struct graph *g, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t column, n = 0;
    int definite;

    for (ptrdiff_t k = 0; k < g->n; k++) {
        const ptrdiff_t a = g->node[k], first = n;
        g->lrow[n] = k;
        g->value[n++] = (double)(g->ptr[a + 1] - g->ptr[a]);
        for (ptrdiff_t e = g->ptr[a]; e < g->ptr[a + 1]; e++) {
            const ptrdiff_t row = g->place[g->adj[e]];
            ptrdiff_t at = n;
            if (row <= k)
                continue;
            for (; at > first + 1 && g->lrow[at - 1] > row; at--)
                g->lrow[at] = g->lrow[at - 1];
            g->lrow[at] = row;
            g->value[n++] = -1;
        }
        g->lptr[k + 1] = n;
    }
    pm_cholesky_free(g->factor);
    g->factor = NULL;
    PM_TRY(pm_cholesky_new(g->n, g->lptr, g->lrow, &g->factor, err));
    PM_TRY(pm_cholesky_factor(g->factor, g->value, &definite, &column, err));
    if (!definite)
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "cannot refine the parameters: a part of the control "
                       "points is joined to no other"));
done:
    return status;
}

static void chart(const double S[3], double side, double q[2])
{
    q[0] = 2 * S[0] / (1 + side * S[2]);
    q[1] = 2 * S[1] / (1 + side * S[2]);
}

static void unchart(const double q[2], double side, double S[3])
{
    const double s = q[0] * q[0] + q[1] * q[1];

    S[0] = 4 * q[0] / (4 + s);
    S[1] = 4 * q[1] / (4 + s);
    S[2] = side * (4 - s) / (4 + s);
}

/* One half: side = 1 about the north pole, -1 about the south pole. */
static enum pm_status half(struct graph *g, double side, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    g->n = 0;
    for (ptrdiff_t a = 0; a < g->nn; a++)
        g->place[a] = side * S[3 * a + 2] > -BAND ? g->n++ : -1;
    PM_TRY(order(g, err));
    PM_TRY(laplacian(g, err));
    memset(g->rhs, 0, 2 * (size_t)g->n * sizeof *g->rhs);
    for (ptrdiff_t k = 0; k < g->n; k++)
        for (ptrdiff_t e = g->ptr[g->node[k]]; e < g->ptr[g->node[k] + 1]; e++) {
            const ptrdiff_t b = g->adj[e];
            double q[2];
            if (g->place[b] >= 0)
                continue;
            chart(&S[3 * b], side, q);
            g->rhs[k] += q[0];
            g->rhs[g->n + k] += q[1];
        }
    PM_TRY(pm_cholesky_solve(g->factor, g->rhs, 2, err));
    for (ptrdiff_t k = 0; k < g->n; k++) {
        const double q[2] = {g->rhs[k], g->rhs[g->n + k]};
        unchart(q, side, &S[3 * g->node[k]]);
    }
done:
    return status;
}

static int folded(const double *S, ptrdiff_t nt, const int32_t *tri)
{
    for (ptrdiff_t t = 0; t < nt; t++)
        if (!(pm_parameter_orientation(PM_SURFACE_SPHERE, &S[3 * (ptrdiff_t)tri[3 * t]],
                                       &S[3 * (ptrdiff_t)tri[3 * t + 1]],
                                       &S[3 * (ptrdiff_t)tri[3 * t + 2]]) > 0))
            return 1;
    return 0;
}

enum pm_status pm_hemispheres(ptrdiff_t nn, double *S, ptrdiff_t nt, const int32_t *tri,
                              int *passes, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct graph g = {.nn = nn};
    double *before = NULL;

    *passes = 0;
    PM_TRY(neighbours(&g, nt, tri, err));
    PM_TRY(PM_NEW(g.place, nn, err));
    PM_TRY(PM_NEW(g.node, nn, err));
    PM_TRY(PM_NEW(g.lptr, nn + 1, err));
    PM_TRY(PM_NEW(g.lrow, nn + 3 * nt, err));
    PM_TRY(PM_NEW(g.value, nn + 3 * nt, err));
    PM_TRY(PM_NEW(g.rhs, 2 * nn, err));
    PM_TRY(PM_NEW(before, 3 * nn, err));
    for (int pass = 0; pass < 2; pass++) {
        memcpy(before, S, 3 * (size_t)nn * sizeof *S);
        PM_TRY(half(&g, pass == 0 ? 1 : -1, S, err));
        if (folded(S, nt, tri))
            memcpy(S, before, 3 * (size_t)nn * sizeof *S);
        else
            ++*passes;
    }
done:
    release(&g);
    pm_free(before);
    return status;
}
