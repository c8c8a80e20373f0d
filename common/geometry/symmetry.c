#include "common/geometry/symmetry.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double TWO_PI = 6.283185307179586476925;

/* y = Q x + t or, inverse, Q^T (x - t). Sums start at +0, so that sign flips are exact and no -0
 * appears. */
static void transform(const struct pm_symmetry *y, ptrdiff_t g, int inverse, int moved,
                      const double x[3], double out[3])
{
    const double *Q = y->Q[g], *t = y->t[g];

    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += inverse ? Q[3 * j + i] * (x[j] - (moved ? t[j] : 0)) : Q[3 * i + j] * x[j];
        out[i] = inverse || !moved ? sum : sum + t[i];
    }
}

/* Averages x over the operations that keep control point i: an even number of sign flips gives
 * exact zeros. */
static void settle(const struct pm_surfaces *s, ptrdiff_t i, int moved, double x[3])
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    ptrdiff_t N = s->offset[s->ns], kept = 0;
    double sum[3] = {0}, image[3];

    for (ptrdiff_t g = 0; g < y->nops; g++) {
        if (s->perm[g * N + i] != i)
            continue;
        kept++;
        transform(y, g, 0, moved, x, image);
        for (int j = 0; j < 3; j++)
            sum[j] += image[j] - x[j];
    }
    for (int j = 0; j < 3; j++)
        x[j] += sum[j] / (double)kept;
}

/* Deviations from the present value are averaged: a symmetric value stays bit for bit as it is. */
static void average(const struct pm_surfaces *s, ptrdiff_t i, int moved, const double *x,
                    double mean[3])
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    ptrdiff_t N = s->offset[s->ns];
    double sum[3] = {0}, image[3];

    for (ptrdiff_t g = 0; g < y->nops; g++) {
        transform(y, g, 1, moved, &x[3 * (ptrdiff_t)s->perm[g * N + i]], image);
        for (int j = 0; j < 3; j++)
            sum[j] += image[j] - x[3 * i + j];
    }
    for (int j = 0; j < 3; j++)
        mean[j] = x[3 * i + j] + sum[j] / (double)y->nops;
    settle(s, i, moved, mean);
}

static void symmetrise(const struct pm_surfaces *s, int moved, double *x)
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    ptrdiff_t N = s->offset[s->ns];

    for (ptrdiff_t i = 0; i < N; i++) {
        ptrdiff_t first = i;
        double mean[3], image[3];

        for (ptrdiff_t g = 0; g < y->nops; g++)
            first = s->perm[g * N + i] < first ? s->perm[g * N + i] : first;
        if (first != i)
            continue;
        average(s, i, moved, x, mean);
        for (ptrdiff_t g = y->nops - 1; g >= 0;
             g--) { /* the first operation to a point has the last word */
            transform(y, g, 0, moved, mean, image);
            settle(s, s->perm[g * N + i], moved, image);
            memcpy(&x[3 * (ptrdiff_t)s->perm[g * N + i]], image, sizeof image);
        }
    }
}

void pm_symmetrise_points(const struct pm_surfaces *s, double *phi)
{
    symmetrise(s, 1, phi);
}

void pm_symmetrise_vectors(const struct pm_surfaces *s, double *v)
{
    symmetrise(s, 0, v);
    for (ptrdiff_t k = 0; k < s->ns; k++)
        for (ptrdiff_t i = 0; i < 3 * s->s[k].n; i++)
            if (!s->s[k].free[i])
                v[3 * s->offset[k] + i] = 0;
}

double pm_symmetry_defect(const struct pm_surfaces *s, const double *phi)
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    ptrdiff_t N = s->offset[s->ns];
    double defect = 0;

    for (ptrdiff_t g = 0; g < y->nops; g++)
        for (ptrdiff_t i = 0; i < N; i++) {
            double image[3];
            const double *to = &phi[3 * (ptrdiff_t)s->perm[g * N + i]];
            transform(y, g, 0, 1, &phi[3 * i], image);
            for (int j = 0; j < 3; j++)
                image[j] -= to[j];
            defect =
                fmax(defect, sqrt(image[0] * image[0] + image[1] * image[1] + image[2] * image[2]));
        }
    return defect;
}

/* The surface of a global control point. */
static ptrdiff_t owner(const struct pm_surfaces *s, ptrdiff_t i)
{
    ptrdiff_t k = 0;

    while (i >= s->offset[k + 1])
        k++;
    return k;
}

enum pm_status pm_symmetrise_reference(struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t nops = s->pcase.symmetry.nops, N = s->offset[s->ns];
    double *Phi = NULL;

    PM_TRY(PM_NEW(Phi, 3 * N, err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        memcpy(&Phi[3 * s->offset[k]], s->s[k].Phi, 3 * (size_t)s->s[k].n * sizeof *Phi);
    symmetrise(s, 0, Phi);
    for (ptrdiff_t k = 0; k < s->ns; k++)
        if (s->s[k].type == PM_SURFACE_SPHERE)
            memcpy(s->s[k].Phi, &Phi[3 * s->offset[k]], 3 * (size_t)s->s[k].n * sizeof *Phi);
    for (ptrdiff_t i = N - 1; i >= 0; i--) { /* the lowest of an orbit has the last word */
        ptrdiff_t from = owner(s, i);
        for (ptrdiff_t g = 0; g < nops; g++) {
            ptrdiff_t j = s->perm[g * N + i], to = owner(s, j);
            s->s[to].d0[j - s->offset[to]] = s->s[from].d0[i - s->offset[from]];
        }
    }
done:
    pm_free(Phi);
    return status;
}

/* Control point (a, b) of the tube under Q, by the angle of a; -1 where the grid has no such point.
 */
static ptrdiff_t tube_image(const struct pm_surface *s, const double Q[9], ptrdiff_t i)
{
    double t = TWO_PI * (double)(i % s->nu) / (double)s->nu;
    double u = Q[0] * cos(t) + Q[1] * sin(t), v = Q[3] * cos(t) + Q[4] * sin(t);
    double a = atan2(v, u) / TWO_PI * (double)s->nu, whole = round(a);
    ptrdiff_t b = i / s->nu;

    if (fabs(a - whole) > 1e-6)
        return -1;
    return ((ptrdiff_t)whole + s->nu) % s->nu + s->nu * (Q[8] < 0 ? s->nv - 1 - b : b);
}

static ptrdiff_t closed_image(const struct pm_surface *to, const double x[3], double tolerance)
{
    for (ptrdiff_t j = 0; j < to->n; j++) {
        const double *y = &to->phi[3 * j];
        if (fabs(x[0] - y[0]) < tolerance && fabs(x[1] - y[1]) < tolerance &&
            fabs(x[2] - y[2]) < tolerance)
            return j;
    }
    return -1;
}

enum pm_status pm_symmetry_find(struct pm_surfaces *s, double tolerance, struct pm_err *err)
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    enum pm_status status = PM_OK;
    ptrdiff_t N = s->offset[s->ns];

    pm_free(s->perm);
    PM_TRY(PM_NEW(s->perm, y->nops * N, err));
    for (ptrdiff_t g = 0; g < y->nops; g++)
        for (ptrdiff_t i = 0; i < N; i++) {
            ptrdiff_t k = owner(s, i), l = i - s->offset[k], to, j;
            double image[3];
            transform(y, g, 0, 1, &s->s[k].phi[3 * l], image);
            to = k == 0 ? 0 : y->chamber[g][k - 1] + 1;
            j = s->s[k].type == PM_SURFACE_BSPLINE ? tube_image(&s->s[k], y->Q[g], l)
                                                   : closed_image(&s->s[to], image, tolerance);
            if (j < 0)
                PM_TRY(pm_fail(
                    err, PM_INPUT,
                    "control point %td of surface %td has no image under operation %td of the "
                    "symmetry group",
                    l, k, g));
            s->perm[g * N + i] = (int32_t)(s->offset[to] + j);
        }
done:
    return status;
}

ptrdiff_t pm_symmetry_source(const struct pm_symmetry *y, ptrdiff_t k, ptrdiff_t *g)
{
    for (ptrdiff_t r = 0; r < k; r++)
        for (*g = 0; *g < y->nops; ++*g)
            if (y->chamber[*g][r] == k)
                return r;
    *g = 0;
    return k;
}

void pm_symmetry_points(const struct pm_symmetry *y, ptrdiff_t g, ptrdiff_t n, const double *x,
                        double *out)
{
    for (ptrdiff_t i = 0; i < n; i++)
        transform(y, g, 0, 1, &x[3 * i], &out[3 * i]);
}

enum pm_status pm_symmetry_image(const struct pm_symmetry *y, ptrdiff_t g,
                                 const struct pm_surface *from, struct pm_surface *to,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double *Q = y->Q[g];
    double det = Q[0] * (Q[4] * Q[8] - Q[5] * Q[7]) - Q[1] * (Q[3] * Q[8] - Q[5] * Q[6]) +
                 Q[2] * (Q[3] * Q[7] - Q[4] * Q[6]);

    PM_TRY(pm_surface_new(from->type, from->n, from->nt, to, err));
    for (ptrdiff_t i = 0; i < from->n; i++)
        transform(y, g, 0, 0, &from->Phi[3 * i], &to->Phi[3 * i]);
    pm_symmetry_points(y, g, from->n, from->phi, to->phi);
    memcpy(to->free, from->free, 3 * (size_t)from->n);
    memcpy(to->d0, from->d0, (size_t)from->n * sizeof *to->d0);
    memcpy(to->tri, from->tri, 3 * (size_t)from->nt * sizeof *to->tri);
    for (ptrdiff_t k = 0; det < 0 && k < to->nt; k++) {
        to->tri[3 * k + 1] = from->tri[3 * k + 2];
        to->tri[3 * k + 2] = from->tri[3 * k + 1];
    }
done:
    return status;
}
