#include "common/mechanics/cavity.h"

#include <string.h>

#include "common/mechanics/tensor.h"
#include "common/mechanics/tet10.h"

/* Value and two derivatives of a nodal field at a point. */
static void field(const double v[18], const double N[6], const double dN[12], double f[9])
{
    memset(f, 0, 9 * sizeof *f);
    for (int a = 0; a < 6; a++)
        for (int i = 0; i < 3; i++) {
            f[i] += N[a] * v[3 * a + i];
            f[3 + i] += dN[2 * a] * v[3 * a + i];
            f[6 + i] += dN[2 * a + 1] * v[3 * a + i];
        }
}

/* out = a x b + c x d */
static void cross_sum(const double *a, const double *b, const double *c, const double *d,
                      double out[3])
{
    double s[3], t[3];
    pm_vcross(a, b, s);
    pm_vcross(c, d, t);
    for (int i = 0; i < 3; i++)
        out[i] = s[i] + t[i];
}

void pm_cavity_vec(const double b[18], const double c[18], double out[18])
{
    memset(out, 0, 18 * sizeof *out);
    for (int q = 0; q < PM_TRI_POINTS; q++) {
        double N[6], dN[12], fb[9], fc[9], n[3], n1[3], n2[3], w = pm_tri_weight[q] / 3;
        pm_tri6_shape(pm_tri_xi[q], N, dN);
        field(b, N, dN, fb);
        field(c, N, dN, fc);
        cross_sum(fb + 3, fc + 6, fc + 3, fb + 6, n);
        cross_sum(fb + 6, fc, fc + 6, fb, n1);
        cross_sum(fb, fc + 3, fc, fb + 3, n2);
        for (int a = 0; a < 6; a++)
            for (int i = 0; i < 3; i++)
                out[3 * a + i] += w * (N[a] * n[i] + dN[2 * a] * n1[i] + dN[2 * a + 1] * n2[i]);
    }
}

void pm_cavity_hessian(const double x[18], double s[108])
{
    memset(s, 0, 108 * sizeof *s);
    for (int q = 0; q < PM_TRI_POINTS; q++) {
        double N[6], dN[12], f[9], w = pm_tri_weight[q] / 3;
        pm_tri6_shape(pm_tri_xi[q], N, dN);
        field(x, N, dN, f);
        for (int a = 0; a < 6; a++)
            for (int b = 0; b < 6; b++) {
                double c1 = w * (N[a] * dN[2 * b + 1] - dN[2 * a + 1] * N[b]);
                double c2 = w * (dN[2 * a] * N[b] - N[a] * dN[2 * b]);
                double c0 = w * (dN[2 * a + 1] * dN[2 * b] - dN[2 * a] * dN[2 * b + 1]);
                for (int i = 0; i < 3; i++)
                    s[3 * (6 * a + b) + i] += c1 * f[3 + i] + c2 * f[6 + i] + c0 * f[i];
            }
    }
}
