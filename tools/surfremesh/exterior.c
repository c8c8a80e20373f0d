#include "tools/surfremesh/exterior.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

enum { SWEEPS = 300 };

static double distance(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

enum pm_status pm_exterior_unevenness(const struct pm_surface *s, double *ratio, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *x = NULL, longest[2] = {0}, sum[2] = {0};
    ptrdiff_t nu = s->nu, count[2] = {0};

    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(x, 3 * s->n, err));
    for (ptrdiff_t i = 0; i < s->n; i++)
        PM_TRY(pm_map_point(map, s->phi, &s->Phi[3 * i], &work, &x[3 * i], NULL, NULL, err));
    for (ptrdiff_t i = 0; i < s->n; i++) {
        ptrdiff_t b = i / nu, next[2] = {(i + 1) % nu + nu * b, i + nu};
        if (i % nu + 1 < nu)
            next[0] = i + 1;
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
    *ratio = fmax(longest[0] * (double)count[0] / sum[0],
                  count[1] > 0 ? longest[1] * (double)count[1] / sum[1] : 0);
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    return status;
}

/* Half of the tangential way of control point i to the mean of its neighbours, in parameters. */
static enum pm_status advance(const struct pm_surface *s, const struct pm_map *map, const double *S,
                              const double *x, ptrdiff_t i, struct pm_basis *work, double step[2],
                              struct pm_err *err)
{
    ptrdiff_t nu = s->nu, row = i / nu * nu;
    const double *n[4] = {&x[3 * (row + (i + 1) % nu)], &x[3 * (row + (i + nu - 1) % nu)],
                          &x[3 * (i + nu)], &x[3 * (i - nu)]};
    double r_a[6], g[3] = {0}, f[2] = {0}, det;
    enum pm_status status = pm_map_point(map, s->phi, &S[3 * i], work, NULL, r_a, NULL, err);

    for (int j = 0; j < 3; j++) {
        double d = (n[0][j] + n[1][j] + n[2][j] + n[3][j]) / 4 - x[3 * i + j];
        g[0] += r_a[j] * r_a[j];
        g[1] += r_a[j] * r_a[3 + j];
        g[2] += r_a[3 + j] * r_a[3 + j];
        f[0] += r_a[j] * d;
        f[1] += r_a[3 + j] * d;
    }
    det = g[0] * g[2] - g[1] * g[1];
    step[0] = (g[2] * f[0] - g[1] * f[1]) / det / 2;
    step[1] = (g[0] * f[1] - g[1] * f[0]) / det / 2;
    return status;
}

enum pm_status pm_exterior_relax(const struct pm_surface *s, double *shift, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *S = NULL, *x = NULL, *step = NULL;
    ptrdiff_t first = 2 * s->nu, last = s->n - 2 * s->nu;

    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(S, 3 * s->n, err));
    PM_TRY(PM_NEW(x, 3 * s->n, err));
    PM_TRY(PM_NEW(step, 2 * s->n, err));
    memcpy(S, s->Phi, 3 * (size_t)s->n * sizeof *S);
    memset(shift, 0, 2 * (size_t)s->n * sizeof *shift);
    for (int sweep = 0; sweep < SWEEPS; sweep++) { /* Jacobi: keeps the symmetry */
        for (ptrdiff_t i = 0; i < s->n; i++)
            PM_TRY(pm_map_point(map, s->phi, &S[3 * i], &work, &x[3 * i], NULL, NULL, err));
        for (ptrdiff_t i = first; i < last; i++)
            PM_TRY(advance(s, map, S, x, i, &work, &step[2 * i], err));
        for (ptrdiff_t i = first; i < last; i++) {
            shift[2 * i] += step[2 * i];
            shift[2 * i + 1] += step[2 * i + 1];
            pm_map_move(s->type, &s->Phi[3 * i], &shift[2 * i], &S[3 * i]);
        }
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(S);
    pm_free(x);
    pm_free(step);
    return status;
}

enum pm_status pm_exterior_start(const struct pm_map *map, const double *shift, const double S[3],
                                 struct pm_basis *work, double old[3], struct pm_err *err)
{
    enum pm_status status = pm_map_basis(map, S, 0, work, err);
    double d[2] = {0};

    for (ptrdiff_t k = 0; status == PM_OK && k < work->n; k++)
        for (int j = 0; j < 2; j++)
            d[j] += work->c[k] * shift[2 * (ptrdiff_t)work->id[k] + j];
    if (status == PM_OK)
        pm_map_move(PM_SURFACE_BSPLINE, S, d, old);
    return status;
}
