#include "common/geometry/tube.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/surface_map.h"

static const double TWO_PI = 6.283185307179586476925;

static void triangulate(struct pm_surface *s)
{
    for (ptrdiff_t b = 0; b + 1 < s->nv; b++)
        for (ptrdiff_t a = 0; a < s->nu; a++) {
            int32_t i = (int32_t)(a + s->nu * b), j = (int32_t)((a + 1) % s->nu + s->nu * b);
            int32_t k = (int32_t)(i + s->nu), l = (int32_t)(j + s->nu);
            int32_t even[6] = {i, j, l, i, l, k}, odd[6] = {i, j, k, j, l, k};
            memcpy(&s->tri[3 * s->nt], (a + b) % 2 == 0 ? even : odd, sizeof even);
            s->nt += 2;
        }
}

enum pm_status pm_tube_seed(ptrdiff_t nu, ptrdiff_t nv, struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    PM_TRY(pm_surface_new(PM_SURFACE_BSPLINE, nu * nv, 2 * nu * (nv - 1), s, err));
    s->nu = nu;
    s->nv = nv;
    s->nt = 0; /* as they come */
    for (ptrdiff_t i = 0; i < s->n; i++) {
        ptrdiff_t b = i / nu;
        double t = TWO_PI * (double)(i % nu) / (double)nu, v = 0;
        uint8_t *f = &s->free[3 * i];
        for (ptrdiff_t k = b + 1; k <= b + 3;
             k++) /* Greville abscissa of row b: knots (k - 3) / (nv - 3) */
            v += fmin(fmax((double)(k - 3), 0), (double)(nv - 3)) / (3.0 * (double)(nv - 3));
        s->Phi[3 * i] = cos(t);
        s->Phi[3 * i + 1] = sin(t);
        s->Phi[3 * i + 2] = v;
        f[0] = f[1] = b > 0 && b + 1 < nv;
        f[2] = b > 1 && b + 2 < nv;
    }
    triangulate(s);
done:
    return status;
}

static double distance(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

enum pm_status pm_tube_edges(const struct pm_surface *s, double mean[2], double longest[2],
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *x = NULL, sum[2] = {0};
    ptrdiff_t nu = s->nu, count[2] = {0};

    longest[0] = longest[1] = 0;
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(x, 3 * s->n, err));
    for (ptrdiff_t i = 0; i < s->n; i++)
        PM_TRY(pm_map_point(map, s->phi, &s->Phi[3 * i], &work, &x[3 * i], NULL, NULL, err));
    for (ptrdiff_t i = 0; i < s->n; i++) {
        ptrdiff_t b = i / nu, next[2] = {(i + 1) % nu + nu * b, i + nu};
        for (int k = 0; k < 2; k++) {
            double l;
            if (k == 1 && (b < 2 || b + 3 >= s->nv))
                continue;
            l = distance(&x[3 * i], &x[3 * next[k]]);
            longest[k] = fmax(longest[k], l);
            sum[k] += l;
            count[k]++;
        }
    }
    for (int k = 0; k < 2; k++) {
        mean[k] = count[k] > 0 ? sum[k] / (double)count[k] : 0;
        longest[k] = mean[k] > 0 ? longest[k] / mean[k] : 1;
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    return status;
}
