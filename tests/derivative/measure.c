/* Measures against reference values and against differences of themselves. */
#include "common/actuation/measure.h"
#include "common/base/memory.h"
#include "tests/actuated.h"
#include "tests/reference.h"
#include "tests/tap.h"

static struct pm_err err;

static void check_reference(const cJSON *json)
{
    static const struct {
        const char *name, *measure;
    } known[] = {{"3T", "3T"}, {"3R_exact", "3R"}, {"1R2T", "1R2T"},
                 {"2T", "2T"}, {"2R", "2R"},       {"6D", "3R3T"}};
    double U[6], J3[18], J6[36], J2[12];
    const cJSON *item;
    int index = 0;

    reference_numbers(json, "U", U, 6);
    reference_numbers(json, "J", J3, 18);
    reference_numbers(json, "J6", J6, 36);
    for (int i = 0; i < 12; i++)
        J2[i] = J3[3 * (i / 2) + i % 2];
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(json, "cases"))
    {
        const char *name = cJSON_GetObjectItemCaseSensitive(item, "case")->valuestring;
        struct pm_case c = {0};
        struct pm_load load = {.weight = 1};
        double face, sign, w, want_w, dU[6], dJ[36], lambda = 0, want[36], got[36];
        char label[64];
        size_t k = 0;
        while (k < sizeof known / sizeof *known && strcmp(known[k].name, name) != 0)
            k++;
        reference_numbers(item, "lam", &lambda, 1);
        if (k == sizeof known / sizeof *known || lambda != 0)
            continue; /* other fields of the paper, not used */
        snprintf(c.measure, sizeof c.measure, "%s", known[k].measure);
        if (pm_measure_select(&c, known[k].measure, &err) != PM_OK)
            ok(0, "%s", err.text);
        c.nchambers = c.ndofs;
        if (reference_numbers(item, "face", &face, 1) == 0)
            reference_numbers(item, "varying", &face, 1);
        reference_numbers(item, "sign", &sign, 1);
        reference_numbers(item, "w", &want_w, 1);
        load.face = (int)face;
        load.sign = (int)sign;
        const int n = (int)c.nchambers;
        const double *J = n == 2 ? J2 : n == 3 ? J3 : J6;
        snprintf(label, sizeof label, "%s reference %d", name, index++);
        ok(pm_measure_point(&c, PM_FORM_BOUNDARY, &load, U, J, &w, dU, dJ, &err) == PM_OK, "%s",
           label);
        near_rel(label, w, want_w, 1e-12);
        ptrdiff_t count = reference_numbers(item, "dw_dU", want, 36);
        for (int i = 0; i < count; i++)
            got[i] = dU[c.dofs[i]];
        near_array(label, got, want, count, 1e-12);
        count = reference_numbers(item, "dw_dJ", want, 36);
        for (int i = 0; i < count; i++)
            got[i] = dJ[n * c.dofs[i / n] + i % n];
        if (count == 0) {
            count = reference_numbers(item, "dw_dJcol", want, 36);
            for (int i = 0; i < count; i++)
                got[i] = dJ[n * c.dofs[i] + load.face];
        }
        near_array(label, got, want, count, 1e-12);
    }
}

/* Fourth-order central differences over all entries of (U, J). */
static void check_differences(const char *measure, enum pm_form form, double scale)
{
    struct pm_case c = {0};
    double q[42], dq[42], want[42], w;
    char label[96];

    if (pm_measure_select(&c, measure, &err) != PM_OK)
        ok(0, "%s", err.text);
    const int n = c.ndofs;
    c.nchambers = n;
    for (int i = 0; i < 6 + 6 * n; i++)
        q[i] = scale * sin(1 + 0.7 * i * i);
    const struct pm_load load = {.face = form == PM_FORM_VOLUME ? -1 : n - 1,
                                 .sign = form == PM_FORM_VOLUME ? 1 : -1};
    ok(pm_measure_point(&c, form, &load, q, q + 6, &w, dq, dq + 6, &err) == PM_OK, "%s", measure);
    for (int i = 0; i < 6 + 6 * n; i++) {
        const double h = 1e-3 * scale, old = q[i];
        double f[4];
        for (int k = 0; k < 4; k++) {
            double a[6], b[36];
            q[i] = old + h * (k < 2 ? k - 2 : k - 1);
            f[k] = NAN;
            pm_measure_point(&c, form, &load, q, q + 6, &f[k], a, b, &err);
        }
        q[i] = old;
        want[i] = (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h);
    }
    snprintf(label, sizeof label, "%s, %s form, scale %g: derivatives", measure, pm_form_name(form),
             scale);
    near_array(label, dq, want, 6 + 6 * n, 1e-9); /* h^4 and rounding/h, relative to the largest */
}

int main(void)
{
    static const char *const names[] = {"2T", "3T", "1R2T", "3R", "3R3T", "2R"};
    cJSON *json = reference_load("tests/data/workspace_integrands.json");

    check_reference(json);
    cJSON_Delete(json);
    for (int k = 0; k < 6; k++)
        for (int f = 0; f < (k < 5 ? 2 : 1); f++) {
            check_differences(names[k], (enum pm_form)f,
                              0.3); /* series of the rotation functions */
            check_differences(names[k], (enum pm_form)f, 1.1);
        }
    struct pm_case c = {.nchambers = 3};
    const struct pm_load load = {.sign = 1};
    double U[6] = {0, 0, 0, 3.14159265358979, 0, 0}, J[18] = {1}, w, a[6], b[18];
    ok(pm_measure_select(&c, "2R", &err) == PM_OK &&
           pm_measure_point(&c, PM_FORM_BOUNDARY, &load, U, J, &w, a, b, &err) == PM_NUMERIC,
       "2R refuses the pole: %s", err.text);
    err = (struct pm_err){0};
    ok(pm_measure_check(&c, PM_FORM_VOLUME, &err) == PM_INPUT, "2R has no volume form: %s",
       err.text);
    err = (struct pm_err){0};
    c.nchambers = 2;
    ok(pm_measure_check(&c, PM_FORM_BOUNDARY, &err) == PM_INPUT, "wrong number of chambers: %s",
       err.text);
    return tap_done();
}
