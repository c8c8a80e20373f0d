#include "common/geometry/remesh_edit.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

/* A facet may lean at most this far (cosine) from the surface normal at its nodes; worse ones may
 * only be replaced by better ones. */
static const double min_cosine = 0.3;
const double pm_edit_longest = 4.0 / 3.0, pm_edit_shortest = 4.0 / 5.0;

double pm_parameter_orientation(int32_t type, const double a[3], const double b[3],
                                const double c[3])
{
    if (type == PM_SURFACE_BSPLINE) {
        const double tb = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        const double tc = atan2(a[0] * c[1] - a[1] * c[0], a[0] * c[0] + a[1] * c[1]);
        return tb * (c[2] - a[2]) - tc * (b[2] - a[2]);
    }
    /* differences first: near the poles of a conformal map x and y are tiny but relatively exact */
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return a[0] * (u[1] * v[2] - u[2] * v[1]) + a[1] * (u[2] * v[0] - u[0] * v[2]) +
           a[2] * (u[0] * v[1] - u[1] * v[0]);
}

double pm_edit_length(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    const double *p = m->x + 3 * a, *q = m->x + 3 * b;
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double wanted(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    return 0.5 * (m->size[a] + m->size[b]);
}

/* Quality of the facet (a, b, c): -1 folded in the parameter, else cosine against the surface
 * normals. */
static double facet(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c)
{
    if (!(pm_parameter_orientation(m->type, m->S + 3 * a, m->S + 3 * b, m->S + 3 * c) > 0))
        return -1;
    const double *p = m->x + 3 * a, *q = m->x + 3 * b, *r = m->x + 3 * c;
    const double *na = m->normal + 3 * a, *nb = m->normal + 3 * b, *nc = m->normal + 3 * c;
    double u[3], v[3], g[3], n[3];
    for (int i = 0; i < 3; i++) {
        u[i] = q[i] - p[i];
        v[i] = r[i] - p[i];
        g[i] = na[i] + nb[i] + nc[i];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    const double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const double gg = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    if (!(nn > 0) || !(gg > 0))
        return -0.999;
    return (n[0] * g[0] + n[1] * g[1] + n[2] * g[2]) / sqrt(nn * gg);
}

static double facet_of(const struct pm_edit *m, ptrdiff_t t)
{
    const int32_t *v = m->tri + 3 * t;
    return facet(m, v[0], v[1], v[2]);
}

static double area(const struct pm_edit *m, ptrdiff_t t)
{
    const int32_t *v = m->tri + 3 * t;
    const double *p = m->x + 3 * v[0], *q = m->x + 3 * v[1], *r = m->x + 3 * v[2];
    double u[3], w[3];
    for (int i = 0; i < 3; i++) {
        u[i] = q[i] - p[i];
        w[i] = r[i] - p[i];
    }
    const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                         u[0] * w[1] - u[1] * w[0]};
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

double pm_edit_area(const struct pm_edit *m)
{
    double sum = 0;
    for (ptrdiff_t t = 0; t < m->nt; t++)
        sum += m->tri[3 * t] >= 0 ? area(m, t) : 0;
    return sum;
}

double pm_edit_crowding(const struct pm_edit *m)
{
    double wanted_count = 0, count = 0;
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = m->tri + 3 * t;
        if (v[0] < 0)
            continue;
        const double h = (m->size[v[0]] + m->size[v[1]] + m->size[v[2]]) / 3;
        wanted_count += area(m, t) / (sqrt(3) / 4 * h * h);
        count++;
    }
    return count / wanted_count;
}

double pm_edit_worst(const struct pm_edit *m, ptrdiff_t a)
{
    double worst = 1;
    for (int k = 0; k < m->degree[a]; k++)
        worst = fmin(worst, facet_of(m, m->around[a * PM_EDIT_DEGREE + k]));
    return worst;
}

static int acceptable(double now, double before)
{
    return now > min_cosine || (now > -0.9 && now > before);
}

enum pm_status pm_edit_place(struct pm_edit *m, ptrdiff_t a, struct pm_err *err)
{
    double r_a[6];
    const enum pm_status status =
        pm_map_point(m->map, m->phi, m->S + 3 * a, &m->basis, m->x + 3 * a, r_a, NULL, err);
    double *n = m->normal + 3 * a;
    n[0] = r_a[1] * r_a[5] - r_a[2] * r_a[4];
    n[1] = r_a[2] * r_a[3] - r_a[0] * r_a[5];
    n[2] = r_a[0] * r_a[4] - r_a[1] * r_a[3];
    const double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        n[i] = l > 0 ? n[i] / l : 0;
    return status;
}

/* The other end of an edge: index of the corner of t that is node a. */
static int corner(const struct pm_edit *m, ptrdiff_t t, ptrdiff_t a)
{
    const int32_t *v = m->tri + 3 * t;
    return v[0] == a ? 0 : v[1] == a ? 1 : 2;
}

/* Triangles on the edge (a, b): t[0] runs a -> b, t[1] runs b -> a, -1 if there is none; c and d
 * are their opposite nodes. Returns their number. */
static int on_edge(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, ptrdiff_t t[2],
                   ptrdiff_t opp[2])
{
    int n = 0;
    t[0] = t[1] = opp[0] = opp[1] = -1;
    for (int k = 0; k < m->degree[a]; k++) {
        const ptrdiff_t f = m->around[a * PM_EDIT_DEGREE + k];
        const int32_t *v = m->tri + 3 * f;
        const int i = corner(m, f, a);
        const ptrdiff_t next = v[(i + 1) % 3], previous = v[(i + 2) % 3];
        if (next == b || previous == b) {
            t[next == b ? 0 : 1] = f;
            opp[next == b ? 0 : 1] = next == b ? previous : next;
            n++;
        }
    }
    return n;
}

static int adjacent(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    ptrdiff_t t[2], opp[2];
    return on_edge(m, a, b, t, opp) > 0;
}

static void attach(struct pm_edit *m, ptrdiff_t a, ptrdiff_t t)
{
    m->around[a * PM_EDIT_DEGREE + m->degree[a]++] = (int32_t)t;
}

static void detach(struct pm_edit *m, ptrdiff_t a, ptrdiff_t t)
{
    int32_t *list = m->around + a * PM_EDIT_DEGREE;
    int k = 0;
    while (list[k] != t)
        k++;
    m->degree[a]--;
    memmove(list + k, list + k + 1, (size_t)(m->degree[a] - k) * sizeof *list);
}

static enum pm_status reserve(struct pm_edit *m, ptrdiff_t nn, ptrdiff_t nt, struct pm_err *err)
{
    if (nn > m->ncap) {
        const ptrdiff_t n = 2 * nn;
        PM_GROW(m->S, 3 * n, err);
        PM_GROW(m->x, 3 * n, err);
        PM_GROW(m->normal, 3 * n, err);
        PM_GROW(m->size, n, err);
        PM_GROW(m->rim, n, err);
        PM_GROW(m->around, PM_EDIT_DEGREE * n, err);
        PM_GROW(m->degree, n, err);
        m->ncap = n;
    }
    if (nt > m->tcap) {
        PM_GROW(m->tri, 3 * 2 * nt, err);
        m->tcap = 2 * nt;
    }
    return PM_OK;
}

/* Every edge in at most two triangles of opposite direction; none folded in the parameter. */
static enum pm_status check_start(const struct pm_edit *m, int surface, struct pm_err *err)
{
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = m->tri + 3 * t;
        if (facet_of(m, t) == -1)
            return pm_fail(
                err, PM_INPUT,
                "surface %d: triangle %td of its control points is folded in the parameter",
                surface, t);
        for (int k = 0; k < 3; k++) {
            ptrdiff_t f[2], opp[2];
            const ptrdiff_t a = v[k], b = v[(k + 1) % 3];
            const int n = on_edge(m, a, b, f, opp);
            const int rim = (m->rim[a] & m->rim[b]) != 0;
            if (n > 2 || f[0] != t || (n == 1 && !rim))
                return pm_fail(
                    err, PM_INPUT,
                    "surface %d: edge %td-%td of its control points is not shared by two "
                    "triangles of like orientation",
                    surface, a, b);
        }
    }
    return PM_OK;
}

enum pm_status pm_edit_init(struct pm_edit *m, const struct pm_surface *s, const struct pm_map *map,
                            int surface, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    *m = (struct pm_edit){.map = map, .phi = s->phi, .type = s->type};
    PM_TRY(reserve(m, 2 * s->n, 2 * s->nt, err));
    m->nn = s->n;
    m->nt = s->nt;
    memcpy(m->S, s->Phi, (size_t)(3 * s->n) * sizeof *m->S);
    memcpy(m->tri, s->tri, (size_t)(3 * s->nt) * sizeof *m->tri);
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        m->degree[a] = 0;
        m->size[a] = 0;
        m->rim[a] = 0;
        if (s->type == PM_SURFACE_BSPLINE)
            m->rim[a] = (uint8_t)(a < s->nu ? 1 : a >= s->n - s->nu ? 2 : 0);
        if (m->rim[a])
            m->S[3 * a + 2] = m->rim[a] - 1;
        PM_TRY(pm_edit_place(m, a, err));
    }
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        for (int k = 0; k < 3; k++) {
            const ptrdiff_t a = m->tri[3 * t + k];
            if (m->degree[a] >= PM_EDIT_DEGREE - 1) {
                status = pm_fail(err, PM_INPUT,
                                 "surface %d: control point %td has more than %d triangles",
                                 surface, a, PM_EDIT_DEGREE - 1);
                goto done;
            }
            attach(m, a, t);
        }
    }
    PM_TRY(check_start(m, surface, err));
done:
    return status;
}

void pm_edit_release(struct pm_edit *m)
{
    pm_basis_release(&m->basis);
    pm_free(m->S);
    pm_free(m->x);
    pm_free(m->normal);
    pm_free(m->size);
    pm_free(m->rim);
    pm_free(m->tri);
    pm_free(m->around);
    pm_free(m->degree);
    *m = (struct pm_edit){0};
}

/* Replaces a -> b in t by a -> e and adds the triangle (e, b, c). */
static void cut(struct pm_edit *m, ptrdiff_t t, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c, ptrdiff_t e)
{
    const ptrdiff_t f = m->nt++;
    const int first = m->tri[3 * t + (corner(m, t, a) + 1) % 3] == b;
    m->tri[3 * t + corner(m, t, b)] = (int32_t)e;
    m->tri[3 * f] = (int32_t)(first ? e : b);
    m->tri[3 * f + 1] = (int32_t)(first ? b : e);
    m->tri[3 * f + 2] = (int32_t)c;
    detach(m, b, t);
    attach(m, b, f);
    attach(m, c, f);
    attach(m, e, t);
    attach(m, e, f);
}

enum pm_status pm_edit_split_edge(struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, const double *S,
                                  int *done_it, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t t[2], opp[2];
    const int n = on_edge(m, a, b, t, opp);
    *done_it = 0;
    for (int k = 0; k < 2; k++)
        if (opp[k] >= 0 && m->degree[opp[k]] >= PM_EDIT_DEGREE - 1)
            return PM_OK;
    PM_TRY(reserve(m, m->nn + 1, m->nt + 2, err));
    const ptrdiff_t e = m->nn++;
    if (S != NULL)
        memcpy(m->S + 3 * e, S, 3 * sizeof *S);
    else
        pm_map_middle(m->type, m->S + 3 * a, m->S + 3 * b, m->S + 3 * e);
    m->rim[e] = (uint8_t)(n == 1 ? m->rim[a] & m->rim[b] : 0);
    pm_rim_constrain(m->type, m->rim[e], m->S + 3 * e);
    m->size[e] = wanted(m, a, b);
    m->degree[e] = 0;
    PM_TRY(pm_edit_place(m, e, err));
    for (int k = 0; k < 2; k++)
        if (t[k] >= 0)
            cut(m, t[k], a, b, opp[k], e);
    *done_it = 1;
done:
    return status;
}

enum pm_status pm_edit_split(struct pm_edit *m, double ratio, ptrdiff_t *count, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    *count = 0;
    const ptrdiff_t nt = m->nt; /* new triangles wait for the flips between two passes */
    for (ptrdiff_t t = 0; t < nt; t++) {
        ptrdiff_t a = -1, b = -1;
        double longest = ratio;
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            const ptrdiff_t p = m->tri[3 * t + k], q = m->tri[3 * t + (k + 1) % 3];
            const double l = pm_edit_length(m, p, q) / wanted(m, p, q);
            if (l > longest) {
                longest = l;
                a = p;
                b = q;
            }
        }
        int done_it = 0;
        if (a >= 0)
            PM_TRY(pm_edit_split_edge(m, a, b, NULL, &done_it, err));
        *count += done_it;
    }
done:
    return status;
}

/* Nodes joined to both ends must be exactly the opposite nodes of the edge (link condition), and no
 * interior edge may come to join two nodes of one rim. */
static int link_ok(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, const ptrdiff_t opp[2])
{
    for (int k = 0; k < m->degree[a]; k++) {
        const ptrdiff_t t = m->around[a * PM_EDIT_DEGREE + k];
        for (int i = 0; i < 3; i++) {
            const ptrdiff_t c = m->tri[3 * t + i];
            if (c == a || c == b || c == opp[0] || c == opp[1])
                continue;
            if (adjacent(m, c, b) || (m->rim[c] & m->rim[b] & ~m->rim[a]) != 0)
                return 0;
        }
    }
    return 1;
}

/* May a move onto b? */
static int may_collapse(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    ptrdiff_t t[2], opp[2];
    const int n = on_edge(m, a, b, t, opp);
    if ((m->rim[a] != 0 && n != 1) || (m->rim[a] & ~m->rim[b]) != 0)
        return 0;
    for (int k = 0; k < 2; k++)
        if (opp[k] >= 0 && m->degree[opp[k]] <= 3 && m->rim[opp[k]] == 0)
            return 0;
    if (m->degree[a] + m->degree[b] >= PM_EDIT_DEGREE - 1 || !link_ok(m, a, b, opp))
        return 0;
    const double before = fmin(pm_edit_worst(m, a), 1);
    for (int k = 0; k < m->degree[a]; k++) {
        const ptrdiff_t f = m->around[a * PM_EDIT_DEGREE + k];
        if (f == t[0] || f == t[1])
            continue;
        const int32_t *v = m->tri + 3 * f;
        const int i = corner(m, f, a);
        const ptrdiff_t p = v[(i + 1) % 3], q = v[(i + 2) % 3];
        if (!acceptable(facet(m, b, p, q), before) ||
            pm_edit_length(m, b, p) > pm_edit_longest * wanted(m, b, p) ||
            pm_edit_length(m, b, q) > pm_edit_longest * wanted(m, b, q))
            return 0;
    }
    return 1;
}

void pm_edit_remove(struct pm_edit *m, ptrdiff_t t)
{
    for (int i = 0; i < 3; i++)
        detach(m, m->tri[3 * t + i], t);
    m->tri[3 * t] = -1;
}

static void collapse_edge(struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    for (int k = 0; k < m->degree[a]; k++) {
        const ptrdiff_t t = m->around[a * PM_EDIT_DEGREE + k];
        int32_t *v = m->tri + 3 * t;
        if (v[0] == b || v[1] == b || v[2] == b) {
            for (int i = 0; i < 3; i++)
                if (v[i] != a)
                    detach(m, v[i], t);
            v[0] = -1;
        } else {
            v[corner(m, t, a)] = (int32_t)b;
            attach(m, b, t);
        }
    }
    m->degree[a] = 0;
}

ptrdiff_t pm_edit_collapse(struct pm_edit *m)
{
    ptrdiff_t count = 0;
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            const ptrdiff_t a = m->tri[3 * t + k], b = m->tri[3 * t + (k + 1) % 3];
            if (pm_edit_length(m, a, b) >= pm_edit_shortest * wanted(m, a, b))
                continue;
            const int forward = may_collapse(m, a, b);
            if (forward || may_collapse(m, b, a)) {
                collapse_edge(m, forward ? a : b, forward ? b : a);
                count++;
            }
        }
    }
    return count;
}

/* Cotangent of the angle at c of (a, b, c). */
static double cotangent(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c)
{
    const double *p = m->x + 3 * a, *q = m->x + 3 * b, *r = m->x + 3 * c;
    double dot = 0, uu = 0, vv = 0;
    for (int i = 0; i < 3; i++) {
        const double u = p[i] - r[i], v = q[i] - r[i];
        dot += u * v;
        uu += u * u;
        vv += v * v;
    }
    const double area2 = uu * vv - dot * dot;
    return dot / sqrt(fmax(area2, 1e-30 * uu * vv));
}

static int flip_edge(struct pm_edit *m, ptrdiff_t a, ptrdiff_t b)
{
    ptrdiff_t t[2], opp[2];
    if (on_edge(m, a, b, t, opp) != 2)
        return 0;
    const ptrdiff_t c = opp[0], d = opp[1];
    /* angles at c and d sum to more than pi, with a margin against endless flipping */
    if (cotangent(m, a, b, c) + cotangent(m, a, b, d) > -1e-6)
        return 0;
    if (m->degree[a] <= 3 || m->degree[b] <= 3 || m->degree[c] >= PM_EDIT_DEGREE - 1 ||
        m->degree[d] >= PM_EDIT_DEGREE - 1 || adjacent(m, c, d) || (m->rim[c] & m->rim[d]) != 0)
        return 0;
    const double before = fmin(facet_of(m, t[0]), facet_of(m, t[1]));
    const double now = fmin(facet(m, a, d, c), facet(m, d, b, c));
    if (!acceptable(now, before))
        return 0;
    const int32_t f0[3] = {(int32_t)a, (int32_t)d, (int32_t)c},
                  f1[3] = {(int32_t)d, (int32_t)b, (int32_t)c};
    memcpy(m->tri + 3 * t[0], f0, sizeof f0);
    memcpy(m->tri + 3 * t[1], f1, sizeof f1);
    detach(m, b, t[0]);
    detach(m, a, t[1]);
    attach(m, d, t[0]);
    attach(m, c, t[1]);
    return 1;
}

ptrdiff_t pm_edit_flip(struct pm_edit *m)
{
    ptrdiff_t total = 0, count = 1;
    for (int pass = 0; pass < 10 && count > 0; pass++, total += count) {
        count = 0;
        for (ptrdiff_t t = 0; t < m->nt; t++)
            for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++)
                count += flip_edge(m, m->tri[3 * t + k], m->tri[3 * t + (k + 1) % 3]);
    }
    return total;
}

enum pm_status pm_edit_finish(struct pm_edit *m, struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *id = NULL;
    ptrdiff_t nn = 0, nt = 0;
    PM_TRY(PM_NEW(id, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (m->degree[a] == 0)
            continue;
        memmove(m->S + 3 * nn, m->S + 3 * a, 3 * sizeof *m->S);
        memmove(m->x + 3 * nn, m->x + 3 * a, 3 * sizeof *m->x);
        m->size[nn] = m->size[a];
        m->rim[nn] = m->rim[a];
        id[a] = (int32_t)nn++;
    }
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        if (m->tri[3 * t] < 0)
            continue;
        for (int k = 0; k < 3; k++)
            m->tri[3 * nt + k] = id[m->tri[3 * t + k]];
        nt++;
    }
    *p = (struct pm_patch){
        .nn = nn, .nt = nt, .S = m->S, .x = m->x, .size = m->size, .rim = m->rim, .tri = m->tri};
    m->S = m->x = m->size = NULL;
    m->rim = NULL;
    m->tri = NULL;
done:
    pm_free(id);
    return status;
}
