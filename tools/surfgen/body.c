#include "tools/surfgen/body.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double TWO_PI = 6.283185307179586476925;

void pm_body_point(const struct pm_case *c, const struct pm_outline *o, const double S[3],
                   double x[3])
{
    pm_outline_point(o, atan2(S[1], S[0]) / TWO_PI, c->height * S[2], x);
}

/* Diagonals alternate like a chess board: symmetric under mirrors and turns for nu = 12 m. */
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

static void place(struct pm_surface *s)
{
    for (ptrdiff_t i = 0; i < s->n; i++) {
        ptrdiff_t b = i / s->nu;
        double t = TWO_PI * (double)(i % s->nu) / (double)s->nu, v = 0;
        uint8_t *f = &s->free[3 * i];
        for (ptrdiff_t k = b + 1; k <= b + 3;
             k++) /* Greville abscissa of row b: knots (k - 3) / (nv - 3) */
            v += fmin(fmax((double)(k - 3), 0), (double)(s->nv - 3)) / (3.0 * (double)(s->nv - 3));
        s->Phi[3 * i] = cos(t);
        s->Phi[3 * i + 1] = sin(t);
        s->Phi[3 * i + 2] = v;
        f[0] = f[1] = b > 0 && b + 1 < s->nv;
        f[2] = b > 1 && b + 2 < s->nv;
    }
}

enum pm_status pm_body_grid(const struct pm_case *c, struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    *s = (struct pm_surface){.type = PM_SURFACE_BSPLINE, .nu = c->around, .nv = c->rows};
    s->n = s->nu * s->nv;
    PM_TRY(PM_NEW(s->phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->free, 3 * s->n, err));
    PM_TRY(PM_NEW(s->Phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->d0, s->n, err));
    PM_TRY(PM_NEW(s->tri, 6 * s->nu * (s->nv - 1), err));
    place(s);
    triangulate(s);
done:
    return status;
}

enum pm_status pm_body_seed(const struct pm_case *c, const struct pm_outline *o,
                            struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = pm_body_grid(c, s, err);

    for (ptrdiff_t i = 0; status == PM_OK && i < s->n; i++)
        pm_outline_point(o, (double)(i % s->nu) / (double)s->nu, c->height * s->Phi[3 * i + 2],
                         &s->phi[3 * i]);
    return status;
}
