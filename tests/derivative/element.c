/* Every derivative of the element with blended and mean dilatation, for all laws, against central
 * differences of the one before: energy -> forces -> K v -> third -> shape terms, on a curved
 * tetrahedron. */
#include "common/mechanics/element.h"

#include <math.h>

#include "tests/reference.h"
#include "tests/tap.h"

/* Central differences with h = 1e-4 of the size: truncation 1e-8 times ratios of derivatives,
 * rounding 1e-12. */
static const double h = 1e-4, tolerance = 2e-6;

struct setting {
    struct pm_law law;
    double blend, X[30], x[30], v[30], w[30], z[30];
};

static double geometry(const double *X, double *dN, double *wq)
{
    double V = 0.0;
    for (int q = 0; q < 4; q++)
        V += wq[q] = pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN + 30 * q);
    return V;
}

/* E (order 0), v.f (1), v.K w (2) at reference X, deformed x. */
static double value(const struct setting *s, const double *X, const double *x, int order)
{
    double dN[120], wq[4], u[30], f[30] = {0}, det = INFINITY, sum = 0.0;
    struct pm_element el = {.law = &s->law, .blend = s->blend, .dN = dN, .w = wq};
    geometry(X, dN, wq);
    for (int k = 0; k < 30; k++)
        u[k] = x[k] - X[k];
    if (order == 0)
        return pm_element_energy(&el, u, NULL, &det);
    if (order == 1)
        pm_element_energy(&el, u, f, &det);
    else
        pm_element_apply(&el, u, s->w, f);
    for (int k = 0; k < 30; k++)
        sum += s->v[k] * f[k];
    return sum;
}

/* Central difference of value along d of X (move_X) or x. */
static double difference(const struct setting *s, int order, int move_X, const double *d)
{
    double side[2];
    for (int k = 0; k < 2; k++) {
        double X[30], x[30];
        for (int i = 0; i < 30; i++) {
            X[i] = s->X[i] + (move_X ? (k ? h : -h) * d[i] : 0.0);
            x[i] = s->x[i] + (move_X ? 0.0 : (k ? h : -h) * d[i]);
        }
        side[k] = value(s, X, x, order);
    }
    return (side[1] - side[0]) / (2 * h);
}

static double dot(const double *a, const double *b)
{
    double s = 0.0;
    for (int k = 0; k < 30; k++)
        s += a[k] * b[k];
    return s;
}

static void check(struct setting *s, const char *law, const char *element)
{
    struct pm_err err = {0};
    double dN[120], wq[4], u[30], f[30] = {0}, Kv[30] = {0}, T[30] = {0}, D[30] = {0},
                                  zero[30] = {0}, K[900], Kv2[30] = {0};
    double det = INFINITY;
    struct pm_element el = {.law = &s->law, .dN = dN, .w = wq};
    pm_element_blend(element, &s->law, &s->blend, &err);
    el.blend = s->blend;
    geometry(s->X, dN, wq);
    for (int k = 0; k < 30; k++)
        u[k] = s->x[k] - s->X[k];
    printf("# %s, %s (b = %g)\n", law, element, s->blend);
    pm_element_energy(&el, u, f, &det);
    near_rel("forces", dot(f, s->z), difference(s, 0, 0, s->z), tolerance);
    pm_element_apply(&el, u, s->z, Kv);
    near_rel("K v", dot(Kv, s->v), difference(s, 1, 0, s->z), tolerance);
    pm_element_tangent(&el, u, NULL, K);
    for (int k = 0; k < 900; k++)
        Kv2[k / 30] += K[k] * s->z[k % 30];
    near_array("assembled K", Kv2, Kv, 30, 1e-13);
    pm_element_third(&el, u, s->v, s->w, T);
    near_rel("third", dot(T, s->z), difference(s, 2, 0, s->z), tolerance);
    pm_element_shape(&el, u, s->v, 0, NULL, NULL, D);
    near_rel("shape of v.f", dot(D, s->z), difference(s, 1, 1, s->z), tolerance);
    memset(D, 0, sizeof D);
    pm_element_shape(&el, u, zero, 1, s->v, s->w, D);
    near_rel("shape of v.K w", dot(D, s->z), difference(s, 2, 1, s->z), tolerance);
    double p0[4], p1[4], du[30], far = 0.0, near = 0.0;
    for (int k = 0; k < 30; k++)
        du[k] = 1e-3 * s->z[k];
    pm_element_pressure(&el, u, zero, p0);
    pm_element_pressure(&el, u, du, p1);
    for (int k = 0; k < 30; k++)
        u[k] += du[k];
    double exact[4];
    pm_element_pressure(&el, u, zero, exact);
    for (int q = 0; q < 4; q++) {
        near = fmax(near, fabs(p1[q] - exact[q]));
        far = fmax(far, fabs(p0[q] - exact[q]));
    }
    ok(near < 0.05 * far, "linearised pressure is second order: %.2e against %.2e", near, far);
}

int main(void)
{
    struct setting s = {0};
    cJSON *root = reference_load("tests/data/element_tet10.json");
    static const struct {
        const char *name;
        double c[3], kappa;
        int n;
    } law[] = {{"neo-hookean", {0.465}, 46.5, 1},
               {"mooney-rivlin", {0.2, 0.05}, 30, 2},
               {"yeoh", {0.2, -0.01, 0.002}, 300, 3}};
    static const char *const element[] = {"tet10-blend", "tet10", "tet10-mean"};
    if (root == NULL)
        return tap_bail("no reference");
    reference_numbers(root, "X", s.X, 30);
    reference_numbers(root, "x", s.x, 30);
    reference_numbers(root, "v", s.v, 30);
    reference_numbers(root, "w", s.w, 30);
    for (int k = 0; k < 30; k++)
        s.z[k] = cos(1.7 * k + 0.3);
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 3; e++) {
            struct pm_err err = {0};
            pm_law_set(&s.law, law[k].name, law[k].n, law[k].c, law[k].kappa, &err);
            check(&s, law[k].name, element[e]);
        }
    cJSON_Delete(root);
    return tap_done();
}
