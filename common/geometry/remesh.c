#include "common/geometry/remesh.h"

#include <math.h>

#include "common/base/memory.h"
#include "common/geometry/remesh_edit.h"

void pm_patch_release(struct pm_patch *p)
{
    pm_free(p->S);
    pm_free(p->x);
    pm_free(p->size);
    pm_free(p->rim);
    pm_free(p->tri);
    *p = (struct pm_patch){0};
}

uint8_t pm_rim_plane(int32_t type, int axis)
{
    return (uint8_t)((type == PM_SURFACE_BSPLINE ? 4 : 1) << axis);
}

void pm_rim_constrain(int32_t type, unsigned rim, double S[3])
{
    const int tube = type == PM_SURFACE_BSPLINE;
    double sum = 0;
    if (rim == 0)
        return;
    if (tube && (rim & 3) != 0)
        S[2] = (rim & 3) - 1;
    for (int j = 0; j < (tube ? 2 : 3); j++) {
        S[j] = rim & pm_rim_plane(type, j) ? 0 : S[j];
        sum += S[j] * S[j];
    }
    for (int j = 0; j < (tube ? 2 : 3); j++)
        S[j] /= sqrt(sum);
}

/* Largest principal curvature |k| = |H| + sqrt(H^2 - K) [model 6.2], and the unit normal. */
static double curvature(const double r_a[6], const double r_ab[9], double n[3])
{
    const double *u = r_a, *v = r_a + 3;
    double g[3] = {0}, b[3] = {0};
    for (int i = 0; i < 3; i++)
        n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    for (int i = 0; i < 3; i++) {
        g[0] += u[i] * u[i];
        g[1] += u[i] * v[i];
        g[2] += v[i] * v[i];
        for (int k = 0; k < 3; k++)
            b[k] += r_ab[3 * k + i] * n[i];
    }
    const double det = g[0] * g[2] - g[1] * g[1]; /* |n|^2 */
    if (!(det > 0))
        return INFINITY;
    const double H = (g[2] * b[0] - 2 * g[1] * b[1] + g[0] * b[2]) / (2 * det);
    const double K = (b[0] * b[2] - b[1] * b[1]) / det;
    for (int i = 0; i < 3; i++)
        n[i] /= sqrt(det);
    return (fabs(H) + sqrt(fmax(H * H - K, 0))) / sqrt(det);
}

static double length_at(const struct pm_remesh_opts *o, double k)
{
    const double crest = fmin(o->size, o->crest / k);
    return o->chord > 0 ? fmin(crest, sqrt(8 * o->chord / k)) : crest;
}

double pm_remesh_length(const struct pm_remesh_opts *o, const double r_a[6], const double r_ab[9])
{
    double n[3];
    return fmax(o->size_min, length_at(o, curvature(r_a, r_ab, n)));
}

static enum pm_status size_at(struct pm_edit *m, const struct pm_remesh_opts *o, const double S[3],
                              double *size, struct pm_err *err)
{
    enum pm_status status;
    double x[3], r_a[6], r_ab[9], n[3];
    PM_TRY(pm_map_point(m->map, m->phi, S, &m->basis, x, r_a, r_ab, err));
    const double k = curvature(r_a, r_ab, n);
    double bound = length_at(o, k);
    if (o->bound != NULL)
        bound = fmin(bound, o->bound(o->data, x, n, k));
    *size = fmax(o->size_min, bound);
done:
    return status;
}

/* Only the middle of an edge sees the crest that it spans. */
static enum pm_status look_between(struct pm_edit *m, const struct pm_remesh_opts *o,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t t = 0; t < m->nt; t++)
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            const ptrdiff_t a = m->tri[3 * t + k], b = m->tri[3 * t + (k + 1) % 3];
            double S[3], h;
            if (a > b && !(m->rim[a] & m->rim[b])) /* the other triangle's turn */
                continue;
            pm_map_middle(m->type, m->S + 3 * a, m->S + 3 * b, S);
            PM_TRY(size_at(m, o, S, &h, err));
            h += o->growth * pm_edit_length(m, a, b) / 2;
            m->size[a] = fmin(m->size[a], h);
            m->size[b] = fmin(m->size[b], h);
        }
done:
    return status;
}

/* Wanted length at every node, then at most `growth` per unit length along edges. */
static enum pm_status set_sizes(struct pm_edit *m, const struct pm_remesh_opts *o,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->degree[a] > 0)
            PM_TRY(size_at(m, o, m->S + 3 * a, &m->size[a], err));
    if (o->size_min < o->size)
        PM_TRY(look_between(m, o, err));
    for (int pass = 0, changed = 1; pass < 20 && changed; pass++) {
        changed = 0;
        for (ptrdiff_t t = 0; t < m->nt; t++) {
            for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
                const ptrdiff_t a = m->tri[3 * t + k], b = m->tri[3 * t + (k + 1) % 3];
                const double l = pm_edit_length(m, a, b);
                const double ha = fmin(m->size[a], m->size[b] + o->growth * l);
                const double hb = fmin(m->size[b], m->size[a] + o->growth * l);
                changed |= ha < m->size[a] * (1 - 1e-3) || hb < m->size[b] * (1 - 1e-3);
                m->size[a] = ha;
                m->size[b] = hb;
            }
        }
    }
done:
    return status;
}

/* Where smoothing would move node a: to the mean of the centroids around it, weighted by area over
 * the square of the wanted length; on a rim between its two neighbours. Displacement in d. */
static void target(const struct pm_edit *m, ptrdiff_t a, double d[3])
{
    double sum = 0;
    d[0] = d[1] = d[2] = 0;
    for (int k = 0; k < m->degree[a]; k++) {
        const int32_t *v = m->tri + 3 * (ptrdiff_t)m->around[a * PM_EDIT_DEGREE + k];
        const double *p = m->x + 3 * (ptrdiff_t)v[0], *q = m->x + 3 * (ptrdiff_t)v[1],
                     *r = m->x + 3 * (ptrdiff_t)v[2];
        double u[3], w[3], c[3];
        for (int i = 0; i < 3; i++) {
            u[i] = q[i] - p[i];
            w[i] = r[i] - p[i];
            c[i] = (p[i] + q[i] + r[i]) / 3 - m->x[3 * a + i];
        }
        const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                             u[0] * w[1] - u[1] * w[0]};
        const double h = (m->size[v[0]] + m->size[v[1]] + m->size[v[2]]) / 3;
        const double weight = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / (h * h);
        for (int i = 0; i < 3; i++)
            d[i] += weight * c[i];
        sum += weight;
    }
    for (int i = 0; i < 3; i++)
        d[i] = sum > 0 ? d[i] / sum : 0;
}

/* A rim node: its two neighbours on the rim, weighted so that both edges are equal parts of the
 * wanted length. */
static void target_rim(const struct pm_edit *m, ptrdiff_t a, double d[3])
{
    double sum = 0;
    d[0] = d[1] = d[2] = 0;
    for (int k = 0; k < m->degree[a]; k++) {
        const int32_t *v = m->tri + 3 * (ptrdiff_t)m->around[a * PM_EDIT_DEGREE + k];
        for (int i = 0; i < 3; i++) {
            const ptrdiff_t b = v[i];
            if (b == a || (m->rim[b] & m->rim[a]) == 0)
                continue;
            for (int j = 0; j < 3; j++)
                d[j] += m->x[3 * b + j] - m->x[3 * a + j];
            sum += 1;
        }
    }
    for (int i = 0; i < 3; i++)
        d[i] = sum > 0 ? d[i] / sum : 0;
}

/* Moves node a tangentially by the parameter step J^+ d, halved until no triangle around it gets
 * bad. */
static enum pm_status smooth_node(struct pm_edit *m, ptrdiff_t a, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double d[3], r_a[6], step[2], S0[3];
    if ((m->rim[a] & (m->rim[a] - 1)) != 0)
        return PM_OK; /* a corner of two rims */
    const double before = pm_edit_worst(m, a);
    if (m->rim[a])
        target_rim(m, a, d);
    else
        target(m, a, d);
    PM_TRY(pm_map_point(m->map, m->phi, m->S + 3 * a, &m->basis, NULL, r_a, NULL, err));
    double g[3] = {0}, f[2] = {0};
    for (int i = 0; i < 3; i++) {
        g[0] += r_a[i] * r_a[i];
        g[1] += r_a[i] * r_a[3 + i];
        g[2] += r_a[3 + i] * r_a[3 + i];
        f[0] += r_a[i] * d[i];
        f[1] += r_a[3 + i] * d[i];
    }
    const double det = g[0] * g[2] - g[1] * g[1];
    if (!(det > 0) || !(g[0] > 0))
        goto done;
    /* the tangents of a tube are along its rims and along its mirror planes */
    const int around = m->type == PM_SURFACE_BSPLINE && (m->rim[a] & 3) != 0;
    const int along = m->type == PM_SURFACE_BSPLINE && m->rim[a] > 3;
    step[0] = around ? f[0] / g[0] : along ? 0 : (g[2] * f[0] - g[1] * f[1]) / det;
    step[1] = around ? 0 : along ? f[1] / g[2] : (g[0] * f[1] - g[1] * f[0]) / det;
    for (int i = 0; i < 3; i++)
        S0[i] = m->S[3 * a + i];
    for (int half = 0; half < 4; half++) {
        const double now_step[2] = {ldexp(step[0], -half), ldexp(step[1], -half)};
        pm_map_move(m->type, S0, now_step, m->S + 3 * a);
        pm_rim_constrain(m->type, m->rim[a], m->S + 3 * a);
        PM_TRY(pm_edit_place(m, a, err));
        const double now = pm_edit_worst(m, a);
        if (now > 0.3 || now >= before)
            goto done;
    }
    for (int i = 0; i < 3; i++)
        m->S[3 * a + i] = S0[i];
    PM_TRY(pm_edit_place(m, a, err));
done:
    return status;
}

static const double MOST = 2e5; /* nodes */

/* A size far too small for the surface would fill the memory: about 2 A / (sqrt 3 h^2) nodes. */
static enum pm_status check_size(const struct pm_edit *m, int surface, double size,
                                 struct pm_err *err)
{
    const double area = pm_edit_area(m), nodes = 2 * area / (sqrt(3) * size * size);
    if (nodes <= MOST)
        return PM_OK;
    return pm_fail(
        err, PM_INPUT,
        "surface %d: edges of %g mm need about %.1e nodes on %.3g mm2, expected %.0e at most",
        surface, size, nodes, area, MOST);
}

/* So would a surface that is nearly folded, all over or in one place. */
static enum pm_status check_nodes(const struct pm_edit *m, int surface, struct pm_err *err)
{
    ptrdiff_t sharpest = -1, n = 0;
    if ((double)m->nn <= MOST)
        return PM_OK;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->degree[a] > 0) {
            n++;
            sharpest = sharpest < 0 || m->size[a] < m->size[sharpest] ? a : sharpest;
        }
    if ((double)n <= MOST)
        return PM_OK;
    const double *x = m->x + 3 * sharpest;
    return pm_fail(err, PM_INPUT,
                   "surface %d: edges as its curvature asks for, down to %.3g mm at (%.3f, %.3f, "
                   "%.3f) mm, need more than %.0e nodes",
                   surface, m->size[sharpest], x[0], x[1], x[2], MOST);
}

/* Even triangles keep their number over a wide range of sizes, as no edge or all of them leave the
 * band. From edges below half of the wanted length the collapses end at a crowding of 1.05 to 1.25,
 * whatever the start was. */
static const double fine = 0.5;

static int even(const struct pm_edit *m)
{
    return fabs(log(pm_edit_crowding(m) / 1.12)) < log(1.15);
}

enum pm_status pm_remesh(const struct pm_surface *s, int surface, const struct pm_remesh_opts *o,
                         struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_edit m = {0};
    double off = 0;
    *p = (struct pm_patch){0};
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(pm_edit_init(&m, s, map, surface, err));
    PM_TRY(check_size(&m, surface, o->size, err));
    for (int j = 0; j < 3; j++)
        if (o->mirror[j])
            PM_TRY(pm_edit_halve(&m, j, err));
    for (int sweep = 0; sweep < o->sweeps; sweep++) {
        ptrdiff_t count = 1;
        PM_TRY(set_sizes(&m, o, err));
        const double longest = sweep % 2 == 1 && !even(&m) ? fine : pm_edit_longest;
        for (int pass = 0; pass < 20 && count > 0; pass++) {
            PM_TRY(pm_edit_split(&m, longest, &count, err));
            PM_TRY(check_nodes(&m, surface, err));
            pm_edit_flip(&m);
        }
        pm_edit_collapse(&m);
        pm_edit_flip(&m);
        for (ptrdiff_t a = 0; a < m.nn; a++)
            if (m.degree[a] > 0)
                PM_TRY(smooth_node(&m, a, err));
    }
    pm_edit_flip(&m);
    const ptrdiff_t nt = m.nt;
    if (o->tolerance > 0)
        PM_TRY(pm_edit_hold(&m, o->tolerance, &off, err));
    const ptrdiff_t splits = m.nt - nt;
    PM_TRY(pm_edit_finish(&m, p, err));
    p->splits = splits;
    p->off = off;
done:
    pm_edit_release(&m);
    pm_map_free(map);
    return status;
}
