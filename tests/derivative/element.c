/* Every derivative of every element, for all laws, against central differences of the one before:
 * energy -> forces -> K v -> third -> shape terms, on a curved tetrahedron. */
#include <math.h>

#include "tests/lanes.h"
#include "tests/reference.h"
#include "tests/tap.h"

/* Central differences with h = 1e-4 of the size: truncation 1e-8 times ratios of derivatives,
 * rounding 1e-12. */
static const double h = 1e-4, tolerance = 2e-6;

enum { MOST = 3 * PM_MOST_NODES };

struct setting {
    struct pm_law law;
    const struct pm_element_type *type;
    int n;
    double X[MOST], x[MOST], v[MOST], w[MOST], z[MOST];
};

static void displacement(const struct setting *s, const double *X, const double *x, double *u)
{
    for (int k = 0; k < s->n; k++)
        u[k] = x[k] - X[k];
}

static double dot(int n, const double *a, const double *b)
{
    double s = 0.0;
    for (int k = 0; k < n; k++)
        s += a[k] * b[k];
    return s;
}

/* E (order 0), v.f (1), v.K w (2) at reference X, deformed x. */
static double value(const struct setting *s, const double *X, const double *x, int order)
{
    double u[MOST], f[MOST];
    struct lanes_element el;
    lanes_element_set(&el, s->type, &s->law, X);
    displacement(s, X, x, u);
    if (order == 0)
        return lanes_element_energy(&el, u, NULL);
    if (order == 1)
        lanes_element_energy(&el, u, f);
    else
        lanes_element_apply(&el, u, s->w, f);
    return dot(s->n, s->v, f);
}

/* Central difference of value along d of X (move_X) or x. */
static double difference(const struct setting *s, int order, int move_X, const double *d)
{
    double side[2];
    for (int k = 0; k < 2; k++) {
        double X[MOST], x[MOST];
        for (int i = 0; i < s->n; i++) {
            X[i] = s->X[i] + (move_X ? (k ? h : -h) * d[i] : 0.0);
            x[i] = s->x[i] + (move_X ? 0.0 : (k ? h : -h) * d[i]);
        }
        side[k] = value(s, X, x, order);
    }
    return (side[1] - side[0]) / (2 * h);
}

/* Independent pressures and stresses: at the same place they are those of the displacements, and
 * the linearised ones err by the square of the step. */
static void mixed(const struct setting *s, const struct lanes_element *el, double *u,
                  const double *K)
{
    enum { N = PM_MIXED * PM_MOST_POINTS };
    double zero[MOST] = {0}, du[MOST], p0[N], p1[N], exact[N], same[MOST * MOST], far = 0.0,
           near = 0.0;
    for (int k = 0; k < s->n; k++)
        du[k] = 1e-3 * s->z[k];
    lanes_element_mixed(el, u, zero, p0);
    lanes_element_tangent(el, u, p0, same);
    near_array("mixed tangent with the stresses of its place", same, K, s->n * s->n, 1e-13);
    lanes_element_mixed(el, u, du, p1);
    for (int k = 0; k < s->n; k++)
        u[k] += du[k];
    lanes_element_mixed(el, u, zero, exact);
    for (int q = 0; q < PM_MIXED * s->type->nq; q++) {
        near = fmax(near, fabs(p1[q] - exact[q]));
        far = fmax(far, fabs(p0[q] - exact[q]));
    }
    ok(near < 0.05 * far, "linearised stresses are second order: %.2e against %.2e", near, far);
}

static void check(struct setting *s, const char *law, const char *element)
{
    struct pm_err err = {0};
    const struct pm_mesh quadratic = {.npe = 10};
    double u[MOST], f[MOST], Kv[MOST], T[MOST], D[MOST], zero[MOST] = {0}, K[MOST * MOST],
                                                         Kv2[MOST] = {0};
    struct lanes_element el;
    pm_element_type(element, &quadratic, &s->type, &err);
    s->n = 3 * s->type->npe;
    lanes_element_set(&el, s->type, &s->law, s->X);
    displacement(s, s->X, s->x, u);
    printf("# %s, %s (b = %g)\n", law, element, el.el.blend);
    lanes_element_energy(&el, u, f);
    near_rel("forces", dot(s->n, f, s->z), difference(s, 0, 0, s->z), tolerance);
    lanes_element_apply(&el, u, s->z, Kv);
    near_rel("K v", dot(s->n, Kv, s->v), difference(s, 1, 0, s->z), tolerance);
    lanes_element_tangent(&el, u, NULL, K);
    for (int k = 0; k < s->n * s->n; k++)
        Kv2[k / s->n] += K[k] * s->z[k % s->n];
    near_array("assembled K", Kv2, Kv, s->n, 1e-13);
    lanes_element_third(&el, u, s->v, s->w, T);
    near_rel("third", dot(s->n, T, s->z), difference(s, 2, 0, s->z), tolerance);
    lanes_element_shape(&el, u, s->v, 0, NULL, NULL, D);
    near_rel("shape of v.f", dot(s->n, D, s->z), difference(s, 1, 1, s->z), tolerance);
    lanes_element_shape(&el, u, zero, 1, s->v, s->w, D);
    near_rel("shape of v.K w", dot(s->n, D, s->z), difference(s, 2, 1, s->z), tolerance);
    mixed(s, &el, u, K);
}

int main(void)
{
    struct setting s = {.n = 0};
    cJSON *root = reference_load("tests/data/element_tet10.json");
    static const struct {
        const char *name;
        ptrdiff_t n;
        double c[4], kappa;
    } law[] = {{"neo-hookean", 1, {0.465}, 46.5},
               {"mooney-rivlin", 2, {0.2, 0.05}, 30},
               {"yeoh", 3, {0.2, -0.01, 0.002}, 300},
               {"ogden", 4, {0.3, 1.7, -0.02, -3.1}, 40}};
    static const char *const element[] = {"tet10-blend", "tet10", "tet10-mean", "tet4", "tet15"};
    if (root == NULL)
        return tap_bail("no reference");
    reference_numbers(root, "X", s.X, 30);
    reference_numbers(root, "x", s.x, 30);
    reference_numbers(root, "v", s.v, 30);
    reference_numbers(root, "w", s.w, 30);
    for (int k = 30; k < MOST; k++) { /* amplitudes of bubbles */
        s.x[k] = 0.02 * sin(2.3 * k);
        s.v[k] = 0.3 * cos(0.9 * k);
        s.w[k] = 0.2 * sin(1.1 * k + 0.4);
    }
    for (int k = 0; k < MOST; k++)
        s.z[k] = cos(1.7 * k + 0.3);
    for (int k = 0; k < 4; k++)
        for (int e = 0; e < 5; e++) {
            struct pm_err err = {0};
            if (ok(pm_law_set(&s.law, law[k].name, law[k].n, law[k].c, law[k].kappa, &err) == PM_OK,
                   "law %s", law[k].name))
                check(&s, law[k].name, element[e]);
        }
    cJSON_Delete(root);
    return tap_done();
}
