#include "common/geometry/springs.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/remesh_edit.h"

/* Sum of |x_a - x_b|^2 / 2 over the edges of all triangles: an edge of two counts once. */
static double energy(const struct pm_edit *m)
{
    double sum = 0;

    for (ptrdiff_t t = 0; t < m->nt; t++)
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            const double *a = m->x + 3 * (ptrdiff_t)m->tri[3 * t + k],
                         *b = m->x + 3 * (ptrdiff_t)m->tri[3 * t + (k + 1) % 3];
            for (int i = 0; i < 3; i++)
                sum += (a[i] - b[i]) * (a[i] - b[i]) / 2;
        }
    return sum;
}

static int bits(unsigned rim)
{
    return (int)(rim & 1) + (int)(rim >> 1 & 1) + (int)(rim >> 2 & 1);
}

/* A node on as many mirror planes as there are: seen from it the missing part has no volume. */
static ptrdiff_t apex(const struct pm_edit *m)
{
    ptrdiff_t best = 0;

    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->degree[a] > 0 && (m->degree[best] == 0 || bits(m->rim[a]) > bits(m->rim[best])))
            best = a;
    return best;
}

static double volume(const struct pm_edit *m, const double from[3])
{
    double sum = 0;

    for (ptrdiff_t t = 0; t < m->nt; t++) {
        double p[3][3];
        if (m->tri[3 * t] < 0)
            continue;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                p[k][i] = m->x[3 * (ptrdiff_t)m->tri[3 * t + k] + i] - from[i];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
               p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum / 6;
}

/* Way of node a to the mean of its neighbours; those off its mirror planes count for their images
 * too. */
static void way(const struct pm_edit *m, ptrdiff_t a, double d[3])
{
    double sum = 0;

    d[0] = d[1] = d[2] = 0;
    for (int k = 0; k < m->degree[a]; k++) { /* a neighbour is in two triangles, on a rim in one */
        const int32_t *v = m->tri + 3 * (ptrdiff_t)m->around[a * PM_EDIT_DEGREE + k];
        for (int j = 0; j < 3; j++) {
            if (v[j] == a)
                continue;
            for (int i = 0; i < 3; i++)
                d[i] += m->x[3 * (ptrdiff_t)v[j] + i] - m->x[3 * a + i];
            sum += 1;
        }
    }
    for (int i = 0; i < 3; i++)
        d[i] /= sum;
}

/* New parameter of node a, S + J^+ d / 2. */
static enum pm_status advance(struct pm_edit *m, ptrdiff_t a, double S[3], struct pm_err *err)
{
    double d[3], r_a[6], g[3] = {0}, f[2] = {0}, step[2], det;
    enum pm_status status =
        pm_map_point(m->map, m->phi, m->S + 3 * a, &m->basis, NULL, r_a, NULL, err);

    way(m, a, d);
    for (int i = 0; i < 3; i++) {
        g[0] += r_a[i] * r_a[i];
        g[1] += r_a[i] * r_a[3 + i];
        g[2] += r_a[3 + i] * r_a[3 + i];
        f[0] += r_a[i] * d[i] / 2;
        f[1] += r_a[3 + i] * d[i] / 2;
    }
    det = g[0] * g[2] - g[1] * g[1];
    step[0] = det > 0 ? (g[2] * f[0] - g[1] * f[1]) / det : 0;
    step[1] = det > 0 ? (g[0] * f[1] - g[1] * f[0]) / det : 0;
    pm_map_move(m->type, m->S + 3 * a, step, S);
    pm_rim_constrain(m->type, m->rim[a], S);
    return status;
}

/* Moves all nodes to S (nn x 3), which gets their former parameters. */
static enum pm_status place_all(struct pm_edit *m, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (ptrdiff_t a = 0; a < m->nn && status == PM_OK; a++)
        for (int i = 0; i < 3; i++) {
            const double old = m->S[3 * a + i];
            m->S[3 * a + i] = S[3 * a + i];
            S[3 * a + i] = old;
        }
    for (ptrdiff_t a = 0; a < m->nn && status == PM_OK; a++)
        if (m->degree[a] > 0)
            status = pm_edit_place(m, a, err);
    return status;
}

static int folded(const struct pm_edit *m)
{
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = m->tri + 3 * t;
        if (v[0] >= 0 &&
            !(pm_parameter_orientation(m->type, m->S + 3 * (ptrdiff_t)v[0],
                                       m->S + 3 * (ptrdiff_t)v[1], m->S + 3 * (ptrdiff_t)v[2]) > 0))
            return 1;
    }
    return 0;
}

static enum pm_status relax(struct pm_edit *m, const struct pm_springs_opts *o, double *S,
                            struct pm_err *err)
{
    enum { FLIP_EVERY = 10 };
    static const double still = 1e-4;
    enum pm_status status = PM_OK;
    const ptrdiff_t centre = apex(m);
    const double V0 = volume(m, m->x + 3 * centre);
    double E = energy(m);

    for (int sweep = 0; sweep < o->sweeps; sweep++) {
        memcpy(S, m->S, 3 * (size_t)m->nn * sizeof *S);
        for (ptrdiff_t a = 0; a < m->nn; a++)
            if (m->degree[a] > 0)
                PM_TRY(advance(m, a, S + 3 * a, err));
        PM_TRY(place_all(m, S, err));
        if (folded(m) || fabs(volume(m, m->x + 3 * centre) / V0 - 1) > o->volume) {
            PM_TRY(place_all(m, S, err));
            break;
        }
        const double now = energy(m);
        const ptrdiff_t flips = sweep % FLIP_EVERY == FLIP_EVERY - 1 ? pm_edit_flip(m) : 0;
        if (flips == 0 && E - now < still * E)
            break;
        E = flips > 0 ? energy(m) : now;
    }
done:
    return status;
}

/* Splits and collapses until neither finds an edge, at most 20 times. */
static enum pm_status resize(struct pm_edit *m, double size, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t count = 1;

    for (ptrdiff_t a = 0; a < m->nn; a++)
        m->size[a] = size;
    for (int pass = 0; pass < 20 && count > 0; pass++) {
        PM_TRY(pm_edit_split(m, pm_edit_longest, &count, err));
        count += pm_edit_collapse(m);
        pm_edit_flip(m);
    }
done:
    return status;
}

enum pm_status pm_springs(const struct pm_surface *s, int surface, const struct pm_springs_opts *o,
                          struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_edit m = {0};
    double *S = NULL;

    *p = (struct pm_patch){0};
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(pm_edit_init(&m, s, map, surface, err));
    for (int j = 0; j < 3; j++)
        if (o->mirror[j])
            PM_TRY(pm_edit_halve(&m, j, err));
    if (o->size > 0)
        PM_TRY(resize(&m, o->size, err));
    PM_TRY(PM_NEW(S, 3 * m.nn, err));
    pm_edit_flip(&m);
    PM_TRY(relax(&m, o, S, err));
    PM_TRY(pm_edit_finish(&m, p, err));
done:
    pm_free(S);
    pm_edit_release(&m);
    pm_map_free(map);
    return status;
}
