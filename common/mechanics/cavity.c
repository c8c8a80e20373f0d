#include "common/mechanics/cavity.h"

#include <string.h>

#include "common/mechanics/tensor.h"
#include "common/mechanics/tet10.h"

/* Dunavant's rule of degree 8, 16 points, for the form of cubic faces (degree 7): orbits of a
 * barycentric point with their weights (sum 1). */
static const double orbit8[5][4] = {
    {0.144315607677787, 1.0 / 3, 1.0 / 3, 1.0 / 3},
    {0.095091634267285, 0.081414823414554, 0.459292588292723, 0.459292588292723},
    {0.103217370534718, 0.658861384496480, 0.170569307751760, 0.170569307751760},
    {0.032458497623198, 0.898905543365938, 0.050547228317031, 0.050547228317031},
    {0.027230314174435, 0.008394777409958, 0.263112829634638, 0.728492392955404}};

static void set_point(struct pm_cavity *c, double w, double xi0, double xi1)
{
    const double xi[2] = {xi0, xi1}, L[3] = {1 - xi0 - xi1, xi0, xi1};
    static const double dL[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    int q = c->nq++;
    c->weight[q] = w;
    if (c->n == 3) {
        memcpy(c->N[q], L, sizeof L);
        memcpy(c->dN[q], dL, sizeof dL);
        return;
    }
    pm_tri6_shape(xi, c->N[q], c->dN[q]);
    if (c->n < 7)
        return;
    c->N[q][6] = 27 * L[0] * L[1] * L[2];
    for (int j = 0; j < 2; j++)
        c->dN[q][12 + j] =
            27 * (dL[0][j] * L[1] * L[2] + L[0] * dL[1][j] * L[2] + L[0] * L[1] * dL[2][j]);
}

void pm_cavity_set(struct pm_cavity *c, int nodes)
{
    static const int turn[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    *c = (struct pm_cavity){.n = nodes};
    for (int q = 0; q < PM_TRI_POINTS && nodes < 7; q++)
        set_point(c, pm_tri_weight[q], pm_tri_xi[q][0], pm_tri_xi[q][1]);
    for (int k = 0; k < 5 && nodes == 7; k++)
        for (int i = 0; i < (k == 0 ? 1 : k < 4 ? 3 : 6); i++)
            set_point(c, 0.5 * orbit8[k][0], orbit8[k][1 + turn[i][0]], orbit8[k][1 + turn[i][1]]);
}

/* Value and two derivatives of a nodal field at point q. */
static void field(const struct pm_cavity *c, int q, const double *v, double f[9])
{
    const double *N = c->N[q], *dN = c->dN[q];
    memset(f, 0, 9 * sizeof *f);
    for (int a = 0; a < c->n; a++)
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

void pm_cavity_vec(const struct pm_cavity *c, const double *b, const double *d, double *out)
{
    memset(out, 0, 3 * (size_t)c->n * sizeof *out);
    for (int q = 0; q < c->nq; q++) {
        const double *N = c->N[q], *dN = c->dN[q];
        double fb[9], fd[9], n[3], n1[3], n2[3], w = c->weight[q] / 3;
        field(c, q, b, fb);
        field(c, q, d, fd);
        cross_sum(fb + 3, fd + 6, fd + 3, fb + 6, n);
        cross_sum(fb + 6, fd, fd + 6, fb, n1);
        cross_sum(fb, fd + 3, fd, fb + 3, n2);
        for (int a = 0; a < c->n; a++)
            for (int i = 0; i < 3; i++)
                out[3 * a + i] += w * (N[a] * n[i] + dN[2 * a] * n1[i] + dN[2 * a + 1] * n2[i]);
    }
}

void pm_cavity_hessian(const struct pm_cavity *c, const double *x, double *s)
{
    int n = c->n;
    memset(s, 0, 3 * (size_t)(n * n) * sizeof *s);
    for (int q = 0; q < c->nq; q++) {
        const double *N = c->N[q], *dN = c->dN[q];
        double f[9], w = c->weight[q] / 3;
        field(c, q, x, f);
        for (int a = 0; a < n; a++)
            for (int b = 0; b < n; b++) {
                double c1 = w * (N[a] * dN[2 * b + 1] - dN[2 * a + 1] * N[b]);
                double c2 = w * (dN[2 * a] * N[b] - N[a] * dN[2 * b]);
                double c0 = w * (dN[2 * a + 1] * dN[2 * b] - dN[2 * a] * dN[2 * b + 1]);
                for (int i = 0; i < 3; i++)
                    s[3 * (n * a + b) + i] += c1 * f[3 + i] + c2 * f[6 + i] + c0 * f[i];
            }
    }
}
