#include "common/geometry/collide.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

static void box_of(const double *x, const int32_t *v, double box[6])
{
    for (int i = 0; i < 3; i++) {
        const double a = x[3 * v[0] + i], b = x[3 * v[1] + i], c = x[3 * v[2] + i];
        box[i] = fmin(a, fmin(b, c));
        box[3 + i] = fmax(a, fmax(b, c));
    }
}

enum pm_status pm_collide_boxes(const double *x, ptrdiff_t nt, const int32_t *tri,
                                const double *normal, struct pm_boxes **boxes, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *box = NULL;
    PM_TRY(PM_NEW(box, 6 * nt, err));
    for (ptrdiff_t t = 0; t < nt; t++)
        box_of(x, tri + 3 * t, box + 6 * t);
    PM_TRY(pm_boxes_new(nt, box, normal, boxes, err));
done:
    pm_free(box);
    return status;
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

/* Does the segment p q pass through the triangle a b c? Touching does not count: an end within 1e-9
 * of the triangle's size from its plane, which is more than the rounding of coplanar triangles that
 * were turned. */
static int pierces(const double *p, const double *q, const double *a, const double *b,
                   const double *c, double at[3])
{
    const double dp = orient(a, b, c, p), dq = orient(a, b, c, q);
    if (!(dp * dq < 0))
        return 0;
    double u[3], v[3], n2 = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    for (int i = 0; i < 3; i++) {
        const double n = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
        n2 += n * n;
    }
    if (fmin(fabs(dp), fabs(dq)) <= 1e-9 * pow(n2, 0.75))
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

struct piercing {
    const double *x;
    const int32_t *tri;
    ptrdiff_t parts, n, capacity;
    int32_t *pair; /* of faces, the lower one first (n x 2) */
    struct pm_contact *first;
    enum pm_status status;
    struct pm_err *err;
};

static enum pm_status push(struct piercing *p, int32_t f, int32_t g, struct pm_err *err)
{
    if (p->n == p->capacity) {
        PM_GROW(p->pair, 2 * (2 * p->capacity + 64), err);
        p->capacity = 2 * p->capacity + 64;
    }
    p->pair[2 * p->n] = f;
    p->pair[2 * p->n++ + 1] = g;
    return PM_OK;
}

static double pierce_pair(void *data, int32_t a, int32_t b, double best)
{
    struct piercing *p = data;
    const int32_t i = a < b ? a : b, j = a < b ? b : a;
    const int32_t *v = p->tri + 3 * (ptrdiff_t)i, *w = p->tri + 3 * (ptrdiff_t)j;
    const int shared = contains(w, v[0]) + contains(w, v[1]) + contains(w, v[2]);
    double at[3];
    if (shared > 1 || !(edges_pierce(p->x, v, w, at) || edges_pierce(p->x, w, v, at)))
        return best;
    if (p->first->a < 0 || i < p->first->a || (i == p->first->a && j < p->first->b)) {
        p->first->a = i;
        p->first->b = j;
        memcpy(p->first->at, at, sizeof at);
    }
    if (p->status == PM_OK)
        p->status = push(p, (int32_t)(i / p->parts), (int32_t)(j / p->parts), p->err);
    return best;
}

static int by_faces(const void *a, const void *b)
{
    const int32_t *p = a, *q = b;
    const int k = p[0] == q[0];
    return (p[k] > q[k]) - (p[k] < q[k]);
}

enum pm_status pm_collide_faces(const struct pm_boxes *boxes, const double *x, const int32_t *tri,
                                ptrdiff_t parts, struct pm_contact *c, struct pm_err *err)
{
    struct piercing p = {.x = x, .tri = tri, .parts = parts, .first = c, .err = err};
    *c = (struct pm_contact){.a = -1, .b = -1};
    pm_boxes_pairs(boxes, -1, 0, pierce_pair, &p);
    if (p.n > 0)
        qsort(p.pair, (size_t)p.n, 2 * sizeof *p.pair, by_faces);
    for (ptrdiff_t k = 0; k < p.n; k++)
        c->pairs += k == 0 || by_faces(p.pair + 2 * k - 2, p.pair + 2 * k) != 0;
    pm_free(p.pair);
    return p.status;
}

enum pm_status pm_collide_pierce(const double *x, ptrdiff_t nt, const int32_t *tri,
                                 struct pm_contact *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *boxes = NULL;
    PM_TRY(pm_collide_boxes(x, nt, tri, NULL, &boxes, err));
    PM_TRY(pm_collide_faces(boxes, x, tri, 1, c, err));
done:
    pm_boxes_free(boxes);
    return status;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Nearest point q of the segment a b to p; returns the squared distance. */
static double to_segment(const double *p, const double *a, const double *b, double q[3])
{
    double d[3], e[3];
    for (int i = 0; i < 3; i++) {
        d[i] = b[i] - a[i];
        e[i] = p[i] - a[i];
    }
    const double dd = dot(d, d);
    const double t = dd > 0 ? fmin(fmax(dot(d, e) / dd, 0), 1) : 0;
    for (int i = 0; i < 3; i++) {
        q[i] = a[i] + t * d[i];
        e[i] -= t * d[i];
    }
    return dot(e, e);
}

double pm_collide_closest(const double *p, const double *a, const double *b, const double *c,
                          double q[3])
{
    double u[3], v[3], w[3], r[3];
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
            for (int i = 0; i < 3; i++) {
                q[i] = a[i] + s * u[i] + t * v[i];
                w[i] = p[i] - q[i];
            }
            return sqrt(dot(w, w));
        }
    }
    const double *corner[4] = {a, b, c, a};
    double best = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double d2 = to_segment(p, corner[k], corner[k + 1], r);
        if (d2 < best) {
            best = d2;
            memcpy(q, r, sizeof r);
        }
    }
    return sqrt(best);
}

enum pm_status pm_collide_near(ptrdiff_t nn, const double *x, const double *limit, ptrdiff_t nt,
                               const int32_t *tri, struct pm_contact *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *boxes = NULL;
    int32_t *id = NULL;
    double best = 1;
    *c = (struct pm_contact){.a = -1, .b = -1};
    PM_TRY(pm_collide_boxes(x, nt, tri, NULL, &boxes, err));
    PM_TRY(PM_NEW(id, nt, err));
    for (ptrdiff_t a = 0; a < nn; a++) {
        const double *p = x + 3 * a, r = best * limit[a];
        const double box[6] = {p[0] - r, p[1] - r, p[2] - r, p[0] + r, p[1] + r, p[2] + r};
        const ptrdiff_t n = r > 0 ? pm_boxes_meet(boxes, box, id) : 0;
        for (ptrdiff_t k = 0; k < n; k++) {
            const int32_t *v = tri + 3 * (ptrdiff_t)id[k];
            double q[3];
            if (contains(v, (int32_t)a))
                continue;
            const double d = pm_collide_closest(p, x + 3 * v[0], x + 3 * v[1], x + 3 * v[2], q);
            if (d < best * limit[a]) {
                best = d / limit[a];
                *c = (struct pm_contact){a, id[k], {p[0], p[1], p[2]}, d, 1};
            }
        }
    }
done:
    pm_boxes_free(boxes);
    pm_free(id);
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
