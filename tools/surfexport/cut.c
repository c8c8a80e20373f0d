#include "tools/surfexport/cut.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory.h"

struct crossing {
    int32_t low, high;
    int32_t node; /* of the result */
};

struct cut {
    const struct skin *s;
    struct skin *to;
    double *d;   /* signed distance into the kept side, 0 in the plane (nn) */
    int32_t *id; /* 1 + node of the result, 0: not yet (nn) */
    struct crossing *crossing;
    ptrdiff_t n;
    int axis;
    double value;
};

static int by_nodes(const void *a, const void *b)
{
    const struct crossing *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    return (e->high > f->high) - (e->high < f->high);
}

static enum pm_status find_crossings(struct cut *c, struct pm_err *err)
{
    const struct skin *s = c->s;
    ptrdiff_t n = 0;
    c->crossing = pm_calloc(3 * s->nt, sizeof *c->crossing, err);
    if (c->crossing == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t i = 0; i < 3 * s->nt; i++) {
        const int32_t a = s->tri[i], b = s->tri[i - i % 3 + (i + 1) % 3];
        if (c->d[a] * c->d[b] < 0)
            c->crossing[n++] = (struct crossing){a < b ? a : b, a < b ? b : a, -1};
    }
    if (n > 0)
        qsort(c->crossing, (size_t)n, sizeof *c->crossing, by_nodes);
    for (ptrdiff_t i = 0; i < n; i++)
        if (i == 0 || by_nodes(&c->crossing[i], &c->crossing[i - 1]) != 0)
            c->crossing[c->n++] = c->crossing[i];
    return PM_OK;
}

static enum pm_status add_crossings(struct cut *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t k = 0; k < c->n; k++) {
        struct crossing *e = &c->crossing[k];
        const double *p = c->s->x + 3 * (ptrdiff_t)e->low, *q = c->s->x + 3 * (ptrdiff_t)e->high;
        const double t = c->d[e->low] / (c->d[e->low] - c->d[e->high]);
        double x[3];
        for (int i = 0; i < 3; i++)
            x[i] = p[i] + t * (q[i] - p[i]);
        x[c->axis] = c->value;
        e->node = (int32_t)c->to->nn;
        PM_TRY(skin_add_node(c->to, x, c->s->surface[e->low], err));
    }
done:
    return status;
}

/* Node a of the result. */
static enum pm_status keep(struct cut *c, int32_t a, int32_t *node, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double x[3];
    for (int i = 0; i < 3; i++)
        x[i] = c->s->x[3 * a + i];
    if (c->d[a] == 0)
        x[c->axis] = c->value;
    if (c->id[a] == 0) {
        PM_TRY(skin_add_node(c->to, x, c->s->surface[a], err));
        c->id[a] = (int32_t)c->to->nn;
    }
    *node = c->id[a] - 1;
done:
    return status;
}

static double square(const struct skin *s, int32_t a, int32_t b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (s->x[3 * a + i] - s->x[3 * b + i]) * (s->x[3 * a + i] - s->x[3 * b + i]);
    return sum;
}

/* The kept part of one triangle: nothing, a triangle or a quadrangle, cut along its shorter
 * diagonal. */
static enum pm_status clip(struct cut *c, ptrdiff_t t, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int32_t *v = c->s->tri + 3 * t, tag = c->s->tag[t];
    int32_t p[4];
    int n = 0;
    if (!(c->d[v[0]] > 0 || c->d[v[1]] > 0 || c->d[v[2]] > 0))
        return PM_OK;
    for (int k = 0; k < 3; k++) {
        const int32_t a = v[k], b = v[(k + 1) % 3];
        if (c->d[a] >= 0)
            PM_TRY(keep(c, a, &p[n++], err));
        if (c->d[a] * c->d[b] < 0) {
            const struct crossing key = {a < b ? a : b, a < b ? b : a, 0};
            const struct crossing *e =
                bsearch(&key, c->crossing, (size_t)c->n, sizeof key, by_nodes);
            p[n++] = e->node;
        }
    }
    const int turn = n == 4 && square(c->to, p[1], p[3]) < square(c->to, p[0], p[2]);
    PM_TRY(skin_add_triangle(c->to, p[turn], p[turn + 1], p[turn + 2], tag, err));
    if (n == 4)
        PM_TRY(skin_add_triangle(c->to, p[turn], p[turn + 2], p[(turn + 3) % 4], tag, err));
done:
    return status;
}

enum pm_status skin_cut(const struct skin *s, int axis, double value, int sense, double snap,
                        struct skin *to, struct pm_err *err)
{
    enum pm_status status;
    struct cut c = {.s = s, .to = to, .axis = axis, .value = value};
    PM_TRY(PM_NEW(c.d, s->nn, err));
    PM_TRY(PM_NEW(c.id, s->nn, err));
    for (ptrdiff_t a = 0; a < s->nn; a++) {
        const double d = sense * (s->x[3 * a + axis] - value);
        c.d[a] = fabs(d) <= snap ? 0 : d;
    }
    PM_TRY(find_crossings(&c, err));
    PM_TRY(add_crossings(&c, err));
    for (ptrdiff_t t = 0; t < s->nt; t++)
        PM_TRY(clip(&c, t, err));
done:
    pm_free(c.d);
    pm_free(c.id);
    pm_free(c.crossing);
    return status;
}
