/* Plain tet10, the cavity triangle and the quadrature rules against tests/data (double precision
 * references). */
#include "common/mechanics/element.h"

#include <math.h>

#include "common/mechanics/cavity.h"
#include "common/mechanics/tensor.h"
#include "tests/reference.h"
#include "tests/tap.h"

static const double tolerance = 2e-14;

static void element(const cJSON *root)
{
    double X[30], x[30], u[30], v[30], w[30], want[30], f[30] = {0}, dN[120], wq[4], det = INFINITY;
    struct pm_law law;
    struct pm_err err = {0};
    struct pm_element el = {.law = &law, .blend = 1.0, .dN = dN, .w = wq};
    double mu = cJSON_GetObjectItemCaseSensitive(root, "mu")->valuedouble, vol = 0.0;
    pm_law_set(&law, "neo-hookean", 1, &mu,
               cJSON_GetObjectItemCaseSensitive(root, "kappa")->valuedouble, &err);
    reference_numbers(root, "X", X, 30);
    reference_numbers(root, "x", x, 30);
    reference_numbers(root, "v", v, 30);
    reference_numbers(root, "w", w, 30);
    for (int k = 0; k < 30; k++)
        u[k] = x[k] - X[k];
    for (int q = 0; q < 4; q++)
        vol += wq[q] = pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN + 30 * q);
    near_rel("volume", vol, cJSON_GetObjectItemCaseSensitive(root, "vol")->valuedouble, tolerance);
    near_rel("energy", pm_element_energy(&el, u, f, &det),
             cJSON_GetObjectItemCaseSensitive(root, "W")->valuedouble, tolerance);
    reference_numbers(root, "f", want, 30);
    near_array("nodal forces", f, want, 30, tolerance);
    double Kv[30] = {0}, K[900], Kv2[30] = {0}, T[30] = {0}, D[30] = {0}, zero[30] = {0};
    pm_element_apply(&el, u, v, Kv);
    reference_numbers(root, "Kv", want, 30);
    near_array("K v", Kv, want, 30, tolerance);
    pm_element_tangent(&el, u, NULL, K);
    for (int k = 0; k < 900; k++)
        Kv2[k / 30] += K[k] * v[k % 30];
    near_array("assembled K times v", Kv2, want, 30, tolerance);
    pm_element_third(&el, u, v, w, T);
    reference_numbers(root, "Tvw", want, 30);
    near_array("third contraction", T, want, 30, tolerance);
    pm_element_shape(&el, u, v, 0, NULL, NULL, D);
    reference_numbers(root, "dX_of_v_dot_f_at_fixed_x", want, 30);
    near_array("shape derivative of v.f", D, want, 30, tolerance);
    memset(D, 0, sizeof D);
    pm_element_shape(&el, u, zero, 1, v, w, D);
    reference_numbers(root, "dX_of_vKw_at_fixed_x", want, 30);
    near_array("shape derivative of v.K w", D, want, 30, tolerance);
}

static void cavity(const cJSON *root)
{
    double x[18], v[18], w[18], g[18], s[108], want[108], V = 0.0;
    reference_numbers(root, "x", x, 18);
    reference_numbers(root, "v", v, 18);
    reference_numbers(root, "w", w, 18);
    pm_cavity_vec(x, x, g);
    for (int k = 0; k < 18; k++) {
        V += x[k] * g[k] / 6;
        g[k] *= 0.5;
    }
    near_rel("cavity volume", V, cJSON_GetObjectItemCaseSensitive(root, "V")->valuedouble,
             tolerance);
    reference_numbers(root, "gradV", want, 18);
    near_array("its gradient", g, want, 18, tolerance);
    pm_cavity_vec(x, v, g);
    reference_numbers(root, "D2V_v", want, 18);
    near_array("second derivative", g, want, 18, tolerance);
    pm_cavity_vec(v, w, g);
    reference_numbers(root, "D3V_vw", want, 18);
    near_array("third derivative", g, want, 18, tolerance);
    pm_cavity_hessian(x, s);
    reference_numbers(root, "s_ab", want, 108);
    near_array("Hessian blocks", s, want, 108, tolerance);
}

/* integral of x^a y^b z^c over the reference tetrahedron (c < 0: triangle) */
static double monomial(int a, int b, int c)
{
    return tgamma(a + 1.0) * tgamma(b + 1.0) * (c < 0 ? 1.0 : tgamma(c + 1.0)) /
           tgamma(a + b + (c < 0 ? 3.0 : c + 4.0));
}

static void quadrature(void)
{
    double worst = 0.0;
    for (int a = 0; a <= 2; a++)
        for (int b = 0; a + b <= 2; b++)
            for (int c = 0; a + b + c <= 2; c++) {
                double s = 0.0;
                for (int q = 0; q < PM_TET_POINTS; q++)
                    s += pm_tet_weight[q] * pow(pm_tet_xi[q][0], a) * pow(pm_tet_xi[q][1], b) *
                         pow(pm_tet_xi[q][2], c);
                worst = fmax(worst, fabs(s - monomial(a, b, c)));
            }
    near_abs("tetrahedron rule exact to degree 2", worst, 0.0, 1e-16);
    worst = 0.0;
    for (int a = 0; a <= 4; a++)
        for (int b = 0; a + b <= 4; b++) {
            double s = 0.0;
            for (int q = 0; q < PM_TRI_POINTS; q++)
                s += pm_tri_weight[q] * pow(pm_tri_xi[q][0], a) * pow(pm_tri_xi[q][1], b);
            worst = fmax(worst, fabs(s - monomial(a, b, -1)));
        }
    near_abs("triangle rule exact to degree 4", worst, 0.0, 2e-16);
}

int main(void)
{
    cJSON *tet = reference_load("tests/data/element_tet10.json"),
          *tri = reference_load("tests/data/cavity_triangle.json");
    if (tet == NULL || tri == NULL)
        return tap_bail("no reference");
    element(tet);
    cavity(tri);
    quadrature();
    cJSON_Delete(tet);
    cJSON_Delete(tri);
    return tap_done();
}
