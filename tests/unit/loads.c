/* Gauss sets: the published ones, their weights, and that a reduced sum is the full sum
 * [model 7.3]. */
#include "common/actuation/loads.h"
#include "common/base/memory.h"
#include "common/mechanics/rotation.h"
#include "tests/actuated.h"
#include "tests/reference.h"
#include "tests/tap.h"

static struct pm_err err;

/* The points of one published set, as ratios to pmax, with face, sign and weight. */
static void check_published(const cJSON *sets, const char *name, const char *chambers,
                            const char *group, const char *measure)
{
    const cJSON *set = cJSON_GetObjectItemCaseSensitive(sets, name), *item;
    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n = 0, g = 0;
    int same = 1;

    if (actuated_case(&c, chambers, group, measure, 2, &err) != PM_OK ||
        pm_load_set(&c, PM_FORM_BOUNDARY, &loads, &n, &err) != PM_OK) {
        ok(0, "%s: %s", name, err.text);
        return;
    }
    ok(n == cJSON_GetArraySize(set), "%s: %td points, published %d", name, n,
       cJSON_GetArraySize(set));
    const int power = strcmp(measure, "2R") == 0 ? 1 : (int)c.nchambers - 1;
    cJSON_ArrayForEach(item, set)
    {
        double p[8], sign, face, tau, multiplicity;
        if (g >= n)
            break;
        const struct pm_load *l = &loads[g++];
        const ptrdiff_t np = reference_numbers(item, "p_over_pmax", p, 8);
        if (reference_numbers(item, "face", &face, 1) == 0)
            reference_numbers(item, "varying", &face, 1);
        reference_numbers(item, "sign", &sign, 1);
        reference_numbers(item, "multiplicity", &multiplicity, 1);
        reference_numbers(item, "tau_over_pmax_pow", &tau, 1);
        for (ptrdiff_t r = 0; r < np; r++)
            same = same && fabs(l->p[r] / c.pmax - p[r]) < 1e-14;
        same = same && np == c.nchambers && l->face == (int)face && l->sign == (int)sign &&
               l->multiplicity == (int)multiplicity &&
               fabs(l->weight / pow(c.pmax, power) - tau) < 1e-14;
    }
    ok(same, "%s: points, faces, signs, weights as published", name);
    pm_free(loads);
    pm_case_release(&c);
}

static double sum_of(const struct pm_case *c, enum pm_form form, const struct pm_symmetry *y,
                     ptrdiff_t *n)
{
    struct pm_load *loads = NULL;
    double sum = 0;
    *n = 0;
    if (pm_load_set(c, form, &loads, n, &err) != PM_OK)
        return NAN;
    for (ptrdiff_t g = 0; g < *n; g++) {
        double U[6], J[6 * PM_MAX_CHAMBERS], w, a[6], b[6 * PM_MAX_CHAMBERS];
        actuated_robot(y, (int)c->nchambers, c->pmax, loads[g].p, U, J);
        if (pm_measure_point(c, form, &loads[g], U, J, &w, a, b, &err) != PM_OK)
            return NAN;
        sum += loads[g].weight * w;
    }
    pm_free(loads);
    return sum;
}

static void check_reduced(const char *measure, const char *group, int m, const ptrdiff_t counts[4])
{
    struct pm_case reduced = {0}, full = {0};
    char name[96];
    ptrdiff_t n[4];

    if (actuated_case(&reduced, actuated_three, group, measure, m, &err) != PM_OK ||
        actuated_case(&full, actuated_listed, "none", measure, m, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    for (int f = 0; f < 2; f++) {
        if (!pm_measure_has_form(&full, (enum pm_form)f))
            continue;
        const double a = sum_of(&full, (enum pm_form)f, &reduced.symmetry, &n[2 * f]);
        const double b = sum_of(&reduced, (enum pm_form)f, &reduced.symmetry, &n[2 * f + 1]);
        snprintf(name, sizeof name, "%s, %s, %s, m = %d: reduced sum", measure, group,
                 pm_form_name((enum pm_form)f), m);
        near_rel(name, b, a, 1e-12); /* rounding of sums of up to 54 terms */
        ok(n[2 * f] == counts[2 * f] && n[2 * f + 1] == counts[2 * f + 1], "%s: %td of %td points",
           name, n[2 * f + 1], n[2 * f]);
    }
    pm_case_release(&reduced);
    pm_case_release(&full);
}

/* Both forms integrate the same volume: equal once the rule resolves the map. */
static void check_forms(const char *measure)
{
    struct pm_case c = {0};
    char name[64];
    ptrdiff_t n;
    if (actuated_case(&c, actuated_listed, "none", measure, 10, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    const double b = sum_of(&c, PM_FORM_BOUNDARY, &c.symmetry, &n),
                 v = sum_of(&c, PM_FORM_VOLUME, &c.symmetry, &n);
    snprintf(name, sizeof name, "%s: boundary form = volume form", measure);
    near_rel(name, b, v, 1e-11); /* both converged at 10 points: rounding */
    pm_case_release(&c);
}

/* The path of 2R encloses the images of the faces p_r = 0: sum of the integrals of n.(n_a x n_b)
 * over them. */
static void check_solid_angle(void)
{
    struct pm_case c = {0}, faces = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n, points;
    double area = 0;

    if (actuated_case(&c, actuated_three, "c3 mirror-y", "2R", 16, &err) != PM_OK ||
        actuated_case(&faces, actuated_listed, "none", "3T", 16, &err) != PM_OK ||
        pm_load_set(&faces, PM_FORM_BOUNDARY, &loads, &n, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    for (ptrdiff_t g = 0; g < n; g++) {
        double U[6], J[18], e[3], d[2][3] = {{0}};
        struct pm_rotation rot;
        if (loads[g].sign > 0)
            continue;
        actuated_robot(&c.symmetry, 3, c.pmax, loads[g].p, U, J);
        pm_rotation_at(U + 3, 0, &rot);
        for (int i = 0; i < 3; i++) {
            e[i] = rot.R[3 * i + 2];
            for (int k = 0; k < 6; k++)
                d[k / 3][i] +=
                    rot.Ri[k % 3][3 * i + 2] * J[3 * (3 + k % 3) + (loads[g].face + 1 + k / 3) % 3];
        }
        area += loads[g].weight * (e[0] * (d[0][1] * d[1][2] - d[0][2] * d[1][1]) +
                                   e[1] * (d[0][2] * d[1][0] - d[0][0] * d[1][2]) +
                                   e[2] * (d[0][0] * d[1][1] - d[0][1] * d[1][0]));
    }
    near_rel("2R: path integral = area on the sphere",
             sum_of(&c, PM_FORM_BOUNDARY, &c.symmetry, &points), area,
             1e-10); /* both converged at 16 points */
    pm_free(loads);
    pm_case_release(&c);
    pm_case_release(&faces);
}

/* Chambers at pmax and multiplicity of the guards of three chambers under c3: one, two, all. */
static void check_corners(void)
{
    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n = 0;

    if (actuated_case(&c, actuated_three, "c3 mirror-y", "3T", 2, &err) != PM_OK)
        ok(0, "%s", err.text);
    c.gap_min = 1;
    ok(pm_load_set(&c, PM_FORM_BOUNDARY, &loads, &n, &err) == PM_OK && n == 6 + 3,
       "%td points and guards", n);
    for (int k = 1; k <= 3 && n == 9; k++) {
        const struct pm_load *l = loads + 5 + k;
        int high = 0;
        for (int r = 0; r < 3; r++)
            high += l->p[r] == c.pmax;
        ok(l->weight == 0 && high == k && l->multiplicity == (k == 3 ? 1 : 3),
           "%d chambers at pmax, for %d", high, l->multiplicity);
    }
    pm_free(loads);
    c.full_set = 1;
    ok(pm_load_set(&c, PM_FORM_BOUNDARY, &loads, &n, &err) == PM_OK && n == 24 + 7,
       "%td points and guards of the full set", n);
    pm_free(loads);
    pm_case_release(&c);
}

/* The form of the case ends with the corners of the box, without weight. */
static void check_guard(void)
{
    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n = 0, without = 0;

    if (actuated_case(&c, actuated_two, "mirror-x mirror-y", "2T", 2, &err) != PM_OK)
        ok(0, "%s", err.text);
    for (int f = 0; f < 2; f++) {
        c.amplification_max = 0;
        ok(pm_load_set(&c, (enum pm_form)f, &loads, &without, &err) == PM_OK, "%s form",
           pm_form_name((enum pm_form)f));
        pm_free(loads);
        c.amplification_max = 2;
        ok(pm_load_set(&c, (enum pm_form)f, &loads, &n, &err) == PM_OK &&
               n == without + (f == PM_FORM_BOUNDARY),
           "%td points, %td with the guard", without, n);
        if (f == PM_FORM_BOUNDARY)
            ok(loads[n - 1].weight == 0 && loads[n - 1].p[0] == c.pmax &&
                   loads[n - 1].p[1] == c.pmax,
               "all at pmax, without weight");
        pm_free(loads);
        c.gap_min = 1;
        ok(pm_load_set(&c, (enum pm_form)f, &loads, &n, &err) == PM_OK &&
               n == without + 2 * (f == PM_FORM_BOUNDARY),
           "%td points, %td with those of gap_min", without, n);
        if (f == PM_FORM_BOUNDARY)
            ok(loads[n - 2].weight == 0 && loads[n - 2].multiplicity == 2 &&
                   loads[n - 2].p[0] == c.pmax && loads[n - 2].p[1] == c.pmin,
               "one chamber at pmax for both");
        pm_free(loads);
        c.gap_min = 0;
    }
    pm_case_release(&c);
}

int main(void)
{
    cJSON *json = reference_load("tests/data/gauss_sets.json");
    const cJSON *sets = cJSON_GetObjectItemCaseSensitive(json, "cases");

    check_published(sets, "2A0R2T", actuated_two, "mirror-x mirror-y", "2T");
    check_published(sets, "3A0R3T", actuated_three, "c3 mirror-y", "3T");
    check_published(sets, "3A3R0T", actuated_three, "c3", "3R");
    check_published(sets, "3A1R2T", actuated_stack, "c2-x mirror-y", "1R2T");
    check_published(sets, "3A2R0T", actuated_three, "c3 mirror-y", "2R");
    cJSON_Delete(json);

    check_reduced("3T", "c3 mirror-y", 2, (const ptrdiff_t[]){24, 6, 8, 4});
    check_reduced("3T", "c3", 3, (const ptrdiff_t[]){54, 18, 27, 11});
    check_reduced("3R", "c3", 2, (const ptrdiff_t[]){24, 8, 8, 4});
    check_reduced("2R", "c3 mirror-y", 3, (const ptrdiff_t[]){18, 3, 0, 0});
    check_forms("3T");
    check_forms("3R");
    check_solid_angle();

    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n;
    if (actuated_case(&c, actuated_three, "c3 mirror-y", "3R", 2, &err) == PM_OK &&
        pm_load_set(&c, PM_FORM_BOUNDARY, &loads, &n, &err) == PM_OK)
        ok(n == 8, "3R: mirrors are odd and not used, %td points", n);
    else
        ok(0, "%s", err.text);
    pm_free(loads);
    loads = NULL;
    c.points = 1000;
    ok(pm_load_set(&c, PM_FORM_VOLUME, &loads, &n, &err) == PM_INPUT && loads == NULL,
       "a huge set is refused");
    pm_case_release(&c);
    check_guard();
    check_corners();
    return tap_done();
}
