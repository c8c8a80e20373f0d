#include "tools/tetmesh/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

enum pm_status pm_weights_init(struct pm_weights *w, const struct pm_surfaces *s, ptrdiff_t nn,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t N = s->offset[s->ns];
    *w = (struct pm_weights){.s = s, .nn = nn, .capacity = 1024};
    PM_TRY(PM_NEW(w->ptr, nn + 1, err));
    PM_TRY(PM_NEW(w->col, w->capacity, err));
    PM_TRY(PM_NEW(w->val, w->capacity, err));
    PM_TRY(PM_NEW(w->sum, N, err));
    PM_TRY(PM_NEW(w->used, N, err));
    PM_TRY(PM_NEW(w->marked, N, err));
done:
    return status;
}

void pm_weights_release(struct pm_weights *w)
{
    pm_basis_release(&w->basis);
    pm_free(w->ptr);
    pm_free(w->col);
    pm_free(w->val);
    pm_free(w->sum);
    pm_free(w->used);
    pm_free(w->marked);
    *w = (struct pm_weights){0};
}

enum pm_status pm_weights_add(struct pm_weights *w, const struct pm_map *map, int32_t k,
                              const double S[3], double factor, struct pm_err *err)
{
    const enum pm_status status = pm_map_basis(map, S, 0, &w->basis, err);
    for (ptrdiff_t i = 0; i < w->basis.n && status == PM_OK; i++) {
        const int32_t col = (int32_t)(w->s->offset[k] + w->basis.id[i]);
        if (!w->marked[col]) {
            w->marked[col] = 1;
            w->used[w->nused++] = col;
        }
        w->sum[col] += factor * w->basis.c[i];
    }
    return status;
}

enum pm_status pm_weights_add_node(struct pm_weights *w, struct pm_map *const *map,
                                   const struct pm_mesh *m, ptrdiff_t a, const int32_t ends[2],
                                   double t, struct pm_err *err)
{
    int32_t k = m->surface[a];
    enum pm_status status = pm_weights_add(w, map[k], k, m->S + 3 * a, t, err);
    for (int j = 0; j < 2 && t < 1 && status == PM_OK; j++) {
        k = m->surface[ends[j]];
        status = pm_weights_add(w, map[k], k, m->S + 3 * ends[j], (1 - t) / 2, err);
    }
    return status;
}

static int ascending(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static enum pm_status reserve(struct pm_weights *w, ptrdiff_t n, struct pm_err *err)
{
    if (n <= w->capacity)
        return PM_OK;
    int32_t *col = pm_realloc(w->col, 2 * n, sizeof *col, err);
    if (col == NULL)
        return PM_SYSTEM;
    w->col = col;
    double *val = pm_realloc(w->val, 2 * n, sizeof *val, err);
    if (val == NULL)
        return PM_SYSTEM;
    w->val = val;
    w->capacity = 2 * n;
    return PM_OK;
}

enum pm_status pm_weights_close_row(struct pm_weights *w, double *x, struct pm_err *err)
{
    int64_t n = w->ptr[w->row];
    if (reserve(w, (ptrdiff_t)n + w->nused, err) != PM_OK)
        return PM_SYSTEM;
    qsort(w->used, (size_t)w->nused, sizeof *w->used, ascending);
    if (w->nused > 0)
        x[0] = x[1] = x[2] = 0;
    ptrdiff_t k = 0;
    for (ptrdiff_t i = 0; i < w->nused; i++, n++) {
        const int32_t col = w->used[i];
        while (col >= w->s->offset[k + 1])
            k++;
        w->col[n] = col;
        w->val[n] = w->sum[col];
        for (int j = 0; j < 3; j++)
            x[j] += w->val[n] * w->s->s[k].phi[3 * (col - w->s->offset[k]) + j];
        w->sum[col] = 0;
        w->marked[col] = 0;
    }
    w->nused = 0;
    w->ptr[++w->row] = n;
    return PM_OK;
}

void pm_weights_finish(struct pm_weights *w, struct pm_mesh *m)
{
    m->nw = (ptrdiff_t)w->ptr[w->nn];
    m->wptr = w->ptr;
    m->wcol = w->col;
    m->wval = w->val;
    w->ptr = NULL;
    w->col = NULL;
    w->val = NULL;
}

/* Largest difference between the stored row of node a and the basis. */
static double row_error(const struct pm_mesh *m, ptrdiff_t a, ptrdiff_t offset,
                        const struct pm_basis *b, double *dense)
{
    double worst = 0;
    for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++)
        dense[m->wcol[k]] += m->wval[k];
    for (ptrdiff_t i = 0; i < b->n; i++)
        dense[offset + b->id[i]] -= b->c[i];
    for (ptrdiff_t i = 0; i < b->n; i++)
        worst = fmax(worst, fabs(dense[offset + b->id[i]]));
    for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++)
        worst = fmax(worst, fabs(dense[m->wcol[k]]));
    for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++)
        dense[m->wcol[k]] = 0;
    for (ptrdiff_t i = 0; i < b->n; i++)
        dense[offset + b->id[i]] = 0;
    return worst;
}

enum pm_status pm_weights_same(const struct pm_mesh *m, const struct pm_surfaces *s, int *same,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map[PM_MAX_CHAMBERS + 1] = {NULL};
    struct pm_basis b = {0};
    uint8_t *vertex = NULL;
    double *dense = NULL;
    *same = m->N == s->offset[s->ns] && m->nc == s->ns - 1;
    if (!*same)
        return PM_OK;
    PM_TRY(PM_NEW(vertex, m->nn, err));
    PM_TRY(PM_NEW(dense, m->N, err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(pm_map_new(&s->s[k], &map[k], err));
    for (ptrdiff_t k = 0; k < 4 * m->ne; k++)
        vertex[m->tet[10 * (k / 4) + k % 4]] = 1;
    for (ptrdiff_t a = 0; a < m->nn && *same; a++) {
        const int32_t k = m->surface[a];
        struct pm_err uncovered = {.status = PM_OK};
        if (!vertex[a] || k < 0)
            continue;
        *same = pm_map_basis(map[k], m->S + 3 * a, 0, &b, &uncovered) == PM_OK &&
                row_error(m, a, s->offset[k], &b, dense) <= 1e-12;
    }
done:
    for (ptrdiff_t k = 0; k < s->ns; k++)
        pm_map_free(map[k]);
    pm_basis_release(&b);
    pm_free(vertex);
    pm_free(dense);
    return status;
}
