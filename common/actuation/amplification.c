#include "common/actuation/amplification.h"

#include <math.h>
#include <string.h>

static const double STRENGTH = 20;

/* Factors of the rows of J, 0 where they are not selected. */
static void scale_rows(const struct pm_case *c, double scale[6])
{
    int translations = 0;
    for (int i = 0; i < c->ndofs; i++)
        translations += c->dofs[i] < 3;
    memset(scale, 0, 6 * sizeof *scale);
    for (int i = 0; i < c->ndofs; i++)
        scale[c->dofs[i]] = c->dofs[i] < 3 || translations == 0 ? 1
                            : c->lever > 0                      ? c->lever
                                                                : c->height;
}

/* ln |A_g| */
static double size_of(const double scale[6], ptrdiff_t nc, const double *J)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < 6 * nc; i++)
        sum += scale[i / nc] * scale[i / nc] * J[i] * J[i];
    return sum > 0 ? log(sum) / 2 : -HUGE_VAL;
}

double pm_amplification(const struct pm_case *c, ptrdiff_t ng, const double *J, double *largest,
                        double *df_dJ)
{
    const ptrdiff_t nc = c->nchambers, n = 6 * nc;
    double scale[6], mean = 0, most = -INFINITY, sum = 0, excesses = 0;

    scale_rows(c, scale);
    for (ptrdiff_t g = 0; g < ng; g++) {
        const double size = size_of(scale, nc, J + n * g);
        mean += size / (double)ng;
        most = fmax(most, size);
    }
    *largest = isfinite(mean) ? exp(most - mean) : 1;
    if (df_dJ != NULL)
        memset(df_dJ, 0, (size_t)(n * ng) * sizeof *df_dJ);
    if (!(c->amplification_max > 0) || !isfinite(mean))
        return 1;
    const double limit = mean + log(c->amplification_max);
    for (ptrdiff_t g = 0; g < ng; g++) {
        const double excess = fmax(size_of(scale, nc, J + n * g) - limit, 0);
        sum += excess * excess;
        excesses += excess;
    }
    const double f = exp(-STRENGTH * sum);
    for (ptrdiff_t g = 0; g < ng && df_dJ != NULL; g++) {
        const double size = size_of(scale, nc, J + n * g), excess = fmax(size - limit, 0);
        const double slope = -2 * STRENGTH * f * (excess - excesses / (double)ng) * exp(-2 * size);
        for (ptrdiff_t i = 0; i < n; i++)
            df_dJ[n * g + i] = slope * scale[i / nc] * scale[i / nc] * J[n * g + i];
    }
    return f;
}
