#include "common/mechanics/pattern.h"

#include <stdlib.h>

#include "common/base/memory.h"
#include "common/base/sparse.h"

static int compare(const void *a, const void *b)
{
    ptrdiff_t x = *(const ptrdiff_t *)a, y = *(const ptrdiff_t *)b;
    return (x > y) - (x < y);
}

static ptrdiff_t unique(ptrdiff_t *list, ptrdiff_t n)
{
    qsort(list, (size_t)n, sizeof *list, compare);
    ptrdiff_t m = 0;
    for (ptrdiff_t i = 0; i < n; i++)
        if (m == 0 || list[i] != list[m - 1])
            list[m++] = list[i];
    return m;
}

/* Adjacency lists among used nodes, without self loops; index[a] numbers the used nodes. */
static enum pm_status adjacency(ptrdiff_t ne, ptrdiff_t npe, const int32_t *tet,
                                const ptrdiff_t *index, ptrdiff_t n, ptrdiff_t **ptr_out,
                                ptrdiff_t **adj_out, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t *ptr = NULL, *adj = NULL, *fill = NULL;
    PM_TRY(PM_NEW(ptr, n + 1, err));
    PM_TRY(PM_NEW(fill, n + 1, err));
    for (ptrdiff_t e = 0; e < ne; e++)
        for (int a = 0; a < npe; a++)
            if (index[tet[npe * e + a]] >= 0)
                fill[index[tet[npe * e + a]]] += npe - 1;
    for (ptrdiff_t i = 0; i < n; i++)
        ptr[i + 1] = ptr[i] + fill[i];
    PM_TRY(PM_NEW(adj, ptr[n], err));
    for (ptrdiff_t i = 0; i < n; i++)
        fill[i] = ptr[i];
    for (ptrdiff_t e = 0; e < ne; e++)
        for (int a = 0; a < npe; a++)
            for (int b = 0; b < npe; b++) {
                ptrdiff_t i = index[tet[npe * e + a]], j = index[tet[npe * e + b]];
                if (a != b && i >= 0 && j >= 0)
                    adj[fill[i]++] = j;
            }
    ptrdiff_t m = 0;
    for (ptrdiff_t i = 0; i < n; i++) {
        ptrdiff_t begin = ptr[i], count = unique(adj + begin, fill[i] - begin);
        ptr[i] = m;
        for (ptrdiff_t k = 0; k < count; k++)
            adj[m++] = adj[begin + k];
    }
    ptr[n] = m;
    *ptr_out = ptr;
    *adj_out = adj;
    ptr = adj = NULL;
done:
    pm_free(fill);
    pm_free(ptr);
    pm_free(adj);
    return status;
}

/* Lower lists in elimination order: place[i] of node i, node[k] at place k. */
static enum pm_status lower_lists(struct pm_pattern *p, const ptrdiff_t *ptr, const ptrdiff_t *adj,
                                  const ptrdiff_t *node, const ptrdiff_t *place, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t n = p->nodes, m = 0;
    PM_TRY(PM_NEW(p->lptr, n + 1, err));
    PM_TRY(PM_NEW(p->llist, n + ptr[n] / 2, err));
    for (ptrdiff_t j = 0; j < n; j++) {
        ptrdiff_t i = node[j], begin = m;
        p->lptr[j] = m;
        p->llist[m++] = j;
        for (ptrdiff_t k = ptr[i]; k < ptr[i + 1]; k++)
            if (place[adj[k]] > j)
                p->llist[m++] = place[adj[k]];
        qsort(p->llist + begin, (size_t)(m - begin), sizeof *p->llist, compare);
    }
    p->lptr[n] = m;
done:
    return status;
}

static enum pm_status columns(struct pm_pattern *p, const uint8_t *coupled, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t bs = p->bs, m = 0, first_tail = bs * p->nodes;
    PM_TRY(PM_NEW(p->ptr, p->n + 1, err));
    ptrdiff_t nnz = bs * bs * p->lptr[p->nodes] + p->tail * (p->n + 1);
    PM_TRY(PM_NEW(p->row, nnz, err));
    for (ptrdiff_t j = 0; j < p->nodes; j++)
        for (ptrdiff_t c = 0; c < bs; c++) {
            p->ptr[bs * j + c] = m;
            for (ptrdiff_t k = p->lptr[j]; k < p->lptr[j + 1]; k++)
                for (ptrdiff_t d = 0; d < bs; d++)
                    p->row[m++] = bs * p->llist[k] + d;
            for (ptrdiff_t t = 0; coupled[j] && t < p->tail; t++)
                p->row[m++] = first_tail + t;
        }
    for (ptrdiff_t c = 0; c < p->tail; c++) {
        p->ptr[first_tail + c] = m;
        for (ptrdiff_t t = c; t < p->tail; t++)
            p->row[m++] = first_tail + t;
    }
    p->ptr[p->n] = m;
done:
    return status;
}

/* Nodes at their places: those of `like` in its order, then the others. */
static enum pm_status order_like(const struct pm_pattern_source *from, const ptrdiff_t *index,
                                 ptrdiff_t n, ptrdiff_t *node, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_pattern *like = from->like;
    ptrdiff_t *at = NULL, k = 0; /* node at a place of `like`, + 1 */
    PM_TRY(PM_NEW(at, like->nodes, err));
    for (ptrdiff_t a = 0; a < from->nn; a++)
        if (like->eq[a] >= 0)
            at[like->eq[a]] = a + 1;
    for (ptrdiff_t i = 0; i < like->nodes; i++)
        if (at[i] > 0 && index[at[i] - 1] >= 0)
            node[k++] = index[at[i] - 1];
    for (ptrdiff_t a = 0; a < from->nn && k < n; a++)
        if (index[a] >= 0 && like->eq[a] < 0)
            node[k++] = index[a];
done:
    pm_free(at);
    return status;
}

enum pm_status pm_pattern_new(const struct pm_pattern_source *from, struct pm_pattern *p,
                              struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t *ptr = NULL, *adj = NULL, *node = NULL, *place = NULL;
    uint8_t *coupled = NULL;
    *p = (struct pm_pattern){.bs = from->bs, .tail = from->tail};
    PM_TRY(PM_NEW(p->eq, from->nn, err));
    for (ptrdiff_t a = 0; a < from->nn; a++)
        p->eq[a] = from->use[a] ? p->nodes++ : -1;
    p->n = p->bs * p->nodes + p->tail;
    PM_TRY(adjacency(from->ne, from->npe, from->tet, p->eq, p->nodes, &ptr, &adj, err));
    PM_TRY(PM_NEW(node, p->nodes, err));
    PM_TRY(PM_NEW(place, p->nodes, err));
    PM_TRY(PM_NEW(coupled, p->nodes, err));
    if (from->like != NULL)
        PM_TRY(order_like(from, p->eq, p->nodes, node, err));
    else
        PM_TRY(pm_order_nodes(p->nodes, ptr, adj, node, err));
    for (ptrdiff_t k = 0; k < p->nodes; k++)
        place[node[k]] = k;
    PM_TRY(lower_lists(p, ptr, adj, node, place, err));
    for (ptrdiff_t a = 0; a < from->nn; a++)
        if (p->eq[a] >= 0) {
            p->eq[a] = place[p->eq[a]];
            coupled[p->eq[a]] = from->couples != NULL && from->couples[a];
        }
    PM_TRY(columns(p, coupled, err));
done:
    pm_free(ptr);
    pm_free(adj);
    pm_free(node);
    pm_free(place);
    pm_free(coupled);
    if (status != PM_OK)
        pm_pattern_release(p);
    return status;
}

ptrdiff_t pm_pattern_block(const struct pm_pattern *p, ptrdiff_t i, ptrdiff_t j, ptrdiff_t c)
{
    ptrdiff_t lo = p->lptr[j], hi = p->lptr[j + 1];
    while (hi - lo > 1) {
        ptrdiff_t mid = (lo + hi) / 2;
        if (p->llist[mid] <= i)
            lo = mid;
        else
            hi = mid;
    }
    return p->ptr[p->bs * j + c] + p->bs * (lo - p->lptr[j]);
}

void pm_pattern_release(struct pm_pattern *p)
{
    pm_free(p->eq);
    pm_free(p->lptr);
    pm_free(p->llist);
    pm_free(p->ptr);
    pm_free(p->row);
    *p = (struct pm_pattern){0};
}
