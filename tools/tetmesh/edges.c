#include "tools/tetmesh/edges.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"

static const int tet_face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

static int ascending(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

void pm_edges_release(struct pm_edges *e)
{
    pm_free(e->ptr);
    pm_free(e->low);
    pm_free(e->high);
    *e = (struct pm_edges){0};
}

/* Sorts the ends above each lower one and drops repetitions. */
static void unique(struct pm_edges *e)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t a = 0; a < e->nv; a++) {
        const ptrdiff_t first = e->ptr[a], last = e->ptr[a + 1], start = n;
        qsort(e->high + first, (size_t)(last - first), sizeof *e->high, ascending);
        for (ptrdiff_t k = first; k < last; k++)
            if (n == start || e->high[n - 1] != e->high[k]) {
                e->low[n] = (int32_t)a;
                e->high[n++] = e->high[k];
            }
        e->ptr[a] = start;
    }
    e->ptr[e->nv] = e->n = n;
}

enum pm_status pm_edges_new(ptrdiff_t nv, ptrdiff_t ne, const int32_t *tet, struct pm_edges *e,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *next = NULL;
    *e = (struct pm_edges){.nv = nv};
    PM_TRY(PM_NEW(e->ptr, nv + 1, err));
    PM_TRY(PM_NEW(e->low, 6 * ne, err));
    PM_TRY(PM_NEW(e->high, 6 * ne, err));
    PM_TRY(PM_NEW(next, nv, err));
    for (int pass = 0; pass < 2; pass++) {
        for (ptrdiff_t k = 0; k < 6 * ne; k++) {
            const int32_t p = tet[4 * (k / 6) + pm_tet10_edge[k % 6][0]],
                          q = tet[4 * (k / 6) + pm_tet10_edge[k % 6][1]];
            const int32_t a = p < q ? p : q, b = p < q ? q : p;
            if (pass == 0)
                e->ptr[a + 1]++;
            else
                e->high[next[a]++] = b;
        }
        for (ptrdiff_t a = 0; a < nv && pass == 0; a++) {
            e->ptr[a + 1] += e->ptr[a];
            next[a] = e->ptr[a];
        }
    }
    unique(e);
done:
    pm_free(next);
    if (status != PM_OK)
        pm_edges_release(e);
    return status;
}

ptrdiff_t pm_edges_find(const struct pm_edges *e, int32_t a, int32_t b)
{
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    for (ptrdiff_t k = e->ptr[low]; k < e->ptr[low + 1]; k++)
        if (e->high[k] == high)
            return k;
    return -1;
}

static int by_key(const void *a, const void *b)
{
    const struct pm_face *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->key[k] != q->key[k])
            return p->key[k] < q->key[k] ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

static int by_element(const void *a, const void *b)
{
    const struct pm_face *p = a, *q = b;
    const ptrdiff_t i = 4 * (ptrdiff_t)p->element + p->side,
                    j = 4 * (ptrdiff_t)q->element + q->side;
    return (i > j) - (i < j);
}

ptrdiff_t pm_same_faces(const struct pm_face *f, ptrdiff_t k, ptrdiff_t n)
{
    ptrdiff_t m = 1;
    while (k + m < n && memcmp(f[k].key, f[k + m].key, sizeof f->key) == 0)
        m++;
    return m;
}

enum pm_status pm_sorted_faces(ptrdiff_t ne, const int32_t *tet, struct pm_face **face,
                               struct pm_err *err)
{
    struct pm_face *f = NULL;
    *face = NULL;
    if (PM_NEW(f, 4 * ne, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t k = 0; k < 4 * ne; k++) {
        int32_t *v = f[k].key;
        f[k].element = (int32_t)(k / 4);
        f[k].side = (int32_t)(k % 4);
        for (int i = 0; i < 3; i++)
            v[i] = tet[4 * (k / 4) + tet_face[k % 4][i]];
        f[k].turned = ((v[0] > v[1]) + (v[0] > v[2]) + (v[1] > v[2])) % 2;
        qsort(v, 3, sizeof *v, ascending);
    }
    qsort(f, (size_t)(4 * ne), sizeof *f, by_key);
    *face = f;
    return PM_OK;
}

enum pm_status pm_boundary_faces(ptrdiff_t ne, const int32_t *tet, ptrdiff_t *n, int32_t **face,
                                 int32_t **element, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_face *f = NULL;
    *n = 0;
    *face = *element = NULL;
    PM_TRY(pm_sorted_faces(ne, tet, &f, err));
    for (ptrdiff_t k = 0, m; k < 4 * ne; k += m) {
        m = pm_same_faces(f, k, 4 * ne);
        if (m > 2)
            PM_TRY(pm_fail(err, PM_NUMERIC,
                           "face %d-%d-%d belongs to %td tetrahedra, expected 1 or 2",
                           (int)f[k].key[0], (int)f[k].key[1], (int)f[k].key[2], m));
        if (m == 1)
            f[(*n)++] = f[k];
    }
    qsort(f, (size_t)*n, sizeof *f, by_element);
    PM_TRY(PM_NEW(*face, 3 * *n, err));
    PM_TRY(PM_NEW(*element, *n, err));
    for (ptrdiff_t k = 0; k < *n; k++) {
        (*element)[k] = f[k].element;
        for (int i = 0; i < 3; i++)
            (*face)[3 * k + i] = tet[4 * (ptrdiff_t)f[k].element + tet_face[f[k].side][i]];
    }
done:
    pm_free(f);
    if (status != PM_OK) {
        pm_free(*face);
        pm_free(*element);
        *face = *element = NULL;
    }
    return status;
}
