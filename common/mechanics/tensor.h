/* 3x3 tensors, row major: A[3*i + J]. */
#ifndef PM_TENSOR_H
#define PM_TENSOR_H

#include <string.h>

/* A : B */
static inline double pm_dot9(const double A[9], const double B[9])
{
    double s = 0.0;
    for (int i = 0; i < 9; i++)
        s += A[i] * B[i];
    return s;
}

/* Y += s A */
static inline void pm_axpy9(double s, const double A[9], double Y[9])
{
    for (int i = 0; i < 9; i++)
        Y[i] += s * A[i];
}

/* Tensor cross product A x B (Bonet, Gil, Ortigosa 2015): bilinear, symmetric; cof F = (F x F)/2.
 */
static inline void pm_cross9(const double A[9], const double B[9], double out[9])
{
    static const int n1[3] = {1, 2, 0}, n2[3] = {2, 0, 1};
    for (int i = 0; i < 3; i++)
        for (int I = 0; I < 3; I++) {
            int j = n1[i], k = n2[i], J = n1[I], K = n2[I];
            out[3 * i + I] = A[3 * j + J] * B[3 * k + K] + A[3 * k + K] * B[3 * j + J] -
                             A[3 * j + K] * B[3 * k + J] - A[3 * k + J] * B[3 * j + K];
        }
}

/* X(F): the symmetric matrix of G -> F x G. */
static inline void pm_cross_matrix(const double F[9], double X[81])
{
    static const int n1[3] = {1, 2, 0}, n2[3] = {2, 0, 1};
    memset(X, 0, 81 * sizeof *X);
    for (int i = 0; i < 3; i++)
        for (int I = 0; I < 3; I++) {
            int j = n1[i], k = n2[i], J = n1[I], K = n2[I];
            double *row = X + 9 * (3 * i + I);
            row[3 * k + K] = F[3 * j + J];
            row[3 * j + J] = F[3 * k + K];
            row[3 * k + J] = -F[3 * j + K];
            row[3 * j + K] = -F[3 * k + J];
        }
}

/* C = cof F, returns det F */
static inline double pm_cofactor(const double F[9], double C[9])
{
    pm_cross9(F, F, C);
    for (int i = 0; i < 9; i++)
        C[i] *= 0.5;
    return F[0] * C[0] + F[1] * C[1] + F[2] * C[2];
}

/* det(I + H) - 1 without cancellation */
static inline double pm_det_minus_one(const double H[9])
{
    double t = H[0] + H[4] + H[8], t2 = 0.0, C[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t2 += H[3 * i + j] * H[3 * j + i];
    return t + 0.5 * (t * t - t2) + pm_cofactor(H, C);
}

/* grad_iJ = sum_a v_ai dN_aJ, v (10 x 3), dN (10 x 3) */
static inline void pm_gradient(const double *v, const double *dN, double G[9])
{
    memset(G, 0, 9 * sizeof G[0]);
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++)
            for (int J = 0; J < 3; J++)
                G[3 * i + J] += v[3 * a + i] * dN[3 * a + J];
}

static inline void pm_vcross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* y = M v, y = M^T v */
static inline void pm_mul3(const double M[9], const double v[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = M[3 * i] * v[0] + M[3 * i + 1] * v[1] + M[3 * i + 2] * v[2];
}

static inline void pm_tmul3(const double M[9], const double v[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = M[i] * v[0] + M[3 + i] * v[1] + M[6 + i] * v[2];
}

static inline double pm_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#endif
