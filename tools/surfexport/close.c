#include "tools/surfexport/close.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "tools/surfexport/ears.h"

void skin_loops_release(struct skin_loops *loops)
{
    pm_free(loops->first);
    pm_free(loops->node);
    *loops = (struct skin_loops){0};
}

/* Directed edges, at most one into and one out of a node; -1: none. */
struct chain {
    ptrdiff_t nn;
    int32_t *next, *previous; /* (nn) */
};

static void chain_release(struct chain *c)
{
    pm_free(c->next);
    pm_free(c->previous);
}

static enum pm_status join(struct chain *c, const struct skin *s, int32_t a, int32_t b,
                           struct pm_err *err)
{
    if (c->next[a] >= 0 || c->previous[b] >= 0) {
        const double *x = s->x + 3 * (ptrdiff_t)(c->next[a] >= 0 ? a : b);
        return pm_fail(err, PM_NUMERIC, "a section touches itself at (%.3f, %.3f, %.3f) mm", x[0],
                       x[1], x[2]);
    }
    c->next[a] = b;
    c->previous[b] = a;
    return PM_OK;
}

/* The open edges in the plane, reversed where wanted. */
static enum pm_status chain_init(struct chain *c, const struct skin *s, int axis, double value,
                                 int reverse, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *open = NULL;
    ptrdiff_t n = 0;
    c->nn = s->nn;
    PM_TRY(PM_NEW(c->next, s->nn, err));
    PM_TRY(PM_NEW(c->previous, s->nn, err));
    for (ptrdiff_t a = 0; a < s->nn; a++)
        c->next[a] = c->previous[a] = -1;
    PM_TRY(skin_open_edges(s, &open, &n, err));
    for (ptrdiff_t e = 0; e < n; e++) {
        const int32_t a = open[2 * e + reverse], b = open[2 * e + 1 - reverse];
        if (s->x[3 * a + axis] == value && s->x[3 * b + axis] == value)
            PM_TRY(join(c, s, a, b, err));
    }
done:
    pm_free(open);
    return status;
}

/* ---- ends of chains ---- */

struct end {
    double along;
    int32_t node;
};

static int by_place(const void *a, const void *b)
{
    const struct end *p = a, *q = b;
    return p->along != q->along ? (p->along < q->along ? -1 : 1)
                                : (p->node > q->node) - (p->node < q->node);
}

/* The axis along which the ends lie on a line, -1 where they do not. */
static int line_axis(const struct skin *s, const struct end *e, ptrdiff_t n, int axis)
{
    for (int turn = 1; turn < 3; turn++) {
        const int along = (axis + turn) % 3, across = (axis + 3 - turn) % 3;
        ptrdiff_t k = 1;
        while (k < n && s->x[3 * e[k].node + across] == s->x[3 * e[0].node + across])
            k++;
        if (k == n)
            return along;
    }
    return -1;
}

static enum pm_status join_ends(struct chain *c, const struct skin *s, int axis, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct end *e = NULL;
    ptrdiff_t n = 0;
    PM_TRY(PM_NEW(e, c->nn, err));
    for (ptrdiff_t a = 0; a < c->nn; a++)
        if ((c->next[a] < 0) != (c->previous[a] < 0))
            e[n++].node = (int32_t)a;
    if (n == 0)
        goto done;
    const int along = line_axis(s, e, n, axis);
    if (along < 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "a section is open at (%.3f, %.3f, %.3f) mm",
                       s->x[3 * e[0].node], s->x[3 * e[0].node + 1], s->x[3 * e[0].node + 2]));
    for (ptrdiff_t k = 0; k < n; k++)
        e[k].along = s->x[3 * e[k].node + along];
    qsort(e, (size_t)n, sizeof *e, by_place);
    for (ptrdiff_t k = 0; k + 1 < n; k += 2) {
        const int forward = c->next[e[k].node] < 0;
        PM_TRY(join(c, s, e[k + !forward].node, e[k + forward].node, err));
    }
done:
    pm_free(e);
    return status;
}

/* ---- loops ---- */

static enum pm_status take_loops(const struct chain *c, struct skin_loops *l, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    uint8_t *seen = NULL;
    ptrdiff_t n = 0;
    PM_TRY(PM_NEW(seen, c->nn, err));
    PM_TRY(PM_NEW(l->first, c->nn + 1, err));
    PM_TRY(PM_NEW(l->node, c->nn, err));
    for (ptrdiff_t a = 0; a < c->nn; a++) {
        if (c->next[a] < 0 || seen[a])
            continue;
        for (int32_t b = (int32_t)a; b >= 0 && !seen[b]; b = c->next[b]) {
            seen[b] = 1;
            l->node[n++] = b;
        }
        l->first[++l->n] = n;
    }
done:
    pm_free(seen);
    return status;
}

enum pm_status skin_find_loops(const struct skin *s, int axis, double value,
                               struct skin_loops *loops, struct pm_err *err)
{
    enum pm_status status;
    struct chain c = {0};
    PM_TRY(chain_init(&c, s, axis, value, 0, err));
    for (ptrdiff_t a = 0; a < s->nn; a++)
        if ((c.next[a] < 0) != (c.previous[a] < 0))
            PM_TRY(pm_fail(err, PM_NUMERIC, "a section is open at (%.3f, %.3f, %.3f) mm",
                           s->x[3 * a], s->x[3 * a + 1], s->x[3 * a + 2]));
    PM_TRY(take_loops(&c, loops, err));
done:
    chain_release(&c);
    return status;
}

double skin_loop_area(const struct skin *s, const struct skin_loops *loops, ptrdiff_t l, int axis)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double *o = s->x + 3 * (ptrdiff_t)loops->node[loops->first[l]];
    double sum = 0;
    for (ptrdiff_t i = loops->first[l]; i + 1 < loops->first[l + 1]; i++) {
        const double *p = s->x + 3 * (ptrdiff_t)loops->node[i];
        const double *q = s->x + 3 * (ptrdiff_t)loops->node[i + 1];
        sum += (p[u] - o[u]) * (q[v] - o[v]) - (p[v] - o[v]) * (q[u] - o[u]);
    }
    return sum / 2;
}

int skin_loop_contains(const struct skin *s, const struct skin_loops *loops, ptrdiff_t l, int axis,
                       const double *p)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int inside = 0;
    for (ptrdiff_t i = loops->first[l]; i < loops->first[l + 1]; i++) {
        const ptrdiff_t j = i + 1 < loops->first[l + 1] ? i + 1 : loops->first[l];
        const double *a = s->x + 3 * (ptrdiff_t)loops->node[i];
        const double *b = s->x + 3 * (ptrdiff_t)loops->node[j];
        if ((a[v] > p[v]) != (b[v] > p[v]) &&
            p[u] < a[u] + (b[u] - a[u]) * (p[v] - a[v]) / (b[v] - a[v]))
            inside = !inside;
    }
    return inside;
}

/* ---- faces ---- */

struct face {
    const struct skin *s;
    struct skin_loops loops;
    double *area; /* of the loops seen against the outward normal: < 0 is a hole */
    ptrdiff_t *outer;
    double *uv; /* (nn x 2) */
    int32_t *tri;
    ptrdiff_t nt;
    int axis;
};

static enum pm_status nest(struct face *f, struct pm_err *err)
{
    for (ptrdiff_t l = 0; l < f->loops.n; l++) {
        const double *p = f->s->x + 3 * (ptrdiff_t)f->loops.node[f->loops.first[l]];
        f->outer[l] = f->area[l] > 0 ? l : -1;
        for (ptrdiff_t k = 0; k < f->loops.n && !(f->area[l] > 0); k++)
            if (f->area[k] > 0 && skin_loop_contains(f->s, &f->loops, k, f->axis, p) &&
                (f->outer[l] < 0 || f->area[k] < f->area[f->outer[l]]))
                f->outer[l] = k;
        if (f->outer[l] < 0)
            return pm_fail(err, PM_NUMERIC,
                           "a section has a hole outside of it at (%.3f, %.3f, %.3f) mm", p[0],
                           p[1], p[2]);
    }
    return PM_OK;
}

static enum pm_status fill(struct face *f, ptrdiff_t outer, struct ears_loop *loop,
                           struct pm_err *err)
{
    enum pm_status status;
    const struct skin_loops *l = &f->loops;
    const ptrdiff_t before = f->nt;
    double want = 0, sum = 0;
    ptrdiff_t n = 1;
    for (ptrdiff_t k = 0; k < l->n; k++) {
        if (f->outer[k] != outer)
            continue;
        loop[k == outer ? 0 : n++] =
            (struct ears_loop){l->first[k + 1] - l->first[k], l->node + l->first[k]};
        want += f->area[k];
    }
    PM_TRY(ears_clip(loop, n, f->uv, f->tri, &f->nt, err));
    for (ptrdiff_t t = before; t < f->nt; t++) {
        const double *a = f->uv + 2 * (ptrdiff_t)f->tri[3 * t];
        const double *b = f->uv + 2 * (ptrdiff_t)f->tri[3 * t + 1];
        const double *c = f->uv + 2 * (ptrdiff_t)f->tri[3 * t + 2];
        sum += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    }
    /* rounding, not an ear too many */
    if (!(fabs(sum - want) <= 1e-9 * want))
        PM_TRY(
            pm_fail(err, PM_NUMERIC, "a section of %.9g mm2 was filled with %.9g mm2", want, sum));
done:
    return status;
}

static enum pm_status face_init(struct face *f, int sense, struct pm_err *err)
{
    enum pm_status status;
    const int u = (f->axis + (sense > 0 ? 1 : 2)) % 3, v = (f->axis + (sense > 0 ? 2 : 1)) % 3;
    PM_TRY(PM_NEW(f->area, f->loops.n, err));
    PM_TRY(PM_NEW(f->outer, f->loops.n, err));
    PM_TRY(PM_NEW(f->uv, 2 * f->s->nn, err));
    PM_TRY(PM_NEW(f->tri, 3 * (f->loops.first[f->loops.n] + 2 * f->loops.n), err));
    for (ptrdiff_t a = 0; a < f->s->nn; a++) {
        f->uv[2 * a] = f->s->x[3 * a + u];
        f->uv[2 * a + 1] = f->s->x[3 * a + v];
    }
    for (ptrdiff_t l = 0; l < f->loops.n; l++)
        f->area[l] = sense * skin_loop_area(f->s, &f->loops, l, f->axis);
    PM_TRY(nest(f, err));
done:
    return status;
}

enum pm_status skin_close(struct skin *s, int axis, double value, int sense, int32_t tag,
                          struct pm_err *err)
{
    enum pm_status status;
    struct chain c = {0};
    struct face f = {.s = s, .axis = axis};
    struct ears_loop *loop = NULL;
    PM_TRY(chain_init(&c, s, axis, value, 1, err));
    PM_TRY(join_ends(&c, s, axis, err));
    PM_TRY(take_loops(&c, &f.loops, err));
    PM_TRY(face_init(&f, sense, err));
    PM_TRY(PM_NEW(loop, f.loops.n + 1, err));
    for (ptrdiff_t l = 0; l < f.loops.n; l++)
        if (f.outer[l] == l)
            PM_TRY(fill(&f, l, loop, err));
    for (ptrdiff_t t = 0; t < f.nt; t++)
        PM_TRY(skin_add_triangle(s, f.tri[3 * t], f.tri[3 * t + 1], f.tri[3 * t + 2], tag, err));
done:
    chain_release(&c);
    skin_loops_release(&f.loops);
    pm_free(f.area);
    pm_free(f.outer);
    pm_free(f.uv);
    pm_free(f.tri);
    pm_free(loop);
    return status;
}
