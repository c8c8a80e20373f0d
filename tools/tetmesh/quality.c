#include "tools/tetmesh/quality.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/tet10.h"

static double det3(const double *a, const double *b, const double *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

void pm_quality_bernstein(const double X[30], double b[20])
{
    static const double vertex[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double g[3][4][3]; /* dX/dxi_j at vertex v: linear in between */
    memset(g, 0, sizeof g);
    for (int v = 0; v < 4; v++) {
        double dN[30];
        pm_tet10_shape_gradient(vertex[v], dN);
        for (int a = 0; a < 10; a++)
            for (int j = 0; j < 3; j++)
                for (int i = 0; i < 3; i++)
                    g[j][v][i] += dN[3 * a + j] * X[3 * a + i];
    }
    /* det = sum_uvw L_u L_v L_w det(g_0(u), g_1(v), g_2(w)): the coefficient is the mean over
     * permutations */
    int n = 0;
    for (int u = 0; u < 4; u++)
        for (int v = u; v < 4; v++)
            for (int w = v; w < 4; w++)
                b[n++] = (det3(g[0][u], g[1][v], g[2][w]) + det3(g[0][u], g[1][w], g[2][v]) +
                          det3(g[0][v], g[1][u], g[2][w]) + det3(g[0][v], g[1][w], g[2][u]) +
                          det3(g[0][w], g[1][u], g[2][v]) + det3(g[0][w], g[1][v], g[2][u])) /
                         6;
}

double pm_quality_scaled(const double X[30])
{
    double b[20], low = INFINITY, sum = 0;
    pm_quality_bernstein(X, b);
    for (int k = 0; k < 20; k++) {
        low = fmin(low, b[k]);
        sum += b[k];
    }
    return sum > 0 ? fmax(20 * low / sum, -1) : -1;
}

double pm_quality_mean_ratio(const double X[12])
{
    double u[3][3], sum = 0;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            u[k][i] = X[3 * (k + 1) + i] - X[i];
    for (int a = 0; a < 4; a++)
        for (int b = a + 1; b < 4; b++)
            for (int i = 0; i < 3; i++)
                sum += (X[3 * a + i] - X[3 * b + i]) * (X[3 * a + i] - X[3 * b + i]);
    const double volume = det3(u[0], u[1], u[2]) / 6;
    return 12 * copysign(cbrt(9 * volume * volume), volume) / sum;
}

void pm_quality_gather(const struct pm_mesh *m, const double *x, ptrdiff_t e, double X[30])
{
    const int32_t *v = m->tet + m->npe * e;
    for (ptrdiff_t a = 0; a < m->npe; a++)
        memcpy(X + 3 * a, x + 3 * (ptrdiff_t)v[a], 3 * sizeof *X);
    for (int k = 0; k < 6 && m->npe == 4; k++)
        for (int i = 0; i < 3; i++)
            X[12 + 3 * k + i] =
                (X[3 * pm_tet10_edge[k][0] + i] + X[3 * pm_tet10_edge[k][1] + i]) / 2;
}

/* Nodes of face f (6 x 3); a 3-node one gets the middles of its edges. */
static void gather_face(const struct pm_mesh *m, ptrdiff_t f, double X[18])
{
    for (ptrdiff_t a = 0; a < m->npf; a++)
        memcpy(X + 3 * a, m->x + 3 * (ptrdiff_t)m->tri[m->npf * f + a], 3 * sizeof *X);
    for (int k = 0; k < 9 && m->npf == 3; k++)
        X[9 + k] = (X[k] + X[(k + 3) % 9]) / 2;
}

double pm_quality_face(const struct pm_mesh *m, ptrdiff_t f, double *area, double moment[3])
{
    double X[18], flux = 0;
    gather_face(m, f, X);
    for (int q = 0; q < PM_TRI_POINTS; q++) {
        double N[6], dN[12], x[3] = {0}, u[3] = {0}, v[3] = {0};
        pm_tri6_shape(pm_tri_xi[q], N, dN);
        for (int a = 0; a < 6; a++)
            for (int i = 0; i < 3; i++) {
                x[i] += N[a] * X[3 * a + i];
                u[i] += dN[2 * a] * X[3 * a + i];
                v[i] += dN[2 * a + 1] * X[3 * a + i];
            }
        const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                             u[0] * v[1] - u[1] * v[0]};
        const double w = pm_tri_weight[q] * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        *area += w;
        for (int i = 0; i < 3; i++) {
            moment[i] += w * x[i];
            flux += pm_tri_weight[q] * n[i] * x[i] / 3;
        }
    }
    return flux;
}
