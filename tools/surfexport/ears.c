#include "tools/surfexport/ears.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

/* Corners of the polygon in a ring; the ends of bridges occur twice. */
struct ring {
    ptrdiff_t n, capacity;
    int32_t *node;
    int32_t *next, *previous;
    double *quality; /* of the ear at this corner, -1: none */
    const double *uv;
};

/* Twice the signed area of a b c. */
static double turn(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static const double *at(const struct ring *r, ptrdiff_t i)
{
    return r->uv + 2 * (ptrdiff_t)r->node[i];
}

/* ---- bridges ---- */

/* Do the segments p q and a b meet in a point that is no common end? */
static int meet(const double *p, const double *q, const double *a, const double *b)
{
    const double s = turn(a, b, p), t = turn(a, b, q), u = turn(p, q, a), v = turn(p, q, b);
    return s * t <= 0 && u * v <= 0 && !(s == 0 && t == 0);
}

static int incident(const double *p, const double *q, const double *a)
{
    return (p[0] == a[0] && p[1] == a[1]) || (q[0] == a[0] && q[1] == a[1]);
}

/* Is q inside the angle of the polygon at corner i? */
static int in_cone(const struct ring *r, ptrdiff_t i, const double *q)
{
    const double *p = at(r, i), *a = at(r, r->previous[i]), *b = at(r, r->next[i]);
    if (turn(a, p, b) > 0)
        return turn(a, p, q) > 0 && turn(p, b, q) > 0;
    return !(turn(a, p, q) <= 0 && turn(p, b, q) <= 0);
}

static int sees(const struct ring *r, ptrdiff_t i, const double *q, const struct ears_loop *hole,
                ptrdiff_t nholes)
{
    const double *p = at(r, i);
    if (!in_cone(r, i, q))
        return 0;
    for (ptrdiff_t j = 0; j < r->n; j++) {
        const double *a = at(r, j), *b = at(r, r->next[j]);
        if (!incident(p, q, a) && !incident(p, q, b) && meet(p, q, a, b))
            return 0;
    }
    for (ptrdiff_t h = 0; h < nholes; h++)
        for (ptrdiff_t j = 0; j < hole[h].n; j++) {
            const double *a = r->uv + 2 * (ptrdiff_t)hole[h].node[j];
            const double *b = r->uv + 2 * (ptrdiff_t)hole[h].node[(j + 1) % hole[h].n];
            if (!incident(p, q, a) && !incident(p, q, b) && meet(p, q, a, b))
                return 0;
        }
    return 1;
}

static ptrdiff_t rightmost(const struct ears_loop *l, const double *uv)
{
    ptrdiff_t best = 0;
    for (ptrdiff_t j = 1; j < l->n; j++)
        if (uv[2 * l->node[j]] > uv[2 * l->node[best]])
            best = j;
    return best;
}

static ptrdiff_t append(struct ring *r, int32_t node)
{
    r->node[r->n] = node;
    return r->n++;
}

static void link_corners(struct ring *r, ptrdiff_t a, ptrdiff_t b)
{
    r->next[a] = (int32_t)b;
    r->previous[b] = (int32_t)a;
}

/* Joins hole[0] by a bridge from its rightmost node to the nearest corner that sees it; one does,
 * because the other holes end further left. */
static enum pm_status bridge(struct ring *r, const struct ears_loop *hole, ptrdiff_t nholes,
                             struct pm_err *err)
{
    const ptrdiff_t m = rightmost(hole, r->uv);
    const double *q = r->uv + 2 * (ptrdiff_t)hole->node[m];
    double nearest = INFINITY;
    ptrdiff_t from = -1;
    for (ptrdiff_t i = 0; i < r->n; i++) {
        const double d = hypot(at(r, i)[0] - q[0], at(r, i)[1] - q[1]);
        if (d < nearest && sees(r, i, q, hole, nholes)) {
            nearest = d;
            from = i;
        }
    }
    if (from < 0)
        return pm_fail(err, PM_NUMERIC, "no bridge to the hole at (%.6f, %.6f)", q[0], q[1]);
    const ptrdiff_t after = r->next[from];
    ptrdiff_t last = from;
    for (ptrdiff_t j = 0; j <= hole->n; j++) {
        const ptrdiff_t i = append(r, hole->node[m + j < hole->n ? m + j : m + j - hole->n]);
        link_corners(r, last, i);
        last = i;
    }
    const ptrdiff_t back = append(r, r->node[from]);
    link_corners(r, last, back);
    link_corners(r, back, after);
    return PM_OK;
}

/* ---- ears ---- */

/* Nodes on a straight line are off it by rounding, some 1e-15 of their distances; features of a
 * section are far larger than this part of them. */
static const double flat = 1e-10;

/* Shape of the ear at corner i: 4 sqrt 3 area / sum of squared edges, 1 for an equilateral one; -1
 * where it is none: flat, not convex, or a corner inside or on its rim. */
static double ear(const struct ring *r, ptrdiff_t i)
{
    const ptrdiff_t j = r->previous[i], k = r->next[i];
    const double *a = at(r, j), *b = at(r, i), *c = at(r, k);
    const double area2 = turn(a, b, c);
    const double square = (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                          (b[0] - c[0]) * (b[0] - c[0]) + (b[1] - c[1]) * (b[1] - c[1]) +
                          (c[0] - a[0]) * (c[0] - a[0]) + (c[1] - a[1]) * (c[1] - a[1]);
    const double least = -flat * square;
    if (!(area2 > -least))
        return -1;
    for (ptrdiff_t l = r->next[k]; l != j; l = r->next[l]) {
        const int32_t v = r->node[l];
        const double *p = at(r, l);
        if (v != r->node[i] && v != r->node[j] && v != r->node[k] && turn(a, b, p) >= least &&
            turn(b, c, p) >= least && turn(c, a, p) >= least)
            return -1;
    }
    return 2 * sqrt(3) * area2 / square;
}

static enum pm_status clip(struct ring *r, ptrdiff_t n, int32_t *tri, ptrdiff_t *nt,
                           struct pm_err *err)
{
    ptrdiff_t start = 0;
    for (ptrdiff_t i = 0; i < r->n; i++)
        r->quality[i] = ear(r, i);
    for (int fresh = 1; n > 2;) {
        ptrdiff_t best = start;
        for (ptrdiff_t k = 0, i = start; k < n; k++, i = r->next[i])
            if (r->quality[i] > r->quality[best])
                best = i;
        if (r->quality[best] < 0) {
            if (fresh)
                return pm_fail(err, PM_NUMERIC, "the outline crosses itself near (%.6f, %.6f)",
                               at(r, best)[0], at(r, best)[1]);
            for (ptrdiff_t k = 0, i = start; k < n; k++, i = r->next[i])
                r->quality[i] = ear(r, i);
            fresh = 1;
            continue;
        }
        const ptrdiff_t a = r->previous[best], c = r->next[best];
        const int32_t t[3] = {r->node[a], r->node[best], r->node[c]};
        memcpy(tri + 3 * (*nt)++, t, sizeof t);
        link_corners(r, a, c);
        start = a;
        n--;
        r->quality[a] = ear(r, a);
        r->quality[c] = ear(r, c);
        fresh = 0;
    }
    return PM_OK;
}

struct order {
    double right;
    ptrdiff_t loop;
};

static int from_right(const void *a, const void *b)
{
    const struct order *p = a, *q = b;
    return p->right != q->right ? (p->right < q->right ? 1 : -1)
                                : (p->loop > q->loop) - (p->loop < q->loop);
}

static enum pm_status ring_init(struct ring *r, const struct ears_loop *loop, ptrdiff_t nloops,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t l = 0; l < nloops; l++)
        r->capacity += loop[l].n + 2;
    PM_TRY(PM_NEW(r->node, r->capacity, err));
    PM_TRY(PM_NEW(r->next, r->capacity, err));
    PM_TRY(PM_NEW(r->previous, r->capacity, err));
    PM_TRY(PM_NEW(r->quality, r->capacity, err));
    for (ptrdiff_t j = 0; j < loop[0].n; j++)
        append(r, loop[0].node[j]);
    for (ptrdiff_t j = 0; j < r->n; j++)
        link_corners(r, j, (j + 1) % r->n);
done:
    return status;
}

enum pm_status ears_clip(const struct ears_loop *loop, ptrdiff_t nloops, const double *uv,
                         int32_t *tri, ptrdiff_t *nt, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct ring r = {.uv = uv};
    struct order *order = NULL;
    struct ears_loop *hole = NULL;
    PM_TRY(ring_init(&r, loop, nloops, err));
    PM_TRY(PM_NEW(order, nloops, err));
    PM_TRY(PM_NEW(hole, nloops, err));
    for (ptrdiff_t l = 1; l < nloops; l++)
        order[l - 1] = (struct order){uv[2 * loop[l].node[rightmost(&loop[l], uv)]], l};
    if (nloops > 1)
        qsort(order, (size_t)(nloops - 1), sizeof *order, from_right);
    for (ptrdiff_t h = 0; h + 1 < nloops; h++)
        hole[h] = loop[order[h].loop];
    for (ptrdiff_t h = 0; h + 1 < nloops; h++)
        PM_TRY(bridge(&r, hole + h, nloops - 1 - h, err));
    PM_TRY(clip(&r, r.n, tri, nt, err));
done:
    pm_free(r.node);
    pm_free(r.next);
    pm_free(r.previous);
    pm_free(r.quality);
    pm_free(order);
    pm_free(hole);
    return status;
}
