#include "common/mechanics/rotation.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/tensor.h"

/* f_o(s) = sum_k (-s)^k/(2k + o)! with three derivatives by s: o = 1 is sin n/n, o = 2 is (1 - cos
 * n)/n^2. Below s = 1 the series (14 terms); the closed forms lose digits there. */
static void series(int o, double s, double f[4])
{
    double c = 1.0;
    for (int m = 2; m <= o; m++)
        c /= m;
    memset(f, 0, 4 * sizeof *f);
    for (int k = 0; k < 14; k++) {
        double p[4] = {1, 0, 0, 0};
        int falling = 1;
        for (int d = 0; d < 4; d++) {
            p[d] = k >= d ? falling * pow(s, k - d) : 0.0;
            falling *= k - d;
            f[d] += c * p[d];
        }
        c /= -(double)((2 * k + o + 1) * (2 * k + o + 2));
    }
}

static void coefficients(double s, double a[4], double b[4])
{
    if (s < 1.0) {
        series(1, s, a);
        series(2, s, b);
        return;
    }
    double n = sqrt(s), h = sin(0.5 * n) / n;
    a[0] = sin(n) / n;
    a[1] = (cos(n) - a[0]) / (2 * s);
    a[2] = (-a[0] / 2 - 3 * a[1]) / (2 * s);
    a[3] = (-a[1] / 2 - 5 * a[2]) / (2 * s);
    b[0] = 2 * h * h;
    b[1] = (a[0] - 2 * b[0]) / (2 * s);
    b[2] = (a[1] - 4 * b[1]) / (2 * s);
    b[3] = (a[2] - 6 * b[2]) / (2 * s);
}

static void skew(const double v[3], double K[9])
{
    const double k[9] = {0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0};
    memcpy(K, k, sizeof k);
}

/* A B + B A */
static void anticommutator(const double A[9], const double B[9], double out[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double s = 0.0;
            for (int k = 0; k < 3; k++)
                s += A[3 * i + k] * B[3 * k + j] + B[3 * i + k] * A[3 * k + j];
            out[3 * i + j] = s;
        }
}

struct pieces {
    double K[9], KK[9], E[3][9], K2i[3][9], K2ij[3][3][9];
};

/* f_i, f_ij, f_ijk of f(s), s = |theta|^2, from its derivatives by s. */
static double first(const double f[4], const double t[3], int i)
{
    return f[1] * 2 * t[i];
}

static double second(const double f[4], const double t[3], int i, int j)
{
    return f[2] * 4 * t[i] * t[j] + (i == j ? 2 * f[1] : 0.0);
}

static double third_of(const double f[4], const double t[3], int i, int j, int k)
{
    double s = f[3] * 8 * t[i] * t[j] * t[k];
    s += 4 * f[2] * ((i == j ? t[k] : 0.0) + (i == k ? t[j] : 0.0) + (j == k ? t[i] : 0.0));
    return s;
}

static void third_derivatives(const double t[3], const double a[4], const double b[4],
                              const struct pieces *p, struct pm_rotation *r)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                double *M = r->Rijk[i][j][k];
                memset(M, 0, 9 * sizeof *M);
                pm_axpy9(third_of(a, t, i, j, k), p->K, M);
                pm_axpy9(second(a, t, i, j), p->E[k], M);
                pm_axpy9(second(a, t, i, k), p->E[j], M);
                pm_axpy9(second(a, t, j, k), p->E[i], M);
                pm_axpy9(third_of(b, t, i, j, k), p->KK, M);
                pm_axpy9(second(b, t, i, j), p->K2i[k], M);
                pm_axpy9(second(b, t, i, k), p->K2i[j], M);
                pm_axpy9(second(b, t, j, k), p->K2i[i], M);
                pm_axpy9(first(b, t, i), p->K2ij[j][k], M);
                pm_axpy9(first(b, t, j), p->K2ij[i][k], M);
                pm_axpy9(first(b, t, k), p->K2ij[i][j], M);
            }
}

void pm_rotation_at(const double t[3], int third, struct pm_rotation *r)
{
    double a[4], b[4];
    struct pieces p;
    coefficients(pm_dot3(t, t), a, b);
    skew(t, p.K);
    anticommutator(p.K, p.K, p.KK);
    for (int k = 0; k < 9; k++)
        p.KK[k] *= 0.5;
    for (int i = 0; i < 3; i++) {
        const double e[3] = {i == 0, i == 1, i == 2};
        skew(e, p.E[i]);
        anticommutator(p.E[i], p.K, p.K2i[i]);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            anticommutator(p.E[i], p.E[j], p.K2ij[i][j]);
    memset(r->R, 0, sizeof r->R);
    r->R[0] = r->R[4] = r->R[8] = 1.0;
    pm_axpy9(a[0], p.K, r->R);
    pm_axpy9(b[0], p.KK, r->R);
    for (int i = 0; i < 3; i++) {
        double *M = r->Ri[i];
        memset(M, 0, 9 * sizeof *M);
        pm_axpy9(first(a, t, i), p.K, M);
        pm_axpy9(a[0], p.E[i], M);
        pm_axpy9(first(b, t, i), p.KK, M);
        pm_axpy9(b[0], p.K2i[i], M);
        for (int j = 0; j < 3; j++) {
            M = r->Rij[i][j];
            memset(M, 0, 9 * sizeof *M);
            pm_axpy9(second(a, t, i, j), p.K, M);
            pm_axpy9(first(a, t, i), p.E[j], M);
            pm_axpy9(first(a, t, j), p.E[i], M);
            pm_axpy9(second(b, t, i, j), p.KK, M);
            pm_axpy9(first(b, t, i), p.K2i[j], M);
            pm_axpy9(first(b, t, j), p.K2i[i], M);
            pm_axpy9(b[0], p.K2ij[i][j], M);
        }
    }
    if (third)
        third_derivatives(t, a, b, &p, r);
}
