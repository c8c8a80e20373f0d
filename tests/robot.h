/* A small robot for tests: a round body (B-spline tube, exact to 1e-3) with ellipsoidal chambers
 * (sphere maps on icospheres, unfitted: they come out a little smaller). */
#ifndef PM_TEST_ROBOT_H
#define PM_TEST_ROBOT_H

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/surfaces.h"
#include "common/geometry/surface_map.h"

struct robot_chamber {
    double center[3], axes[3]; /* [mm] */
    double wave;               /* relative radial wave along z, three periods */
};

static enum pm_status robot_tube(struct pm_surface *s, double R, double H, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    enum { NU = 24, NV = 16 };
    *s = (struct pm_surface){.type = PM_SURFACE_BSPLINE, .n = NU * NV, .nu = NU, .nv = NV};
    s->nt = 2 * NU * (NV - 1);
    PM_TRY(PM_NEW(s->phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->free, 3 * s->n, err));
    PM_TRY(PM_NEW(s->Phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->d0, s->n, err));
    PM_TRY(PM_NEW(s->tri, 3 * s->nt, err));
    const double step = 2 * acos(-1.0) / NU, shrink = (4 + 2 * cos(step)) / 6;
    for (int b = 0; b < NV; b++) {
        double v = 0;
        for (int k = 1; k <= 3; k++)
            v += fmin(fmax(b - 3 + k, 0), NV - 3) / (3.0 * (NV - 3));
        for (int a = 0; a < NU; a++) {
            double *P = s->Phi + 3 * (a + NU * b), *p = s->phi + 3 * (a + NU * b);
            P[0] = cos(a * step);
            P[1] = sin(a * step);
            P[2] = v;
            p[0] = R / shrink * P[0];
            p[1] = R / shrink * P[1];
            p[2] = H * v;
        }
    }
    ptrdiff_t t = 0;
    for (int b = 0; b + 1 < NV; b++)
        for (int a = 0; a < NU; a++) {
            const int32_t i = a + NU * b, j = (a + 1) % NU + NU * b;
            const int32_t quad[6] = {i, j, j + NU, i, j + NU, i + NU};
            memcpy(s->tri + 3 * t, quad, sizeof quad);
            t += 2;
        }
done:
    return status;
}

/* Icosahedron, each edge cut in 2^levels: points on the unit sphere, triangles outward. */
static enum pm_status robot_icosphere(int levels, struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    static const int32_t face[60] = {0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                     1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                     3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                     4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
    const double g = (1 + sqrt(5.0)) / 2;
    const double p[36] = {-1, g,  0,  1, g, 0,  -1, -g, 0,  1, -g, 0, 0,  -1, g,  0,  1, g,
                          0,  -1, -g, 0, 1, -g, g,  0,  -1, g, 0,  1, -g, 0,  -1, -g, 0, 1};
    s->n = 12;
    s->nt = 20;
    const ptrdiff_t total = 10 * (1L << (2 * levels)) + 2;
    PM_TRY(PM_NEW(s->Phi, 3 * total, err));
    PM_TRY(PM_NEW(s->tri, 60 * (1L << (2 * levels)), err));
    memcpy(s->tri, face, sizeof face);
    for (int i = 0; i < 36; i++)
        s->Phi[i] = p[i] / sqrt(1 + g * g);
    for (int l = 0; l < levels; l++) {
        const ptrdiff_t old = s->nt, base = s->n;
        for (ptrdiff_t t = 0; t < old; t++) {
            int32_t v[3], m[3];
            memcpy(v, s->tri + 3 * t, sizeof v);
            for (int k = 0; k < 3; k++) {
                double mid[3];
                pm_map_middle(PM_SURFACE_SPHERE, s->Phi + 3 * v[k], s->Phi + 3 * v[(k + 1) % 3],
                              mid);
                m[k] = (int32_t)s->n;
                for (ptrdiff_t a = base; a < s->n; a++)
                    if (fabs(s->Phi[3 * a] - mid[0]) + fabs(s->Phi[3 * a + 1] - mid[1]) +
                            fabs(s->Phi[3 * a + 2] - mid[2]) <
                        1e-9)
                        m[k] = (int32_t)a;
                if (m[k] == s->n)
                    memcpy(s->Phi + 3 * s->n++, mid, sizeof mid);
            }
            const int32_t inner[3] = {m[0], m[1], m[2]};
            memcpy(s->tri + 3 * t, inner, sizeof inner);
            for (int k = 0; k < 3; k++) {
                const int32_t c[3] = {v[k], m[k], m[(k + 2) % 3]};
                memcpy(s->tri + 3 * s->nt++, c, sizeof c);
            }
        }
    }
done:
    return status;
}

static enum pm_status robot_ellipsoid(struct pm_surface *s, const struct robot_chamber *c,
                                      struct pm_err *err)
{
    enum pm_status status = PM_OK;
    *s = (struct pm_surface){.type = PM_SURFACE_SPHERE};
    PM_TRY(robot_icosphere(3, s, err));
    PM_TRY(PM_NEW(s->phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->free, 3 * s->n, err));
    PM_TRY(PM_NEW(s->d0, s->n, err));
    memset(s->free, 1, (size_t)(3 * s->n));
    PM_TRY(pm_map_support(s->n, s->Phi, 20, s->d0, err));
    for (ptrdiff_t a = 0; a < s->n; a++)
        for (int i = 0; i < 3; i++) {
            const double f = i < 2 ? 1 + c->wave * cos(3 * acos(-1.0) * s->Phi[3 * a + 2]) : 1;
            s->phi[3 * a + i] = c->center[i] + f * c->axes[i] * s->Phi[3 * a + i];
        }
done:
    return status;
}

/* pcase is left to the caller. */
static inline enum pm_status robot_init(struct pm_surfaces *r, double R, double H, ptrdiff_t nc,
                                        const struct robot_chamber *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    r->ns = nc + 1;
    PM_TRY(PM_NEW(r->s, r->ns, err));
    PM_TRY(PM_NEW(r->offset, r->ns + 1, err));
    PM_TRY(robot_tube(&r->s[0], R, H, err));
    for (ptrdiff_t k = 0; k < nc; k++)
        PM_TRY(robot_ellipsoid(&r->s[k + 1], &c[k], err));
    for (ptrdiff_t k = 0; k < r->ns; k++)
        r->offset[k + 1] = r->offset[k] + r->s[k].n;
    r->reference_point[2] = H;
done:
    return status;
}

#endif
