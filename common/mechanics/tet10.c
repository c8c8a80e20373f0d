#include "common/mechanics/tet10.h"

#include "common/mechanics/tensor.h"

#define A4 0.13819660112501051518 /* (5 - sqrt 5)/20 */
#define B4 0.58541019662496845446

const double pm_tet_xi[PM_TET_POINTS][3] = {{A4, A4, A4}, {B4, A4, A4}, {A4, B4, A4}, {A4, A4, B4}};
const double pm_tet_weight[PM_TET_POINTS] = {1.0 / 24, 1.0 / 24, 1.0 / 24, 1.0 / 24};

/* Dunavant's degree 4 rule */
#define P1 0.44594849091596488632
#define P2 0.09157621350977074346
#define W1 0.11169079483900573285
#define W2 0.05497587182766093382

const double pm_tri_xi[PM_TRI_POINTS][2] = {{P1, P1}, {1 - 2 * P1, P1}, {P1, 1 - 2 * P1},
                                            {P2, P2}, {1 - 2 * P2, P2}, {P2, 1 - 2 * P2}};
const double pm_tri_weight[PM_TRI_POINTS] = {W1, W1, W1, W2, W2, W2};

const int pm_tet10_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
static const double dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void pm_tet10_shape_gradient(const double xi[3], double dN[30])
{
    double L[4] = {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
    for (int j = 0; j < 3; j++) {
        for (int a = 0; a < 4; a++)
            dN[3 * a + j] = (4 * L[a] - 1) * dL[a][j];
        for (int k = 0; k < 6; k++) {
            int a = pm_tet10_edge[k][0], b = pm_tet10_edge[k][1];
            dN[3 * (4 + k) + j] = 4 * (L[a] * dL[b][j] + L[b] * dL[a][j]);
        }
    }
}

void pm_tri6_shape(const double xi[2], double N[6], double dN[12])
{
    static const double d[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3;
        N[a] = L[a] * (2 * L[a] - 1);
        N[3 + a] = 4 * L[a] * L[b];
        for (int j = 0; j < 2; j++) {
            dN[2 * a + j] = (4 * L[a] - 1) * d[a][j];
            dN[2 * (3 + a) + j] = 4 * (L[a] * d[b][j] + L[b] * d[a][j]);
        }
    }
}

double pm_tet10_gradient(const double *X, const double xi[3], double dN[30])
{
    double ref[30], D[9], C[9];
    pm_tet10_shape_gradient(xi, ref);
    pm_gradient(10, X, ref, D); /* D_iJ = dX_i/dxi_J */
    double det = pm_cofactor(D, C), inv = 1.0 / det;
    /* dN/dX_i = dN/dxi_J (D^-1)_Ji, (D^-1)_Ji = C_iJ / det */
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++)
            dN[3 * a + i] = inv * (C[3 * i] * ref[3 * a] + C[3 * i + 1] * ref[3 * a + 1] +
                                   C[3 * i + 2] * ref[3 * a + 2]);
    return det;
}
