#include "tools/surfexport/skin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"

void skin_release(struct skin *s)
{
    pm_free(s->x);
    pm_free(s->curvature);
    pm_free(s->wall);
    pm_free(s->surface);
    pm_free(s->tri);
    pm_free(s->tag);
    *s = (struct skin){0};
}

const char *skin_tag_name(int32_t tag, char name[32])
{
    if (tag > 0)
        snprintf(name, 32, "chamber%d", (int)tag);
    else
        snprintf(name, 32, "%s",
                 tag == PM_FACE_EXTERIOR ? "exterior"
                 : tag == PM_FACE_BASE   ? "base"
                 : tag == PM_FACE_TIP    ? "tip"
                 : tag == SKIN_PRINT     ? "print"
                                         : "mould");
    return name;
}

enum pm_status skin_add_node(struct skin *s, const double x[3], int32_t surface, struct pm_err *err)
{
    if (s->nn == s->nodes) {
        const ptrdiff_t n = 2 * s->nodes + 64;
        PM_GROW(s->x, 3 * n, err);
        PM_GROW(s->curvature, n, err);
        PM_GROW(s->wall, n, err);
        PM_GROW(s->surface, n, err);
        s->nodes = n;
    }
    memcpy(s->x + 3 * s->nn, x, 3 * sizeof *x);
    s->curvature[s->nn] = s->wall[s->nn] = 0;
    s->surface[s->nn++] = surface;
    return PM_OK;
}

enum pm_status skin_add_triangle(struct skin *s, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c, int32_t tag,
                                 struct pm_err *err)
{
    if (s->nt == s->triangles) {
        const ptrdiff_t n = 2 * s->triangles + 64;
        PM_GROW(s->tri, 3 * n, err);
        PM_GROW(s->tag, n, err);
        s->triangles = n;
    }
    const int32_t v[3] = {(int32_t)a, (int32_t)b, (int32_t)c};
    memcpy(s->tri + 3 * s->nt, v, sizeof v);
    s->tag[s->nt++] = tag;
    return PM_OK;
}

enum pm_status skin_extract(const struct skin *from, int32_t low, int32_t high, struct skin *to,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *id = NULL;
    PM_TRY(PM_NEW(id, from->nn, err)); /* 1 + new number, 0: not yet */
    for (ptrdiff_t t = 0; t < from->nt; t++) {
        const int32_t *v = from->tri + 3 * t;
        if (from->tag[t] < low || from->tag[t] > high)
            continue;
        for (int k = 0; k < 3; k++) {
            if (id[v[k]] > 0)
                continue;
            PM_TRY(skin_add_node(to, from->x + 3 * (ptrdiff_t)v[k], from->surface[v[k]], err));
            to->curvature[to->nn - 1] = from->curvature[v[k]];
            to->wall[to->nn - 1] = from->wall[v[k]];
            id[v[k]] = (int32_t)to->nn;
        }
        PM_TRY(skin_add_triangle(to, id[v[0]] - 1, id[v[1]] - 1, id[v[2]] - 1, from->tag[t], err));
    }
done:
    pm_free(id);
    return status;
}

void skin_drop(struct skin *s, int32_t tag)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        if (s->tag[t] == tag)
            continue;
        memmove(s->tri + 3 * n, s->tri + 3 * t, 3 * sizeof *s->tri);
        s->tag[n++] = s->tag[t];
    }
    s->nt = n;
}

void skin_flip(struct skin *s, int32_t low, int32_t high)
{
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        if (s->tag[t] < low || s->tag[t] > high)
            continue;
        const int32_t v = s->tri[3 * t + 1];
        s->tri[3 * t + 1] = s->tri[3 * t + 2];
        s->tri[3 * t + 2] = v;
    }
}

void skin_normal(const struct skin *s, ptrdiff_t t, double n[3])
{
    const double *a = s->x + 3 * (ptrdiff_t)s->tri[3 * t];
    const double *b = s->x + 3 * (ptrdiff_t)s->tri[3 * t + 1];
    const double *c = s->x + 3 * (ptrdiff_t)s->tri[3 * t + 2];
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    for (int i = 0; i < 3; i++)
        n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

struct edge {
    int32_t low, high, triangle;
    int32_t up; /* 1: from low to high in the triangle */
};

static int by_nodes(const void *a, const void *b)
{
    const struct edge *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    if (e->high != f->high)
        return e->high < f->high ? -1 : 1;
    return (e->triangle > f->triangle) - (e->triangle < f->triangle);
}

static enum pm_status sorted_edges(const struct skin *s, struct edge **edges, struct pm_err *err)
{
    struct edge *e = pm_calloc(3 * s->nt, sizeof *e, err);
    if (e == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t i = 0; i < 3 * s->nt; i++) {
        const int32_t a = s->tri[i], b = s->tri[i - i % 3 + (i + 1) % 3];
        e[i] = (struct edge){a < b ? a : b, a < b ? b : a, (int32_t)(i / 3), a < b};
    }
    if (s->nt > 0)
        qsort(e, 3 * (size_t)s->nt, sizeof *e, by_nodes);
    *edges = e;
    return PM_OK;
}

enum pm_status skin_open_edges(const struct skin *s, int32_t **edge, ptrdiff_t *n,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct edge *e = NULL;
    int32_t *open = NULL;
    ptrdiff_t count = 0;
    PM_TRY(sorted_edges(s, &e, err));
    PM_TRY(PM_NEW(open, 6 * s->nt, err));
    for (ptrdiff_t i = 0, j = 0; i < 3 * s->nt; i = j) {
        for (j = i + 1; j < 3 * s->nt && e[j].low == e[i].low && e[j].high == e[i].high;)
            j++;
        const double *x = s->x + 3 * (ptrdiff_t)e[i].low;
        if (j - i > 2 || (j - i == 2 && e[i].up == e[i + 1].up))
            PM_TRY(pm_fail(err, PM_NUMERIC,
                           "the edge at (%.3f, %.3f, %.3f) mm has %td triangles that do not fit "
                           "together, expected two of opposite direction",
                           x[0], x[1], x[2], j - i));
        if (j - i == 1) {
            open[2 * count] = e[i].up ? e[i].low : e[i].high;
            open[2 * count++ + 1] = e[i].up ? e[i].high : e[i].low;
        }
    }
    *edge = open;
    *n = count;
    open = NULL;
done:
    pm_free(e);
    pm_free(open);
    return status;
}

static int same_in_single(const double *p, const double *q)
{
    return (float)p[0] == (float)q[0] && (float)p[1] == (float)q[1] && (float)p[2] == (float)q[2];
}

static enum pm_status check_single(const struct skin *s, struct pm_err *err)
{
    for (ptrdiff_t i = 0; i < 3 * s->nt; i++) {
        const double *p = s->x + 3 * (ptrdiff_t)s->tri[i];
        const double *q = s->x + 3 * (ptrdiff_t)s->tri[i - i % 3 + (i + 1) % 3];
        if (same_in_single(p, q))
            return pm_fail(err, PM_NUMERIC,
                           "two nodes at (%.6f, %.6f, %.6f) mm are one in single precision", p[0],
                           p[1], p[2]);
    }
    return PM_OK;
}

enum pm_status skin_check(const struct skin *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *open = NULL;
    ptrdiff_t n = 0;
    struct pm_contact c;
    char a[32], b[32];
    PM_TRY(skin_open_edges(s, &open, &n, err));
    if (n > 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "%td edges are open, the first at (%.3f, %.3f, %.3f) mm", n,
                       s->x[3 * open[0]], s->x[3 * open[0] + 1], s->x[3 * open[0] + 2]));
    PM_TRY(check_single(s, err));
    const double volume = pm_collide_volume(s->x, s->nt, s->tri);
    if (!(volume > 0))
        PM_TRY(pm_fail(err, PM_NUMERIC, "it encloses %g mm3, expected > 0", volume));
    PM_TRY(pm_collide_pierce(s->x, s->nt, s->tri, &c, err));
    if (c.a >= 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "%s cuts %s at (%.3f, %.3f, %.3f) mm",
                       skin_tag_name(s->tag[c.a], a), skin_tag_name(s->tag[c.b], b), c.at[0],
                       c.at[1], c.at[2]));
done:
    pm_free(open);
    return status;
}
