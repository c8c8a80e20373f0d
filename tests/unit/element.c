/* Plain tet10, the cavity triangle and the quadrature rules against tests/data (double precision
 * references). */
#include "common/mechanics/element.h"

#include <math.h>

#include "common/mechanics/cavity.h"
#include "common/mechanics/tensor.h"
#include "common/mechanics/tet10.h"
#include "tests/lanes.h"
#include "tests/reference.h"
#include "tests/tap.h"

static const double tolerance = 2e-14;

static void element(const cJSON *root)
{
    double X[30], x[30], u[30], v[30], w[30], want[30], f[30], vol = 0.0;
    struct pm_law law;
    struct pm_err err = {0};
    struct lanes_element el;
    const struct pm_mesh quadratic = {.npe = 10};
    const struct pm_element_type *type = NULL;
    double mu = cJSON_GetObjectItemCaseSensitive(root, "mu")->valuedouble;
    pm_law_set(&law, "neo-hookean", 1, &mu,
               cJSON_GetObjectItemCaseSensitive(root, "kappa")->valuedouble, &err);
    pm_element_type("tet10", &quadratic, &type, &err);
    reference_numbers(root, "X", X, 30);
    reference_numbers(root, "x", x, 30);
    reference_numbers(root, "v", v, 30);
    reference_numbers(root, "w", w, 30);
    for (int k = 0; k < 30; k++)
        u[k] = x[k] - X[k];
    lanes_element_set(&el, type, &law, X);
    for (int q = 0; q < 4; q++)
        vol += el.w[q][LANE];
    near_rel("volume", vol, cJSON_GetObjectItemCaseSensitive(root, "vol")->valuedouble, tolerance);
    near_rel("energy", lanes_element_energy(&el, u, f),
             cJSON_GetObjectItemCaseSensitive(root, "W")->valuedouble, tolerance);
    reference_numbers(root, "f", want, 30);
    near_array("nodal forces", f, want, 30, tolerance);
    double Kv[30], K[900], Kv2[30] = {0}, T[30], D[30], zero[30] = {0};
    lanes_element_apply(&el, u, v, Kv);
    reference_numbers(root, "Kv", want, 30);
    near_array("K v", Kv, want, 30, tolerance);
    lanes_element_tangent(&el, u, NULL, K);
    for (int k = 0; k < 900; k++)
        Kv2[k / 30] += K[k] * v[k % 30];
    near_array("assembled K times v", Kv2, want, 30, tolerance);
    lanes_element_third(&el, u, v, w, T);
    reference_numbers(root, "Tvw", want, 30);
    near_array("third contraction", T, want, 30, tolerance);
    lanes_element_shape(&el, u, v, 0, NULL, NULL, D);
    reference_numbers(root, "dX_of_v_dot_f_at_fixed_x", want, 30);
    near_array("shape derivative of v.f", D, want, 30, tolerance);
    lanes_element_shape(&el, u, zero, 1, v, w, D);
    reference_numbers(root, "dX_of_vKw_at_fixed_x", want, 30);
    near_array("shape derivative of v.K w", D, want, 30, tolerance);
}

static void cavity(const cJSON *root)
{
    double x[18], v[18], w[18], g[18], s[108], want[108], V = 0.0;
    struct pm_cavity c;
    pm_cavity_set(&c, 6);
    reference_numbers(root, "x", x, 18);
    reference_numbers(root, "v", v, 18);
    reference_numbers(root, "w", w, 18);
    pm_cavity_vec(&c, x, x, g);
    for (int k = 0; k < 18; k++) {
        V += x[k] * g[k] / 6;
        g[k] *= 0.5;
    }
    near_rel("cavity volume", V, cJSON_GetObjectItemCaseSensitive(root, "V")->valuedouble,
             tolerance);
    reference_numbers(root, "gradV", want, 18);
    near_array("its gradient", g, want, 18, tolerance);
    pm_cavity_vec(&c, x, v, g);
    reference_numbers(root, "D2V_v", want, 18);
    near_array("second derivative", g, want, 18, tolerance);
    pm_cavity_vec(&c, v, w, g);
    reference_numbers(root, "D3V_vw", want, 18);
    near_array("third derivative", g, want, 18, tolerance);
    pm_cavity_hessian(&c, x, s);
    reference_numbers(root, "s_ab", want, 108);
    near_array("Hessian blocks", s, want, 108, tolerance);
    /* the same face with a bubble of amplitude 0, and the flat one by its vertices */
    double y[21] = {0}, big[21], V7 = 0.0, V3 = 0.0, exact;
    memcpy(y, x, sizeof x);
    pm_cavity_set(&c, 7);
    pm_cavity_vec(&c, y, y, big);
    for (int k = 0; k < 21; k++)
        V7 += y[k] * big[k] / 6;
    near_rel("7 nodes, no bubble: the same volume", V7, V, 1e-14);
    pm_cavity_set(&c, 3);
    pm_cavity_vec(&c, x, x, g);
    for (int k = 0; k < 9; k++)
        V3 += x[k] * g[k] / 6;
    double n[3];
    pm_vcross(x + 3, x + 6, n);
    exact = pm_dot3(x, n) / 6;
    near_rel("3 nodes: the tetrahedron with the origin", V3, exact, tolerance);
}

/* integral of x^a y^b z^c over the reference tetrahedron (c < 0: triangle) */
static double monomial(int a, int b, int c)
{
    return tgamma(a + 1.0) * tgamma(b + 1.0) * (c < 0 ? 1.0 : tgamma(c + 1.0)) /
           tgamma(a + b + (c < 0 ? 3.0 : c + 4.0));
}

static void quadrature(void)
{
    static const struct {
        const char *element;
        int degree;
    } rule[] = {{"tet4", 1}, {"tet10", 2}, {"tet15", 5}};
    const struct pm_mesh quadratic = {.npe = 10};
    for (int k = 0; k < 3; k++) {
        const struct pm_element_type *t = NULL;
        struct pm_err err = {0};
        double worst = 0.0;
        int degree = rule[k].degree;
        pm_element_type(rule[k].element, &quadratic, &t, &err);
        for (int a = 0; a <= degree; a++)
            for (int b = 0; a + b <= degree; b++)
                for (int c = 0; a + b + c <= degree; c++) {
                    double s = 0.0;
                    for (int q = 0; q < t->nq; q++)
                        s += t->weight[q] * pow(t->xi[q][0], a) * pow(t->xi[q][1], b) *
                             pow(t->xi[q][2], c);
                    worst = fmax(worst, fabs(s - monomial(a, b, c)));
                }
        ok(worst < 1e-16, "rule of %s exact to degree %d: %.1e", rule[k].element, degree, worst);
    }
    for (int n = 6; n <= 7; n++) {
        struct pm_cavity c;
        double worst = 0.0;
        int degree = n == 6 ? 4 : 8; /* of cubic times two derivatives: 7 */
        pm_cavity_set(&c, n);
        for (int a = 0; a <= degree; a++)
            for (int b = 0; a + b <= degree; b++) {
                double s = 0.0;
                for (int q = 0; q < c.nq; q++) { /* the point from the shape functions */
                    double x = c.N[q][1] + 0.5 * (c.N[q][3] + c.N[q][4]),
                           y = c.N[q][2] + 0.5 * (c.N[q][4] + c.N[q][5]);
                    s += c.weight[q] * pow(x, a) * pow(y, b);
                }
                worst = fmax(worst, fabs(s - monomial(a, b, -1)));
            }
        ok(worst < (n == 6 ? 2e-16 : 4e-15), "rule of faces of %d nodes exact to degree %d: %.1e",
           n, degree, worst); /* the 16-point rule has 15 digits */
    }
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
