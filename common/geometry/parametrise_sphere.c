#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/surfaces.h"
#include "common/geometry/annulus.h"
#include "common/geometry/parametrise.h"
#include "common/geometry/parametrise_parts.h"
#include "common/geometry/remesh.h"

enum { REPAIRS = 200 };

struct sphere {
    const struct pm_trimesh *m;
    struct pm_star star;
    int32_t *image[3]; /* of every node in the mirror planes (nn), NULL: none */
    int32_t pole[2];
    uint8_t *out;    /* the poles (nn) */
    int32_t *rim[2]; /* their neighbours */
    double *area;    /* a third of the triangles around each node (nn) [mm2] */
    double *psi, *theta;
};

static void release(struct sphere *s)
{
    pm_star_release(&s->star);
    for (int j = 0; j < 3; j++)
        pm_free(s->image[j]);
    pm_free(s->out);
    pm_free(s->rim[0]);
    pm_free(s->rim[1]);
    pm_free(s->area);
    pm_free(s->psi);
    pm_free(s->theta);
}

static enum pm_status prepare(struct sphere *s, const int *mirror, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_trimesh *m = s->m;
    double low[3], high[3], n[3];

    PM_TRY(pm_star_new(m, &s->star, err));
    PM_TRY(pm_trimesh_check(m, &s->star, 0, err));
    pm_trimesh_box(m, low, high);
    const double size = fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    for (int j = 0; j < 3; j++)
        if (mirror != NULL && mirror[j]) {
            PM_TRY(PM_NEW(s->image[j], m->nn, err));
            PM_TRY(pm_trimesh_mirror(m, j, (low[j] + high[j]) / 2, 1e-7 * size, s->image[j], err));
        }
    PM_TRY(PM_NEW(s->out, m->nn, err));
    PM_TRY(PM_NEW(s->psi, m->nn, err));
    PM_TRY(PM_NEW(s->theta, m->nn, err));
    PM_TRY(PM_NEW(s->area, m->nn, err));
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        pm_triangle_area(m, t, n);
        for (int k = 0; k < 3; k++)
            s->area[m->tri[3 * t + k]] += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 3;
    }
done:
    return status;
}

/* Distance of all nodes from node `from` along edges. */
static enum pm_status walk(const struct sphere *s, int32_t from, double *distance,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t n = s->m->nn, head = 0, count = 1;
    int32_t *queue = NULL;
    uint8_t *waits = NULL;

    PM_TRY(PM_NEW(queue, n, err));
    PM_TRY(PM_NEW(waits, n, err));
    for (ptrdiff_t a = 0; a < n; a++)
        distance[a] = HUGE_VAL;
    distance[from] = 0;
    queue[0] = from;
    for (; count > 0; count--) { /* nodes whose distance fell wait once in a ring buffer */
        ptrdiff_t a = queue[head];
        head = (head + 1) % n;
        waits[a] = 0;
        for (ptrdiff_t k = s->star.ptr[a]; k < s->star.ptr[a + 1]; k++) {
            ptrdiff_t b = s->star.next[k];
            const double *p = &s->m->x[3 * a], *q = &s->m->x[3 * b];
            double d = distance[a] + hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
            if (!(d < distance[b]))
                continue;
            distance[b] = d;
            if (!waits[b]) {
                queue[(head + count++) % n] = (int32_t)b;
                waits[b] = 1;
            }
        }
    }
done:
    pm_free(queue);
    pm_free(waits);
    return status;
}

/* Poles lie on the mirror planes that contain the axis. */
static int may_be_pole(const struct sphere *s, ptrdiff_t a)
{
    return (s->image[0] == NULL || s->image[0][a] == a) &&
           (s->image[1] == NULL || s->image[1][a] == a);
}

/* From the highest node to the furthest one, and to the furthest from that; with a mirror plane
 * across the axis the highest node and its image. */
static enum pm_status choose_poles(struct sphere *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_trimesh *m = s->m;
    double *distance = NULL;
    int32_t p = -1, q;

    PM_TRY(PM_NEW(distance, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (may_be_pole(s, a) && (p < 0 || m->x[3 * a + 2] > m->x[3 * (ptrdiff_t)p + 2]))
            p = (int32_t)a;
    if (p < 0)
        PM_TRY(pm_fail(err, PM_INPUT, "no node of the surface lies on its mirror planes"));
    q = s->image[2] != NULL ? s->image[2][p] : p;
    for (int sweep = 0; s->image[2] == NULL && sweep < 3; sweep++) {
        int32_t far = p;
        PM_TRY(walk(s, p, distance, err));
        for (ptrdiff_t a = 0; a < m->nn; a++)
            if (may_be_pole(s, a) && distance[a] > distance[far])
                far = (int32_t)a;
        q = p;
        p = far;
    }
    int up = m->x[3 * (ptrdiff_t)p + 2] > m->x[3 * (ptrdiff_t)q + 2];
    s->pole[0] = up ? q : p;
    s->pole[1] = up ? p : q;
done:
    pm_free(distance);
    return status;
}

/* The neighbours of both poles, so that theta rises: clockwise from outside around the lower one.
 */
static enum pm_status ring_poles(struct sphere *s, ptrdiff_t nrim[2], struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (int side = 0; side < 2; side++) {
        ptrdiff_t p = s->pole[side], n = s->star.ptr[p + 1] - s->star.ptr[p];
        int32_t a = s->star.next[s->star.ptr[p]];
        PM_TRY(PM_NEW(s->rim[side], n, err));
        nrim[side] = n;
        for (ptrdiff_t k = 0; k < n; k++) {
            s->rim[side][side == 1 ? k : n - 1 - k] = a;
            a = pm_star_after(&s->star, p, a);
        }
        s->out[p] = 1;
    }
    for (ptrdiff_t k = 0; k < nrim[0]; k++)
        for (ptrdiff_t l = 0; l < nrim[1]; l++)
            if (s->rim[0][k] == s->rim[1][l] || s->rim[0][k] == s->pole[1])
                PM_TRY(pm_fail(err, PM_INPUT,
                               "surface of %td nodes is too coarse: the nodes furthest apart have "
                               "a common neighbour",
                               s->m->nn));
done:
    return status;
}

/* Mean of S_z over the area when psi is shifted by -shift. */
static double height(double shift, void *data)
{
    const struct sphere *s = data;
    double sum = 0, total = 0;

    for (ptrdiff_t a = 0; a < s->m->nn; a++) {
        if (s->out[a])
            continue;
        sum += s->area[a] * tanh(s->psi[a] - shift);
        total += s->area[a];
    }
    return sum / total;
}

static enum pm_status centre(struct sphere *s, double modulus, struct pm_err *err)
{
    gsl_function f = {.function = height, .params = s};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    double shift = modulus / 2;

    if (solver == NULL)
        return pm_fail(err, PM_SYSTEM, "GSL has no memory for a root finder");
    gsl_root_fsolver_set(solver, &f, 0, modulus);
    for (int it = 0; it < 100; it++) {
        gsl_root_fsolver_iterate(solver);
        shift = gsl_root_fsolver_root(solver);
        if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver),
                                   gsl_root_fsolver_x_upper(solver), 1e-12, 0) == GSL_SUCCESS)
            break;
    }
    gsl_root_fsolver_free(solver);
    for (ptrdiff_t a = 0; a < s->m->nn; a++)
        s->psi[a] -= shift;
    return PM_OK;
}

static void place(const struct sphere *s, double *S)
{
    for (ptrdiff_t a = 0; a < s->m->nn; a++) {
        S[3 * a] = cos(s->theta[a]) / cosh(s->psi[a]);
        S[3 * a + 1] = sin(s->theta[a]) / cosh(s->psi[a]);
        S[3 * a + 2] = tanh(s->psi[a]);
    }
    for (int side = 0; side < 2; side++) {
        double *p = &S[3 * (ptrdiff_t)s->pole[side]];
        p[0] = p[1] = 0;
        p[2] = side == 1 ? 1 : -1;
    }
}

/* Symmetric again after every change. */
static enum pm_status symmetrise(const struct sphere *s, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (int j = 0; j < 3; j++)
        if (s->image[j] != NULL)
            PM_TRY(pm_symmetrise_map(s->m, j, s->image[j], S, err));
done:
    return status;
}

static ptrdiff_t mark_folds(const struct sphere *s, const double *S, uint8_t *bad)
{
    ptrdiff_t folds = 0;

    memset(bad, 0, (size_t)s->m->nn);
    for (ptrdiff_t t = 0; t < s->m->nt; t++) {
        const int32_t *v = &s->m->tri[3 * t];
        if (pm_parameter_orientation(PM_SURFACE_SPHERE, &S[3 * (ptrdiff_t)v[0]],
                                     &S[3 * (ptrdiff_t)v[1]], &S[3 * (ptrdiff_t)v[2]]) > 0)
            continue;
        folds++;
        for (int k = 0; k < 3; k++)
            bad[v[k]] = !s->out[v[k]];
    }
    return folds;
}

/* Long triangles of a coarse mesh may fold on the sphere though they do not on the cylinder: their
 * nodes go to the middle of their neighbours. */
static enum pm_status unfold(const struct sphere *s, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    uint8_t *bad = NULL;
    double *T = NULL;
    ptrdiff_t folds = 1;

    PM_TRY(PM_NEW(bad, s->m->nn, err));
    PM_TRY(PM_NEW(T, 3 * s->m->nn, err));
    for (int sweep = 0; sweep < REPAIRS; sweep++) {
        folds = mark_folds(s, S, bad);
        if (folds == 0)
            break;
        memcpy(T, S, 3 * (size_t)s->m->nn * sizeof *T);
        for (ptrdiff_t a = 0; a < s->m->nn; a++) {
            double sum[3] = {0};
            if (!bad[a])
                continue;
            for (ptrdiff_t k = s->star.ptr[a]; k < s->star.ptr[a + 1]; k++)
                for (int j = 0; j < 3; j++)
                    sum[j] += S[3 * (ptrdiff_t)s->star.next[k] + j];
            const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
            for (int j = 0; j < 3 && length > 0; j++)
                T[3 * a + j] = sum[j] / length;
        }
        memcpy(S, T, 3 * (size_t)s->m->nn * sizeof *T);
        PM_TRY(symmetrise(s, S, err));
    }
    if (folds > 0)
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "%td of %td triangles fold on the sphere: the surface is too coarse or has "
                       "slivers",
                       folds, s->m->nt));
done:
    pm_free(bad);
    pm_free(T);
    return status;
}

enum pm_status pm_parametrise_sphere(const struct pm_trimesh *m, const int *mirror, double *S,
                                     struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct sphere s = {.m = m};
    ptrdiff_t nrim[2];
    double modulus;

    PM_TRY(prepare(&s, mirror, err));
    PM_TRY(choose_poles(&s, err));
    PM_TRY(ring_poles(&s, nrim, err));
    const struct pm_annulus annulus = {.mesh = m,
                                       .star = &s.star,
                                       .out = s.out,
                                       .rim = {s.rim[0], s.rim[1]},
                                       .nrim = {nrim[0], nrim[1]}};
    PM_TRY(pm_annulus_map(&annulus, s.psi, s.theta, &modulus, err));
    PM_TRY(centre(&s, modulus, err));
    pm_turn_theta(m, s.out, s.theta);
    place(&s, S);
    PM_TRY(symmetrise(&s, S, err));
    PM_TRY(unfold(&s, S, err));
done:
    release(&s);
    return status;
}
