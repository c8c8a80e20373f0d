/* The operations of tensor.h for one type REAL, named by OF; included by tensor.h alone. */

/* A : B */
static inline REAL OF(dot9)(const REAL A[9], const REAL B[9])
{
    REAL s = A[0] * B[0];
    for (int i = 1; i < 9; i++)
        s += A[i] * B[i];
    return s;
}

/* Y += s A */
static inline void OF(axpy9)(REAL s, const REAL A[9], REAL Y[9])
{
    for (int i = 0; i < 9; i++)
        Y[i] += s * A[i];
}

/* Tensor cross product A x B (Bonet, Gil, Ortigosa 2015): bilinear, symmetric; cof F = (F x F)/2.
 */
static inline void OF(cross9)(const REAL A[9], const REAL B[9], REAL out[9])
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
static inline void OF(cross_matrix)(const REAL F[9], REAL X[81])
{
    static const int n1[3] = {1, 2, 0}, n2[3] = {2, 0, 1};
    memset(X, 0, 81 * sizeof *X);
    for (int i = 0; i < 3; i++)
        for (int I = 0; I < 3; I++) {
            int j = n1[i], k = n2[i], J = n1[I], K = n2[I];
            REAL *row = X + 9 * (3 * i + I);
            row[3 * k + K] = F[3 * j + J];
            row[3 * j + J] = F[3 * k + K];
            row[3 * k + J] = -F[3 * j + K];
            row[3 * j + K] = -F[3 * k + J];
        }
}

/* C = cof F, returns det F */
static inline REAL OF(cofactor)(const REAL F[9], REAL C[9])
{
    OF(cross9)(F, F, C);
    for (int i = 0; i < 9; i++)
        C[i] *= 0.5;
    return F[0] * C[0] + F[1] * C[1] + F[2] * C[2];
}

/* det(I + H) - 1 without cancellation */
static inline REAL OF(det_minus_one)(const REAL H[9])
{
    REAL C[9], J = OF(cofactor)(H, C);
    return H[0] + H[4] + H[8] + C[0] + C[4] + C[8] + J;
}

/* grad_iJ = sum_a v_ai dN_aJ, v (n x 3), dN (n x 3) */
static inline void OF(gradient)(int n, const REAL *v, const REAL *dN, REAL G[9])
{
    memset(G, 0, 9 * sizeof G[0]);
    for (int a = 0; a < n; a++)
        for (int i = 0; i < 3; i++)
            for (int J = 0; J < 3; J++)
                G[3 * i + J] += v[3 * a + i] * dN[3 * a + J];
}
