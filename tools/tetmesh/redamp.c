#include "tools/tetmesh/redamp.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/quality.h"

static const double SHARE = 0.7; /* of a mid-side node's own weights that a sweep keeps */
enum { SWEEPS = 3 };             /* then 0.34 are left and a new mesh is better */

/* Ends of the edge of each mid-side surface node that lies in an element below the bound, -1
 * elsewhere (nn x 2). */
static ptrdiff_t find_bad(const struct pm_mesh *m, double bound, int32_t *ends)
{
    ptrdiff_t bad = 0;

    for (ptrdiff_t i = 0; i < 2 * m->nn; i++)
        ends[i] = -1;
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        const int32_t *v = m->tet + 10 * e;
        double X[30];
        pm_quality_gather(m, m->x, e, X);
        if (pm_quality_scaled(X) >= bound)
            continue;
        bad++;
        for (int k = 0; k < 6; k++) {
            const int32_t a = v[4 + k], i = v[pm_tet10_edge[k][0]], j = v[pm_tet10_edge[k][1]];
            if (m->surface[a] < 0 || m->surface[i] < 0 || m->surface[j] < 0)
                continue;
            ends[2 * a] = i;
            ends[2 * a + 1] = j;
        }
    }
    return bad;
}

struct rows {
    double *sum;         /* of one row (N) */
    unsigned char *used; /* (N) */
    int32_t *col;
    double *val;
    ptrdiff_t n;
};

static void add_row(const struct pm_mesh *m, ptrdiff_t a, double factor, struct rows *r)
{
    for (int64_t w = m->wptr[a]; w < m->wptr[a + 1]; w++) {
        r->sum[m->wcol[w]] += factor * m->wval[w];
        r->used[m->wcol[w]] = 1;
    }
}

static void close_row(ptrdiff_t N, struct rows *r)
{
    for (ptrdiff_t i = 0; i < N; i++) {
        if (!r->used[i])
            continue;
        r->col[r->n] = (int32_t)i;
        r->val[r->n++] = r->sum[i];
        r->sum[i] = 0;
        r->used[i] = 0;
    }
}

/* New rows for the nodes with ends, the others as they are. */
static enum pm_status mix_rows(struct pm_mesh *m, const int32_t *ends, struct pm_err *err)
{
    enum pm_status status;
    struct rows r = {.n = 0};
    int64_t *ptr = NULL;
    ptrdiff_t room = m->nw;

    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int k = 0; k < 2 && ends[2 * a] >= 0; k++)
            room += m->wptr[ends[2 * a + k] + 1] - m->wptr[ends[2 * a + k]];
    PM_TRY(PM_NEW(r.sum, m->N, err));
    PM_TRY(PM_NEW(r.used, m->N, err));
    PM_TRY(PM_NEW(r.col, room, err));
    PM_TRY(PM_NEW(r.val, room, err));
    PM_TRY(PM_NEW(ptr, m->nn + 1, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const ptrdiff_t from = m->wptr[a], count = m->wptr[a + 1] - from;
        if (ends[2 * a] >= 0) {
            add_row(m, a, SHARE, &r);
            add_row(m, ends[2 * a], (1 - SHARE) / 2, &r);
            add_row(m, ends[2 * a + 1], (1 - SHARE) / 2, &r);
            close_row(m->N, &r);
        } else if (count > 0) {
            memcpy(r.col + r.n, m->wcol + from, (size_t)count * sizeof *r.col);
            memcpy(r.val + r.n, m->wval + from, (size_t)count * sizeof *r.val);
            r.n += count;
        }
        ptr[a + 1] = r.n;
    }
    pm_free(m->wptr);
    pm_free(m->wcol);
    pm_free(m->wval);
    m->wptr = ptr;
    m->wcol = r.col;
    m->wval = r.val;
    m->nw = r.n;
    ptr = NULL;
    r.col = NULL;
    r.val = NULL;
done:
    pm_free(r.sum);
    pm_free(r.used);
    pm_free(r.col);
    pm_free(r.val);
    pm_free(ptr);
    return status;
}

enum pm_status pm_redamp(struct pm_mesh *m, struct pm_extension *ext, const double *phi,
                         double bound, ptrdiff_t *damped, struct pm_err *err)
{
    enum pm_status status;
    int32_t *ends = NULL;

    *damped = 0;
    PM_TRY(PM_NEW(ends, 2 * m->nn, err));
    for (int sweep = 0; sweep < SWEEPS && find_bad(m, bound, ends) > 0; sweep++) {
        ptrdiff_t nodes = 0;
        for (ptrdiff_t a = 0; a < m->nn; a++)
            nodes += ends[2 * a] >= 0;
        *damped = nodes > *damped ? nodes : *damped;
        PM_TRY(mix_rows(m, ends, err));
        m->max_damping = 1 - SHARE * (1 - m->max_damping); /* an upper bound */
        PM_TRY(pm_mesh_morph(m, ext, phi, err));
    }
done:
    pm_free(ends);
    return status;
}
