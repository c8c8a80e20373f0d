#include "common/geometry/curvature.h"

#include <math.h>
#include <stddef.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Symmetric 2 x 2 matrices are stored 11, 12, 22; m = x y x (symmetric). */
static void sandwich(const double x[3], const double y[3], double m[3])
{
    double p = x[0] * y[0] + x[1] * y[1], q = x[0] * y[1] + x[1] * y[2];
    double u = x[1] * y[0] + x[2] * y[1], v = x[1] * y[1] + x[2] * y[2];

    m[0] = p * x[0] + q * x[1];
    m[1] = p * x[1] + q * x[2];
    m[2] = u * x[1] + v * x[2];
}

void pm_curvature_at(const double r_a[6], const double *r_ab, struct pm_curvature *c)
{
    const double *p = r_a, *q = r_a + 3;
    double g[3] = {dot(p, p), dot(p, q), dot(q, q)}, det, b[3];

    c->n[0] = p[1] * q[2] - p[2] * q[1];
    c->n[1] = p[2] * q[0] - p[0] * q[2];
    c->n[2] = p[0] * q[1] - p[1] * q[0];
    det = dot(c->n, c->n); /* = det g */
    c->A = sqrt(det);
    for (int i = 0; i < 3; i++)
        c->n[i] /= c->A;
    c->gi[0] = g[2] / det;
    c->gi[1] = -g[1] / det;
    c->gi[2] = g[0] / det;
    c->H = c->K = c->Q = 0;
    if (r_ab == NULL)
        return;
    for (int k = 0; k < 3; k++)
        b[k] = dot(&r_ab[3 * k], c->n);
    c->H = (c->gi[0] * b[0] + 2 * c->gi[1] * b[1] + c->gi[2] * b[2]) / 2;
    c->K = (b[0] * b[2] - b[1] * b[1]) / det;
    c->Q = 4 * c->H * c->H - 2 * c->K;
}

double pm_curvature_gradient(const double r_a[6], const double r_ab[9], double Q_a[6],
                             double Q_ab[9])
{
    struct pm_curvature c;
    double b[3], bgb[3], h[3], k[3], up[6], gamma[2];

    pm_curvature_at(r_a, r_ab, &c);
    for (int i = 0; i < 3; i++)
        b[i] = dot(&r_ab[3 * i], c.n);
    sandwich(c.gi, b, h); /* h = g^-1 b g^-1, k = g^-1 b g^-1 b g^-1 */
    sandwich(b, c.gi, bgb);
    sandwich(c.gi, bgb, k);
    for (int i = 0; i < 3; i++) { /* r^c = g^cd r_d */
        up[i] = c.gi[0] * r_a[i] + c.gi[1] * r_a[3 + i];
        up[3 + i] = c.gi[1] * r_a[i] + c.gi[2] * r_a[3 + i];
    }
    for (int d = 0; d < 2; d++) /* h^ab Gamma^c_ab */
        gamma[d] = h[0] * dot(&r_ab[0], &up[3 * d]) + 2 * h[1] * dot(&r_ab[3], &up[3 * d]) +
                   h[2] * dot(&r_ab[6], &up[3 * d]);
    for (int i = 0; i < 3; i++) {
        Q_a[i] = -2 * gamma[0] * c.n[i] - 4 * (k[0] * r_a[i] + k[1] * r_a[3 + i]);
        Q_a[3 + i] = -2 * gamma[1] * c.n[i] - 4 * (k[1] * r_a[i] + k[2] * r_a[3 + i]);
        Q_ab[i] = 2 * h[0] * c.n[i];
        Q_ab[3 + i] = 4 * h[1] * c.n[i];
        Q_ab[6 + i] = 2 * h[2] * c.n[i];
    }
    return c.Q;
}

double pm_area_gradient(const double r_a[6], double A_a[6])
{
    struct pm_curvature c;

    pm_curvature_at(r_a, NULL, &c);
    for (int i = 0; i < 3; i++) {
        A_a[i] = c.A * (c.gi[0] * r_a[i] + c.gi[1] * r_a[3 + i]);
        A_a[3 + i] = c.A * (c.gi[1] * r_a[i] + c.gi[2] * r_a[3 + i]);
    }
    return c.A;
}
