/* The sphere map and the B-spline tube: reference values, partition of unity, derivatives, crowded
 * points. */
#include "common/geometry/surface_map.h"

#include "common/base/memory.h"
#include "tools/surfgen/chamber.h"
#include "tests/reference.h"
#include "tests/robot.h"
#include "tests/tap.h"

enum { POINTS = 24, PROBES = 5 };

/* Prototype values: 24 control points, k = 8, derivatives in space; here along the tangents and in
 * normal coordinates. Tolerance: rounding of values of order 1 to 10. */
static void reference_values(void)
{
    static double Phi[72], phi[72], d0[24], S[15], r[15], dr[45], ddr[135], Z[5], own[24];
    static const int first[3] = {0, 0, 1}, second[3] = {0, 1, 1};
    struct pm_surface s = {
        .type = PM_SURFACE_SPHERE, .n = POINTS, .Phi = Phi, .d0 = d0, .phi = phi};
    struct pm_basis b = {0};
    struct pm_map *map = NULL;
    struct pm_err err = {0};
    cJSON *json = reference_load("tests/data/sphere_map.json");
    double error[5] = {0};

    if (reference_numbers(json, "Phi", Phi, 72) != 72 ||
        reference_numbers(json, "phi", phi, 72) != 72 ||
        reference_numbers(json, "d0", d0, 24) != 24 || reference_numbers(json, "S", S, 15) != 15 ||
        reference_numbers(json, "r", r, 15) != 15 ||
        reference_numbers(json, "dr_dS", dr, 45) != 45 ||
        reference_numbers(json, "d2r_dS2", ddr, 135) != 135 ||
        reference_numbers(json, "Z", Z, 5) != 5) {
        ok(0, "reference case is complete");
        return;
    }
    pm_map_support(POINTS, Phi, 8, own, &err);
    near_array("support radii", own, d0, POINTS, 1e-14);
    ok(pm_map_new(&s, &map, &err) == PM_OK, "map of the reference case");
    for (int q = 0; q < PROBES; q++) {
        double x[3], r_a[6], r_ab[9], t[6], sum;
        pm_map_point(map, phi, &S[3 * q], &b, x, r_a, r_ab, &err);
        pm_map_tangents(PM_SURFACE_SPHERE, &S[3 * q], t);
        for (int i = 0; i < 3; i++) {
            const double *B = &dr[9 * q + 3 * i], *D = &ddr[27 * q + 9 * i];
            error[0] = fmax(error[0], fabs(x[i] - r[3 * q + i]));
            for (int a = 0; a < 2; a++)
                error[1] = fmax(error[1], fabs(r_a[3 * a + i] - B[0] * t[3 * a] -
                                               B[1] * t[3 * a + 1] - B[2] * t[3 * a + 2]));
            for (int p = 0; p < 3; p++) {
                sum = 0;
                for (int j = 0; j < 9; j++)
                    sum += D[j] * t[3 * first[p] + j / 3] * t[3 * second[p] + j % 3];
                for (int j = 0; j < 3; j++)
                    sum -= p == 1 ? 0 : B[j] * S[3 * q + j];
                error[2] = fmax(error[2], fabs(sum - r_ab[3 * p + i]));
            }
        }
        pm_map_coverage(map, &S[3 * q], &b, &sum, &err);
        error[3] = fmax(error[3], fabs(sum - Z[q]));
    }
    near_abs("r against the reference", error[0], 0, 1e-14);
    near_abs("r_a against the reference", error[1], 0, 1e-14);
    near_abs("r_ab against the reference", error[2], 0, 2e-14);
    near_abs("sum of kernels against the reference", error[3], 0, 1e-14);
    pm_map_free(map);
    pm_basis_release(&b);
    cJSON_Delete(json);
}

/* Steps of h times the local support; differences of the weights themselves, relative to the
 * largest. */
static void compare(const char *name, const struct pm_surface *s, const double *S, double h)
{
    struct pm_basis b = {0}, side = {0};
    struct pm_map *map = NULL;
    struct pm_err err = {0};
    double sum[6] = {0}, scale[2] = {1e-300, 1e-300}, error[2] = {0}, *num = NULL;

    if (pm_map_new(s, &map, &err) != PM_OK || pm_map_basis(map, S, 2, &b, &err) != PM_OK ||
        PM_NEW(num, 5 * s->n, &err) != PM_OK) {
        ok(0, "%s: %s", name, err.text);
        return;
    }
    for (int a = 0; a < 2; a++) {
        memset(num, 0, (size_t)s->n * 5 * sizeof *num);
        for (int sign = -1; sign <= 1; sign += 2) {
            double d[2] = {a == 0 ? sign * h : 0, a == 1 ? sign * h : 0}, T[3];
            pm_map_move(s->type, S, d, T);
            pm_map_basis(map, T, 0, &side, &err);
            for (ptrdiff_t k = 0; k < side.n; k++) {
                num[5 * side.id[k]] += sign * side.c[k] / (2 * h);
                num[5 * side.id[k] + 1] += side.c[k] / (h * h);
            }
        }
        for (ptrdiff_t k = 0; k < b.n; k++) {
            double d1 = num[5 * b.id[k]], d2 = num[5 * b.id[k] + 1] - 2 * b.c[k] / (h * h);
            scale[0] = fmax(scale[0], fabs(d1));
            scale[1] = fmax(scale[1], fabs(d2));
            error[0] = fmax(error[0], fabs(d1 - b.c_a[2 * k + a]));
            error[1] = fmax(error[1], fabs(d2 - b.c_ab[3 * k + 2 * a]));
        }
    }
    for (ptrdiff_t k = 0; k < b.n; k++) {
        sum[0] += b.c[k];
        for (int a = 0; a < 2; a++)
            sum[1 + a] += b.c_a[2 * k + a];
        for (int a = 0; a < 3; a++)
            sum[3 + a] += b.c_ab[3 * k + a];
    }
    near_abs(name, sum[0], 1, 1e-14);
    ok(fabs(sum[1]) + fabs(sum[2]) < 1e-13 * scale[0], "%s: first derivatives sum to 0", name);
    ok(fabs(sum[3]) + fabs(sum[4]) + fabs(sum[5]) < 1e-13 * scale[1],
       "%s: second derivatives sum to 0", name);
    ok(error[0] < 1e-5 * scale[0], "%s: c_a against differences (%.1e)", name, error[0] / scale[0]);
    ok(error[1] < 1e-4 * scale[1], "%s: c_ab against differences (%.1e)", name,
       error[1] / scale[1]);
    pm_map_free(map);
    pm_basis_release(&b);
    pm_basis_release(&side);
    pm_free(num);
}

/* On the tube direction 1 stays parallel along direction 2, so r_12 is the derivative of r_1. */
static void mixed(const struct pm_surface *s, const double S[3])
{
    struct pm_basis b = {0};
    struct pm_map *map = NULL;
    struct pm_err err = {0};
    double r_a[6], r_ab[9], up[6], down[6], T[3], h = 1e-5, want[3];

    pm_map_new(s, &map, &err);
    pm_map_point(map, s->phi, S, &b, want, r_a, r_ab, &err);
    pm_map_move(s->type, S, (const double[2]){0, h}, T);
    pm_map_point(map, s->phi, T, &b, want, up, NULL, &err);
    pm_map_move(s->type, S, (const double[2]){0, -h}, T);
    pm_map_point(map, s->phi, T, &b, want, down, NULL, &err);
    for (int i = 0; i < 3; i++)
        want[i] = (up[i] - down[i]) / (2 * h);
    near_array("tube: mixed derivative against differences", &r_ab[3], want, 3, 1e-6);
    pm_map_free(map);
    pm_basis_release(&b);
}

int main(void)
{
    struct pm_err err = {0};
    struct pm_surfaces robot = {0};
    const struct robot_chamber ball = {{0, 0, 20}, {6, 5, 12}, 0.1};
    const struct pm_chamber thin = {
        .shape = PM_SHAPE_CAPSULE, .radius = 2, .length = 80, .spacing = 1, .section = {1, 1}};
    struct pm_profile profile = {0};
    struct pm_surface crowd = {0};
    double S[3] = {0.36, 0.48, 0.8}, tube[3] = {0.6, -0.8, 0.37};

    reference_values();
    if (robot_init(&robot, 12, 40, 1, &ball, &err) != PM_OK ||
        pm_profile_new(&thin, &profile, &err) != PM_OK ||
        pm_chamber_seed(&thin, &profile, 2, &crowd, &err) != PM_OK ||
        pm_map_support(crowd.n, crowd.Phi, PM_MAP_NEIGHBOURS, crowd.d0, &err) != PM_OK)
        return tap_bail("%s", err.text);
    compare("icosphere", &robot.s[1], S, 1e-4);
    compare("tube", &robot.s[0], tube, 1e-4);
    tube[2] = 1e-3;
    compare("tube near its rim", &robot.s[0], tube, 1e-4);
    for (ptrdiff_t i = 0; i < 3 * robot.s[0].n; i++)
        robot.s[0].phi[i] += sin(1.7 * (double)i);
    mixed(&robot.s[0], tube);
    /* next to the pole of a capsule of slenderness 20 control points are 1e-9 apart */
    ok(crowd.d0[0] < 1e-7, "a slender capsule crowds its pole (%.1e)", crowd.d0[0]);
    pm_map_middle(PM_SURFACE_SPHERE, &crowd.Phi[3], &crowd.Phi[6], S);
    compare("beside a crowded pole", &crowd, S, 1e-4 * crowd.d0[1]);
    compare("at a crowded pole", &crowd, crowd.Phi, 1e-4 * crowd.d0[0]);
    pm_profile_release(&profile);
    pm_surfaces_release(&robot);
    pm_free(crowd.phi);
    pm_free(crowd.free);
    pm_free(crowd.Phi);
    pm_free(crowd.d0);
    pm_free(crowd.tri);
    return tap_done();
}
