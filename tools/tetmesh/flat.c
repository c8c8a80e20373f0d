#include "tools/tetmesh/flat.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "tools/tetmesh/volume_gmsh.h"

/* Edges in the plane of coordinates u and v, counter-clockwise seen from outside the body. */
struct plane {
    int u, v, across; /* axes */
    double at;        /* coordinate `across` [mm] */
    int32_t tag;
    int turned; /* the outside is on the side of -(u x v) */
};

/* Nodes of the shell along a closed outline. */
struct loops {
    int32_t *node; /* (n) */
    ptrdiff_t n, count;
    ptrdiff_t first[PM_MAX_CHAMBERS + 2]; /* (count + 1) */
};

/* ---- meshing ---- */

static enum pm_status fill(struct pm_shell *s, const struct loops *l, const struct plane *p,
                           double size, double timeout, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_planar face = {0};
    double *x = NULL;
    PM_TRY(PM_NEW(x, 2 * l->n, err));
    for (ptrdiff_t k = 0; k < l->n; k++) {
        x[2 * k] = s->x[3 * l->node[k] + p->u];
        x[2 * k + 1] = s->x[3 * l->node[k] + p->v];
    }
    const struct pm_outline outline = {l->n, l->count, x, l->first};
    PM_TRY(pm_gmsh_planar(&outline, size, timeout, &face, err));
    const ptrdiff_t inner = face.nn - l->n;
    PM_TRY(pm_shell_grow(s, inner, face.nt, err));
    for (ptrdiff_t a = 0; a < inner; a++) {
        double *to = s->x + 3 * (s->nn + a);
        to[p->u] = face.x[2 * (l->n + a)];
        to[p->v] = face.x[2 * (l->n + a) + 1];
        to[p->across] = p->at;
        memset(s->S + 3 * (s->nn + a), 0, 3 * sizeof *s->S);
        s->size[s->nn + a] = size;
        s->surface[s->nn + a] = -1;
    }
    for (ptrdiff_t t = 0; t < face.nt; t++) {
        for (int k = 0; k < 3; k++) {
            const int32_t a = face.tri[3 * t + (p->turned ? 2 - k : k)];
            s->tri[3 * (s->nt + t) + k] = a < l->n ? l->node[a] : (int32_t)(s->nn + a - l->n);
        }
        s->tag[s->nt + t] = p->tag;
    }
    s->nn += inner;
    s->nt += face.nt;
done:
    pm_free(x);
    pm_free(face.x);
    pm_free(face.tri);
    return status;
}

/* New nodes on the straight line from a to b [mm], about `size` apart, ends excluded. */
static enum pm_status add_line(struct pm_shell *s, const double *from, const double *to,
                               double size, struct pm_err *err)
{
    double length = 0;
    const double a[3] = {from[0], from[1], from[2]}, b[3] = {to[0], to[1], to[2]};
    for (int i = 0; i < 3; i++)
        length += (b[i] - a[i]) * (b[i] - a[i]);
    const ptrdiff_t n = (ptrdiff_t)fmax(1, round(sqrt(length) / size));
    if (pm_shell_grow(s, n - 1, 0, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t k = 1; k < n; k++, s->nn++) {
        const double t = (double)k / (double)n;
        for (int i = 0; i < 3; i++)
            s->x[3 * s->nn + i] = a[i] + t * (b[i] - a[i]);
        memset(s->S + 3 * s->nn, 0, 3 * sizeof *s->S);
        s->size[s->nn] = size;
        s->surface[s->nn] = -1;
    }
    return PM_OK;
}

/* ---- caps ---- */

struct rim_node {
    double angle;
    int32_t id;
};

static int by_angle(const void *a, const void *b)
{
    const struct rim_node *p = a, *q = b;
    return (p->angle > q->angle) - (p->angle < q->angle);
}

/* Nodes of one rim counter-clockwise; the exterior is the first patch, so ids are those of the
 * shell. */
static enum pm_status find_rim(const struct pm_patch *p, int rim, struct rim_node **out,
                               ptrdiff_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t count = 0;
    struct rim_node *r = NULL;
    PM_TRY(PM_NEW(r, p->nn, err));
    for (ptrdiff_t a = 0; a < p->nn; a++)
        if ((p->rim[a] & 3) == rim)
            r[count++] = (struct rim_node){atan2(p->S[3 * a + 1], p->S[3 * a]), (int32_t)a};
    qsort(r, (size_t)count, sizeof *r, by_angle);
    for (ptrdiff_t k = 1; k < count; k++)
        if (fabs(p->x[3 * r[k].id + 2] - p->x[3 * r[0].id + 2]) >
            1e-9 * fmax(1, fabs(p->x[3 * r[0].id + 2])))
            PM_TRY(pm_fail(
                err, PM_INPUT, "the rim of the exterior at the %s is not planar: z = %g and %g",
                rim == 1 ? "base" : "tip", p->x[3 * r[0].id + 2], p->x[3 * r[k].id + 2]));
done:
    *out = r;
    *n = count;
    return status;
}

/* The arc of the rim is closed along the mirror planes: past the z axis where there are two. */
static enum pm_status close_arc(struct pm_shell *s, int32_t first, int32_t last, double z,
                                double size, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double axis[3] = {0, 0, z};
    if (s->planes == 0)
        return PM_OK;
    if (s->planes != 3)
        return add_line(s, s->x + 3 * last, s->x + 3 * first, size, err);
    PM_TRY(add_line(s, s->x + 3 * last, axis, size, err));
    PM_TRY(pm_shell_grow(s, 1, 0, err));
    memcpy(s->x + 3 * s->nn, axis, sizeof axis);
    memset(s->S + 3 * s->nn, 0, 3 * sizeof *s->S);
    s->size[s->nn] = size;
    s->surface[s->nn++] = -1;
    PM_TRY(add_line(s, axis, s->x + 3 * first, size, err));
done:
    return status;
}

enum pm_status pm_flat_cap(struct pm_shell *s, const struct pm_patch *exterior, int rim,
                           double size, double timeout, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct rim_node *r = NULL;
    struct loops l = {.count = 1};
    ptrdiff_t n = 0;
    PM_TRY(find_rim(exterior, rim, &r, &n, err));
    const double z = s->x[3 * r[0].id + 2];
    const ptrdiff_t before = s->nn;
    PM_TRY(close_arc(s, r[0].id, r[n - 1].id, z, size, err));
    l.n = l.first[1] = n + s->nn - before;
    PM_TRY(PM_NEW(l.node, l.n, err));
    for (ptrdiff_t k = 0; k < l.n; k++)
        l.node[k] = k < n ? r[k].id : (int32_t)(before + k - n);
    const struct plane p = {.u = 0,
                            .v = 1,
                            .across = 2,
                            .at = z,
                            .tag = rim == 1 ? PM_FACE_BASE : PM_FACE_TIP,
                            .turned = rim == 1};
    PM_TRY(fill(s, &l, &p, size, timeout, err));
done:
    pm_free(r);
    pm_free(l.node);
    return status;
}

/* ---- cuts ---- */

/* Follower of every node on the edge of the face, -1 elsewhere; each may have one only. */
static enum pm_status follow(int32_t *next, int32_t a, int32_t b, const struct pm_shell *s,
                             struct pm_err *err)
{
    if (next[a] >= 0)
        return pm_fail(err, PM_NUMERIC,
                       "the surfaces touch themselves at a mirror plane, at (%.3f, %.3f, %.3f) mm",
                       s->x[3 * a], s->x[3 * a + 1], s->x[3 * a + 2]);
    next[a] = b;
    return PM_OK;
}

/* Edges of the surfaces on the plane, against the direction that they have out of the body. */
static enum pm_status find_edges(const struct pm_shell *s, const struct plane *p, int32_t *next,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t t = 0; t < s->nt; t++)
        for (int k = 0; k < 3; k++) {
            const int32_t a = s->tri[3 * t + k], b = s->tri[3 * t + (k + 1) % 3];
            if (s->tag[t] <= PM_FACE_SYM_X || s->x[3 * a + p->across] != 0 ||
                s->x[3 * b + p->across] != 0)
                continue;
            const int chamber = s->tag[t] > 0; /* its triangles look into the body */
            PM_TRY(follow(next, chamber ? a : b, chamber ? b : a, s, err));
        }
done:
    return status;
}

struct on_axis {
    double z;
    int32_t id;
};

static int by_height(const void *a, const void *b)
{
    const struct on_axis *p = a, *q = b;
    return (p->z > q->z) - (p->z < q->z);
}

/* The solid parts of the z axis as edges, upwards: between base and tip or the chambers on it. */
static enum pm_status divide_axis(struct pm_shell *s, double size, int32_t **out, ptrdiff_t *n,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct on_axis at[2 * PM_MAX_CHAMBERS + 2] = {{0, 0}};
    ptrdiff_t count = 0, most = 0;
    int32_t *edge = NULL;
    *n = 0;
    for (ptrdiff_t a = 0; a < s->nn; a++) {
        if (s->x[3 * a] != 0 || s->x[3 * a + 1] != 0)
            continue;
        if (count == 2 * PM_MAX_CHAMBERS + 2)
            PM_TRY(pm_fail(err, PM_NUMERIC, "the surfaces meet the z axis too often"));
        at[count++] = (struct on_axis){s->x[3 * a + 2], (int32_t)a};
    }
    if (count % 2 != 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "the surfaces meet the z axis %td times", count));
    qsort(at, (size_t)count, sizeof at[0], by_height);
    for (ptrdiff_t k = 0; k < count; k += 2) {
        const double from[3] = {0, 0, at[k].z}, to[3] = {0, 0, at[k + 1].z};
        const ptrdiff_t before = s->nn;
        PM_TRY(add_line(s, from, to, size, err));
        most += 2 * (s->nn - before + 1);
        int32_t *grown = pm_realloc(edge, most, sizeof *edge, err);
        if (grown == NULL) {
            status = PM_SYSTEM;
            goto done;
        }
        edge = grown;
        for (ptrdiff_t a = before; a <= s->nn; a++) {
            edge[2 * *n] = a == before ? at[k].id : (int32_t)(a - 1);
            edge[2 * *n + 1] = a == s->nn ? at[k + 1].id : (int32_t)a;
            ++*n;
        }
    }
done:
    *out = edge;
    return status;
}

static double area(const struct pm_shell *s, const struct plane *p, const int32_t *node,
                   ptrdiff_t n)
{
    double sum = 0;
    for (ptrdiff_t k = 0; k < n; k++) {
        const double *a = s->x + 3 * node[k], *b = s->x + 3 * node[(k + 1) % n];
        sum += (a[p->u] * b[p->v] - a[p->v] * b[p->u]) / 2;
    }
    return p->turned ? -sum : sum;
}

static void reverse(int32_t *node, ptrdiff_t n)
{
    for (ptrdiff_t k = 0; k < n / 2; k++) {
        const int32_t a = node[k];
        node[k] = node[n - 1 - k];
        node[n - 1 - k] = a;
    }
}

/* Chains the edges; the one loop around the body comes first. */
static enum pm_status chain(const struct pm_shell *s, const struct plane *p, int32_t *next,
                            struct loops *l, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *outer = NULL;
    ptrdiff_t at = 0, nouter = 0;
    PM_TRY(PM_NEW(l->node, s->nn, err));
    PM_TRY(PM_NEW(outer, s->nn, err));
    for (ptrdiff_t start = 0; start < s->nn; start++) {
        ptrdiff_t n = 0;
        for (int32_t a = (int32_t)start, b; next[a] >= 0; a = b) {
            l->node[at + n++] = a;
            b = next[a];
            next[a] = -1;
            if (next[b] < 0 && b != start)
                PM_TRY(pm_fail(err, PM_NUMERIC, "the surfaces are open at %s",
                               p->across == 0 ? "x = 0" : "y = 0"));
        }
        if (n == 0)
            continue;
        const int around = area(s, p, l->node + at, n) > 0;
        if (around ? nouter > 0 : l->count == PM_MAX_CHAMBERS)
            PM_TRY(pm_fail(err, PM_INPUT, "the body is in parts at the plane %c = 0",
                           "xy"[p->across]));
        if (p->turned)
            reverse(l->node + at, n);
        if (around) {
            memcpy(outer, l->node + at, (size_t)n * sizeof *outer);
            nouter = n;
            continue;
        }
        at += n;
        l->first[++l->count] = at;
    }
    memmove(l->node + nouter, l->node, (size_t)at * sizeof *l->node);
    memcpy(l->node, outer, (size_t)nouter * sizeof *outer);
    for (ptrdiff_t k = l->count; k >= 0; k--)
        l->first[k + 1] = l->first[k] + nouter;
    l->count++;
    l->n = at + nouter;
done:
    pm_free(outer);
    return status;
}

static enum pm_status cut(struct pm_shell *s, int axis, const int32_t *edge, ptrdiff_t nedges,
                          double size, double timeout, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    /* y = 0: x x z looks out of the body; x = 0: y x z looks into it */
    const struct plane p = {
        .u = 1 - axis, .v = 2, .across = axis, .tag = PM_FACE_SYM_X - axis, .turned = axis == 0};
    struct loops l = {.count = 0};
    int32_t *next = NULL;
    PM_TRY(PM_NEW(next, s->nn, err));
    memset(next, 0xff, (size_t)s->nn * sizeof *next);
    PM_TRY(find_edges(s, &p, next, err));
    for (ptrdiff_t k = 0; k < nedges; k++) /* seen from outside, the body is right of it at y = 0 */
        PM_TRY(follow(next, edge[2 * k + (axis == 1)], edge[2 * k + (axis == 0)], s, err));
    PM_TRY(chain(s, &p, next, &l, err));
    PM_TRY(fill(s, &l, &p, size, timeout, err));
done:
    pm_free(next);
    pm_free(l.node);
    return status;
}

enum pm_status pm_flat_cuts(struct pm_shell *s, double size, double timeout, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *edge = NULL;
    ptrdiff_t nedges = 0;
    if (s->planes == 3)
        PM_TRY(divide_axis(s, size, &edge, &nedges, err));
    for (int axis = 0; axis < 2; axis++)
        if (s->planes >> axis & 1)
            PM_TRY(cut(s, axis, edge, nedges, size, timeout, err));
done:
    pm_free(edge);
    return status;
}
