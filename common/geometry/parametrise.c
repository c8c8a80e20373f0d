#include "common/geometry/parametrise.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/surfaces.h"
#include "common/geometry/parametrise_parts.h"
#include "common/geometry/remesh.h"

void pm_triangle_area(const struct pm_trimesh *m, ptrdiff_t t, double n[3])
{
    const double *a = &m->x[3 * (ptrdiff_t)m->tri[3 * t]],
                 *b = &m->x[3 * (ptrdiff_t)m->tri[3 * t + 1]],
                 *c = &m->x[3 * (ptrdiff_t)m->tri[3 * t + 2]];
    double u[3], v[3];

    for (int j = 0; j < 3; j++) {
        u[j] = (b[j] - a[j]) / 2;
        v[j] = c[j] - a[j];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
}

void pm_turn_theta(const struct pm_trimesh *m, const uint8_t *out, double *theta)
{
    double re = 0, im = 0, n[3];

    /* sum of n . (cos theta, sin theta): real where the mesh is symmetric and theta is */
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        pm_triangle_area(m, t, n);
        for (int k = 0; k < 3; k++) {
            int32_t a = m->tri[3 * t + k];
            if (out != NULL && out[a])
                continue;
            re += n[0] * cos(theta[a]) + n[1] * sin(theta[a]);
            im += n[0] * sin(theta[a]) - n[1] * cos(theta[a]);
        }
    }
    const double turn = atan2(im, re);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        theta[a] -= turn;
}

enum pm_status pm_symmetrise_map(const struct pm_trimesh *m, int axis, const int32_t *image,
                                 double *S, struct pm_err *err)
{
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        double *s = &S[3 * a], *t = &S[3 * (ptrdiff_t)image[a]];
        if (image[image[a]] != a)
            return pm_fail(err, PM_INPUT,
                           "node at (%.6g, %.6g, %.6g) is not the image of its mirror image",
                           m->x[3 * a], m->x[3 * a + 1], m->x[3 * a + 2]);
        for (int j = 0; j < 3 && image[a] >= a; j++) {
            double sign = j == axis ? -1 : 1, mean = (s[j] + sign * t[j]) / 2;
            s[j] = image[a] == a && j == axis ? 0 : mean;
            t[j] = image[a] == a ? s[j] : sign * mean;
        }
    }
    return PM_OK;
}

/* First fundamental forms of a triangle in the plane of its parameters: sigma_1 / sigma_2 of the
 * linear map from the edges P, Q in S to p, q in space. */
static double anisotropy(const double P[3], const double Q[3], const double p[3], const double q[3])
{
    double G[3] = {0}, g[3] = {0}; /* 11, 12, 22 */

    for (int j = 0; j < 3; j++) {
        G[0] += P[j] * P[j];
        G[1] += P[j] * Q[j];
        G[2] += Q[j] * Q[j];
        g[0] += p[j] * p[j];
        g[1] += p[j] * q[j];
        g[2] += q[j] * q[j];
    }
    const double D = G[0] * G[2] - G[1] * G[1], d = g[0] * g[2] - g[1] * g[1];
    const double trace = G[2] * g[0] - 2 * G[1] * g[1] + G[0] * g[2]; /* D tr(G^-1 g) */
    if (!(D > 0) || !(d > 0))
        return HUGE_VAL;
    const double half = trace / (2 * sqrt(D) * sqrt(d)); /* (s1 / s2 + s2 / s1) / 2 */
    return half + sqrt(fmax(half * half - 1, 0));
}

/* Edge from a to b in S; on the tube in (theta, v). */
static void parameter_edge(int32_t type, const double *a, const double *b, double e[3])
{
    if (type == PM_SURFACE_SPHERE) {
        for (int j = 0; j < 3; j++)
            e[j] = b[j] - a[j];
        return;
    }
    e[0] = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    e[1] = b[2] - a[2];
    e[2] = 0;
}

enum pm_status pm_parametrise_measure(const struct pm_trimesh *m, int32_t type, const double *S,
                                      struct pm_distortion *d, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *ratio = NULL, *area = NULL, total = 0, below = 0;
    size_t *rank = NULL;

    *d = (struct pm_distortion){0};
    PM_TRY(PM_NEW(ratio, m->nt, err));
    PM_TRY(PM_NEW(area, m->nt, err));
    PM_TRY(PM_NEW(rank, m->nt, err));
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = &m->tri[3 * t];
        const double *s[3], *x[3];
        double n[3], e[4][3];
        for (int k = 0; k < 3; k++) {
            s[k] = &S[3 * (ptrdiff_t)v[k]];
            x[k] = &m->x[3 * (ptrdiff_t)v[k]];
        }
        for (int k = 0; k < 2; k++) {
            parameter_edge(type, s[0], s[k + 1], e[k]);
            parameter_edge(PM_SURFACE_SPHERE, x[0], x[k + 1], e[2 + k]);
        }
        d->folded += !(pm_parameter_orientation(type, s[0], s[1], s[2]) > 0);
        ratio[t] = anisotropy(e[0], e[1], e[2], e[3]);
        pm_triangle_area(m, t, n);
        total += area[t] = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    gsl_sort_index(rank, ratio, 1, (size_t)m->nt);
    for (ptrdiff_t k = 0; k < m->nt; k++) {
        below += area[rank[k]];
        if (below <= total / 2 || k == 0)
            d->median = ratio[rank[k]];
        if (below <= 0.95 * total || k == 0)
            d->most = ratio[rank[k]];
    }
done:
    pm_free(ratio);
    pm_free(area);
    pm_free(rank);
    return status;
}
