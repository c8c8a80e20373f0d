#include "common/geometry/symmetry.h"

#include <math.h>
#include <string.h>

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

/* Deviations from the present value are averaged: a symmetric value stays bit for bit as it is, and
 * an even group of sign flips gives exact zeros on its planes. */
static void average(const struct pm_surfaces *s, ptrdiff_t i, int moved, const double *x,
                    double mean[3])
{
    const struct pm_symmetry *y = &s->pcase.symmetry;
    ptrdiff_t N = s->offset[s->ns], fixed = 0;
    double sum[3] = {0}, image[3];

    for (ptrdiff_t g = 0; g < y->nops; g++) {
        transform(y, g, 1, moved, &x[3 * (ptrdiff_t)s->perm[g * N + i]], image);
        for (int j = 0; j < 3; j++)
            sum[j] += image[j] - x[3 * i + j];
    }
    for (int j = 0; j < 3; j++) {
        mean[j] = x[3 * i + j] + sum[j] / (double)y->nops;
        sum[j] = 0;
    }
    for (ptrdiff_t g = 0; g < y->nops; g++) {
        if (s->perm[g * N + i] != i)
            continue;
        fixed++;
        transform(y, g, 0, moved, mean, image);
        for (int j = 0; j < 3; j++)
            sum[j] += image[j] - mean[j];
    }
    for (int j = 0; j < 3; j++)
        mean[j] += sum[j] / (double)fixed;
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
