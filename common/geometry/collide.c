#include "common/geometry/collide.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory.h"

/* Bounding box of a triangle or a node, sorted by its lowest z. */
struct box {
    double lo[3], hi[3];
    ptrdiff_t id;
};

static int by_z(const void *a, const void *b)
{
    const struct box *p = a, *q = b;
    if (p->lo[2] != q->lo[2])
        return p->lo[2] < q->lo[2] ? -1 : 1;
    return p->id < q->id ? -1 : p->id > q->id;
}

static int overlap(const struct box *a, const struct box *b)
{
    for (int i = 0; i < 3; i++)
        if (a->hi[i] < b->lo[i] || b->hi[i] < a->lo[i])
            return 0;
    return 1;
}

static enum pm_status sorted_boxes(const double *x, ptrdiff_t nt, const int32_t *tri,
                                   struct box **boxes, struct pm_err *err)
{
    struct box *box = NULL;
    *boxes = NULL;
    if (PM_NEW(box, nt, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t t = 0; t < nt; t++) {
        const int32_t *v = tri + 3 * t;
        for (int i = 0; i < 3; i++) {
            const double a = x[3 * v[0] + i], b = x[3 * v[1] + i], c = x[3 * v[2] + i];
            box[t].lo[i] = fmin(a, fmin(b, c));
            box[t].hi[i] = fmax(a, fmax(b, c));
        }
        box[t].id = t;
    }
    qsort(box, (size_t)nt, sizeof *box, by_z);
    *boxes = box;
    return PM_OK;
}

/* Six times the signed volume of (a, b, c, d). */
static double orient(const double *a, const double *b, const double *c, const double *d)
{
    const double u[3] = {a[0] - d[0], a[1] - d[1], a[2] - d[2]};
    const double v[3] = {b[0] - d[0], b[1] - d[1], b[2] - d[2]};
    const double w[3] = {c[0] - d[0], c[1] - d[1], c[2] - d[2]};
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Does the segment p q pass through the triangle a b c? Touching does not count. */
static int pierces(const double *p, const double *q, const double *a, const double *b,
                   const double *c, double at[3])
{
    const double dp = orient(a, b, c, p), dq = orient(a, b, c, q);
    if (!(dp * dq < 0))
        return 0;
    const double s1 = orient(p, q, a, b), s2 = orient(p, q, b, c), s3 = orient(p, q, c, a);
    if (!((s1 > 0 && s2 > 0 && s3 > 0) || (s1 < 0 && s2 < 0 && s3 < 0)))
        return 0;
    for (int i = 0; i < 3; i++)
        at[i] = p[i] + (q[i] - p[i]) * dp / (dp - dq);
    return 1;
}

static int contains(const int32_t *v, int32_t a)
{
    return v[0] == a || v[1] == a || v[2] == a;
}

static int edges_pierce(const double *x, const int32_t *v, const int32_t *w, double at[3])
{
    for (int k = 0; k < 3; k++) {
        const int32_t p = v[k], q = v[(k + 1) % 3];
        if (!contains(w, p) && !contains(w, q) &&
            pierces(x + 3 * p, x + 3 * q, x + 3 * w[0], x + 3 * w[1], x + 3 * w[2], at))
            return 1;
    }
    return 0;
}

enum pm_status pm_collide_pierce(const double *x, ptrdiff_t nt, const int32_t *tri,
                                 struct pm_contact *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct box *box = NULL;
    *c = (struct pm_contact){.a = -1, .b = -1};
    PM_TRY(sorted_boxes(x, nt, tri, &box, err));
    for (ptrdiff_t i = 0; i < nt; i++) {
        for (ptrdiff_t j = i + 1; j < nt && box[j].lo[2] <= box[i].hi[2]; j++) {
            const int32_t *v = tri + 3 * box[i].id, *w = tri + 3 * box[j].id;
            if (!overlap(&box[i], &box[j]))
                continue;
            const int shared = contains(w, v[0]) + contains(w, v[1]) + contains(w, v[2]);
            if (shared < 2 && (edges_pierce(x, v, w, c->at) || edges_pierce(x, w, v, c->at))) {
                c->a = box[i].id;
                c->b = box[j].id;
                goto done;
            }
        }
    }
done:
    pm_free(box);
    return status;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Distance from p to the segment a b. */
static double to_segment(const double *p, const double *a, const double *b)
{
    double d[3], e[3];
    for (int i = 0; i < 3; i++) {
        d[i] = b[i] - a[i];
        e[i] = p[i] - a[i];
    }
    const double dd = dot(d, d);
    const double t = dd > 0 ? fmin(fmax(dot(d, e) / dd, 0), 1) : 0;
    for (int i = 0; i < 3; i++)
        e[i] -= t * d[i];
    return sqrt(dot(e, e));
}

static double to_triangle(const double *p, const double *a, const double *b, const double *c)
{
    double u[3], v[3], w[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
        w[i] = p[i] - a[i];
    }
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double det = uu * vv - uv * uv;
    if (det > 0) {
        const double s = (vv * uw - uv * vw) / det, t = (uu * vw - uv * uw) / det;
        if (s >= 0 && t >= 0 && s + t <= 1) {
            for (int i = 0; i < 3; i++)
                w[i] -= s * u[i] + t * v[i];
            return sqrt(dot(w, w));
        }
    }
    return fmin(to_segment(p, a, b), fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

enum pm_status pm_collide_near(ptrdiff_t nn, const double *x, const double *limit, ptrdiff_t nt,
                               const int32_t *tri, struct pm_contact *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct box *box = NULL, *node = NULL;
    double best = 1;
    *c = (struct pm_contact){.a = -1, .b = -1};
    PM_TRY(sorted_boxes(x, nt, tri, &box, err));
    PM_TRY(PM_NEW(node, nn, err));
    for (ptrdiff_t a = 0; a < nn; a++) {
        node[a].id = a;
        for (int i = 0; i < 3; i++) {
            node[a].lo[i] = x[3 * a + i] - limit[a];
            node[a].hi[i] = x[3 * a + i] + limit[a];
        }
    }
    qsort(node, (size_t)nn, sizeof *node, by_z);
    double tallest = 0;
    for (ptrdiff_t t = 0; t < nt; t++)
        tallest = fmax(tallest, box[t].hi[2] - box[t].lo[2]);
    ptrdiff_t first = 0;
    for (ptrdiff_t k = 0; k < nn; k++) {
        const ptrdiff_t a = node[k].id;
        while (first < nt && box[first].lo[2] < node[k].lo[2] - tallest)
            first++;
        for (ptrdiff_t j = first; limit[a] > 0 && j < nt && box[j].lo[2] <= node[k].hi[2]; j++) {
            const int32_t *v = tri + 3 * box[j].id;
            if (!overlap(&node[k], &box[j]) || contains(v, (int32_t)a))
                continue;
            const double d = to_triangle(x + 3 * a, x + 3 * v[0], x + 3 * v[1], x + 3 * v[2]);
            if (d < best * limit[a]) {
                best = d / limit[a];
                *c = (struct pm_contact){a, box[j].id, {x[3 * a], x[3 * a + 1], x[3 * a + 2]}, d};
            }
        }
    }
done:
    pm_free(box);
    pm_free(node);
    return status;
}

double pm_collide_winding(const double p[3], const double *x, ptrdiff_t nt, const int32_t *tri)
{
    double sum = 0;
    for (ptrdiff_t t = 0; t < nt; t++) {
        double r[3][3], l[3];
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++)
                r[k][i] = x[3 * tri[3 * t + k] + i] - p[i];
            l[k] = sqrt(dot(r[k], r[k]));
        }
        const double det = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) +
                           r[0][1] * (r[1][2] * r[2][0] - r[1][0] * r[2][2]) +
                           r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
        /* van Oosterom & Strackee 1983 */
        sum += 2 * atan2(det, l[0] * l[1] * l[2] + dot(r[0], r[1]) * l[2] + dot(r[1], r[2]) * l[0] +
                                  dot(r[2], r[0]) * l[1]);
    }
    return sum / (4 * acos(-1.0));
}

double pm_collide_volume(const double *x, ptrdiff_t nt, const int32_t *tri)
{
    const double zero[3] = {0};
    double sum = 0;
    for (ptrdiff_t t = 0; t < nt; t++)
        sum += orient(x + 3 * tri[3 * t], x + 3 * tri[3 * t + 1], x + 3 * tri[3 * t + 2], zero);
    return sum / 6;
}
