/* Material laws against tests/data/material_point.json (P, A:G and T(G, H) of the whole law at one
 * point). */
#include "common/mechanics/law.h"

#include "common/mechanics/tensor.h"
#include "tests/lanes.h"
#include "tests/reference.h"
#include "tests/tap.h"

/* Reference digits agree with complex steps to 2e-14, as measured when they were made. */
static const double tolerance = 5e-14;

static void compare(const cJSON *root, const char *item, const char *name, int n, const double *c,
                    double kappa)
{
    const cJSON *law = cJSON_GetObjectItem(cJSON_GetObjectItem(root, "laws"), item);
    struct pm_law l;
    struct pm_err err = {0};
    double F[9], G[9], H[9], C[9], FG[9], FH[9], GH[9], P[9], AG[9], T[9], A[81], AG2[9] = {0},
                                                                                  want[9];
    reference_numbers(root, "F", F, 9);
    reference_numbers(root, "G", G, 9);
    reference_numbers(root, "H", H, 9);
    ok(pm_law_set(&l, name, n, c, kappa, &err) == PM_OK, "%s is known", name);
    double J = pm_cofactor(F, C), W = lanes_law_stress(&l, F, P) + 0.5 * kappa * (J - 1) * (J - 1);
    pm_cross9(F, G, FG);
    pm_cross9(F, H, FH);
    pm_cross9(G, H, GH);
    lanes_law_apply(&l, F, G, AG);
    lanes_law_tangent(&l, F, A);
    for (int k = 0; k < 9; k++)
        AG2[k] = pm_dot9(A + 9 * k, G);
    near_array("tangent matrix times G is A:G", AG2, AG, 9, tolerance);
    lanes_law_third(&l, F, G, H, T);
    pm_axpy9(kappa * (J - 1), C, P);
    pm_axpy9(kappa * (J - 1), FG, AG);
    pm_axpy9(kappa * pm_dot9(C, G), C, AG);
    pm_axpy9(kappa * pm_dot9(FG, H), C, T);
    pm_axpy9(kappa * pm_dot9(C, G), FH, T);
    pm_axpy9(kappa * pm_dot9(C, H), FG, T);
    pm_axpy9(kappa * (J - 1), GH, T);
    reference_numbers(law, "W", want, 1);
    near_rel("W", W, want[0], tolerance);
    reference_numbers(law, "P", want, 9);
    near_array("P", P, want, 9, tolerance);
    reference_numbers(law, "AG", want, 9);
    near_array("A:G", AG, want, 9, tolerance);
    reference_numbers(law, "T_GH", want, 9);
    near_array("T(G, H)", T, want, 9, tolerance);
}

int main(void)
{
    cJSON *root = reference_load("tests/data/material_point.json");
    if (root == NULL)
        return tap_bail("no reference");
    compare(root, "NeoHooke", "neo-hookean", 1, (const double[]){0.465}, 46.5);
    compare(root, "MooneyRivlin", "mooney-rivlin", 2, (const double[]){0.2, 0.05}, 30.0);
    double c[3];
    const cJSON *yeoh = cJSON_GetObjectItem(cJSON_GetObjectItem(root, "laws"), "Yeoh");
    reference_numbers(cJSON_GetObjectItem(yeoh, "params"), "c", c, 3);
    compare(root, "Yeoh", "yeoh", 3, c, 30.0);
    compare(root, "Ogden", "ogden", 6, (const double[]){0.4, 1.3, 0.01, 5, -0.02, -2}, 30.0);
    struct pm_law l;
    struct pm_err err = {0};
    ok(pm_law_set(&l, "rubber", 3, c, 1.0, &err) == PM_INPUT, "an unknown law is refused: %s",
       err.text);
    cJSON_Delete(root);
    return tap_done();
}
