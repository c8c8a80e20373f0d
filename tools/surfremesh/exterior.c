#include "tools/surfremesh/exterior.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/record.h"
#include "common/geometry/surface_map.h"
#include "common/geometry/tube.h"

enum { SWEEPS = 300, AROUND = 12, CROSS = 48, FINE = 8 };

static const double TWO_PI = 6.283185307179586476925;

enum pm_status pm_exterior_unevenness(const struct pm_surface *s, double *ratio, struct pm_err *err)
{
    double mean[2], longest[2];
    enum pm_status status = pm_tube_edges(s, mean, longest, err);

    *ratio = fmax(longest[0], longest[1]);
    return status;
}

/* n times the ratio, at least n: what needed closer control points may need them again. */
static ptrdiff_t count(ptrdiff_t n, double ratio, double *off)
{
    *off = fmax(*off, ratio - 1);
    return (ptrdiff_t)round((double)n * fmax(ratio, 1));
}

enum pm_status pm_exterior_counts(const struct pm_surface *s, ptrdiff_t *nu, ptrdiff_t *nv,
                                  double *off, struct pm_err *err)
{
    double mean[2], longest[2];
    enum pm_status status = pm_tube_edges(s, mean, longest, err);

    *nu = s->nu;
    *nv = s->nv;
    *off = 0;
    if (status != PM_OK)
        return status;
    if (s->spacing[0] > 0 && s->nu % AROUND == 0) {
        *nu = AROUND * count(s->nu / AROUND, mean[0] / s->spacing[0], off);
        *off = *nu == s->nu ? 0 : *off; /* the next multiple is too far */
    }
    if (s->spacing[1] > 0)
        *nv = count(s->nv - 3, mean[1] / s->spacing[1], off) + 3;
    return PM_OK;
}

/* A quarter of the tangential way of control point i to the mean of its neighbours, those further
 * off weighing more (the gradient of the sum of edges^4): with equal weights the grid would be
 * harmonic and leave what protrudes bare. In parameters. */
static void advance(const struct pm_surface *to, ptrdiff_t i, const double r_a[6], double step[2])
{
    const double *x = to->phi, *v = to->Phi, pitch = (double)(to->nv - 3);
    ptrdiff_t nu = to->nu, row = i / nu * nu;
    const double *n[4] = {&x[3 * (row + (i + 1) % nu)], &x[3 * (row + (i + nu - 1) % nu)],
                          &x[3 * (i + nu)], &x[3 * (i - nu)]};
    double g[3] = {0}, f[2] = {0}, way[3] = {0}, sum = 0, det;

    /* parts of a pitch between the rows: 2/3 next to a rim's own */
    const double part[4] = {1, 1, pitch * (v[3 * (i + nu) + 2] - v[3 * i + 2]),
                            pitch * (v[3 * i + 2] - v[3 * (i - nu) + 2])};

    for (int k = 0; k < 4; k++) {
        double e[3] = {n[k][0] - x[3 * i], n[k][1] - x[3 * i + 1], n[k][2] - x[3 * i + 2]};
        double weight = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) / (part[k] * part[k] * part[k]);
        for (int j = 0; j < 3; j++)
            way[j] += weight * e[j];
        sum += weight;
    }
    for (int j = 0; j < 3; j++) {
        double d = way[j] / sum;
        g[0] += r_a[j] * r_a[j];
        g[1] += r_a[j] * r_a[3 + j];
        g[2] += r_a[3 + j] * r_a[3 + j];
        f[0] += r_a[j] * d;
        f[1] += r_a[3 + j] * d;
    }
    det = g[0] * g[2] - g[1] * g[1];
    step[0] = (g[2] * f[0] - g[1] * f[1]) / det / 4;
    step[1] = (g[0] * f[1] - g[1] * f[0]) / det / 4;
}

/* Lengths of the old surface's lines along and around, in parts of their mean: length[k] at k / n
 * of v (axis 1) or of the full angle (axis 0), the mean over CROSS lines. */
static enum pm_status lengths(const struct pm_surface *s, const struct pm_map *map, int axis,
                              ptrdiff_t n, double *length, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis work = {0};

    memset(length, 0, (size_t)(n + 1) * sizeof *length);
    for (int line = 0; line < CROSS; line++) {
        double last[3];
        for (ptrdiff_t k = 0; k <= n; k++) {
            const double at = (double)k / (double)n, across = (line + 0.5) / CROSS;
            const double t = TWO_PI * (axis == 0 ? at : across), v = axis == 0 ? across : at;
            const double S[3] = {cos(t), sin(t), v};
            double x[3];
            PM_TRY(pm_map_point(map, s->phi, S, &work, x, NULL, NULL, err));
            if (k > 0)
                length[k] += hypot(hypot(x[0] - last[0], x[1] - last[1]), x[2] - last[2]);
            memcpy(last, x, sizeof last);
        }
    }
    for (ptrdiff_t k = 1; k <= n; k++)
        length[k] += length[k - 1];
    for (ptrdiff_t k = 0; k <= n; k++)
        length[k] /= length[n];
done:
    pm_basis_release(&work);
    return status;
}

/* Where the length has this part of the whole. */
static double inverse(ptrdiff_t n, const double *length, double part)
{
    ptrdiff_t k = 1;

    while (k < n && length[k] < part)
        k++;
    return ((double)(k - 1) + (part - length[k - 1]) / (length[k] - length[k - 1])) / (double)n;
}

/* Rows at equal mean distances, and, where the rims change too, columns. */
static enum pm_status equalise(const struct pm_surface *s, const struct pm_map *map,
                               const struct pm_surface *to, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t fine[2] = {FINE * s->nu, FINE * s->nv};
    double *length[2] = {NULL};

    for (int axis = to->nu == s->nu; axis < 2; axis++) {
        PM_TRY(PM_NEW(length[axis], fine[axis] + 1, err));
        PM_TRY(lengths(s, map, axis, fine[axis], length[axis], err));
    }
    for (ptrdiff_t i = 0; i < to->n; i++) {
        const double part = (double)(i % to->nu) / (double)to->nu;
        const double t = TWO_PI * (length[0] != NULL ? inverse(fine[0], length[0], part) : part);
        const int held = i / to->nu == 0 || i / to->nu == to->nv - 1;
        S[3 * i] = cos(t);
        S[3 * i + 1] = sin(t);
        if (!held)
            S[3 * i + 2] = inverse(fine[1], length[1], to->Phi[3 * i + 2]);
    }
done:
    pm_free(length[0]);
    pm_free(length[1]);
    return status;
}

/* Moves the parameters S of the grid along the old surface; leaves the places in to->phi. */
static enum pm_status relax(const struct pm_surface *s, const struct pm_map *map,
                            struct pm_surface *to, double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis work = {0};
    double *step = NULL, *r_a = NULL;
    const ptrdiff_t first = 2 * to->nu, last = to->n - 2 * to->nu;

    PM_TRY(PM_NEW(step, 2 * to->n, err));
    PM_TRY(PM_NEW(r_a, 6 * to->n, err));
    for (int sweep = 0; sweep <= SWEEPS; sweep++) { /* Jacobi: keeps the symmetry */
        for (ptrdiff_t i = 0; i < to->n; i++)
            PM_TRY(pm_map_point(map, s->phi, &S[3 * i], &work, &to->phi[3 * i], &r_a[6 * i], NULL,
                                err));
        for (ptrdiff_t i = first; i < last && sweep < SWEEPS; i++)
            advance(to, i, &r_a[6 * i], &step[2 * i]);
        for (ptrdiff_t i = first; i < last && sweep < SWEEPS; i++) {
            double moved[3];
            pm_map_move(s->type, &S[3 * i], &step[2 * i], moved);
            memcpy(&S[3 * i], moved, sizeof moved);
        }
    }
done:
    pm_basis_release(&work);
    pm_free(step);
    pm_free(r_a);
    return status;
}

/* Control points of a rim from its points x (nu x 3): (P_{a-1} + 4 P_a + P_{a+1}) / 6 = x_a. */
static enum pm_status rim(ptrdiff_t nu, double *x, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    gsl_vector *v[4] = {NULL}; /* diagonal, beside it, right-hand side, solution */

    for (int k = 0; k < 4; k++)
        if ((v[k] = gsl_vector_alloc((size_t)nu)) == NULL)
            PM_TRY(pm_fail(err, PM_SYSTEM, "out of memory: a rim of %td control points", nu));
    gsl_vector_set_all(v[0], 4.0 / 6);
    gsl_vector_set_all(v[1], 1.0 / 6);
    for (int j = 0; j < 3; j++) {
        for (size_t a = 0; a < (size_t)nu; a++)
            gsl_vector_set(v[2], a, x[3 * a + (size_t)j]);
        if (gsl_linalg_solve_symm_cyc_tridiag(v[0], v[1], v[2], v[3]) != 0)
            PM_TRY(pm_fail(err, PM_NUMERIC, "cannot interpolate a rim of %td control points", nu));
        for (size_t a = 0; a < (size_t)nu; a++)
            x[3 * a + (size_t)j] = gsl_vector_get(v[3], a);
    }
done:
    for (int k = 0; k < 4; k++)
        if (v[k] != NULL)
            gsl_vector_free(v[k]);
    return status;
}

static enum pm_status rims(const struct pm_surface *s, double height, struct pm_surface *to,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const size_t row = 3 * (size_t)s->nu * sizeof(double);

    if (s->nu != to->nu) {
        PM_TRY(rim(to->nu, to->phi, err));
        PM_TRY(rim(to->nu, &to->phi[3 * (to->n - to->nu)], err));
    }
    for (ptrdiff_t i = 0; i < to->n; i++)
        if (!to->free[3 * i + 2])
            to->phi[3 * i + 2] = height * to->Phi[3 * i + 2];
    if (s->nu == to->nu) { /* bit for bit */
        memcpy(to->phi, s->phi, row);
        memcpy(&to->phi[3 * (to->n - to->nu)], &s->phi[3 * (s->n - s->nu)], row);
    }
done:
    return status;
}

enum pm_status pm_exterior_spread(const struct pm_surface *s, double height, ptrdiff_t nu,
                                  ptrdiff_t nv, struct pm_surface *to, double **carried,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;

    *carried = NULL;
    PM_TRY(pm_tube_seed(nu, nv, to, err));
    memcpy(to->spacing, s->spacing, sizeof to->spacing);
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(pm_copy_array(carried, to->Phi, 3 * to->n, sizeof *to->Phi, err));
    PM_TRY(equalise(s, map, to, *carried, err));
    PM_TRY(relax(s, map, to, *carried, err));
    PM_TRY(rims(s, height, to, err));
done:
    pm_map_free(map);
    return status;
}
