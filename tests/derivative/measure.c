/* Measures against reference values and against differences of themselves. */
#include "common/actuation/amplification.h"
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
        int taylor;
    } known[] = {{"3T", "3T", 0}, {"3R_exact", "3R", 0}, {"3R_eq16", "3R", 1}, {"1R2T", "1R2T", 0},
                 {"2T", "2T", 0}, {"2R", "2R", 0},       {"6D", "3R3T", 0}};
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
            continue; /* other fields, not used */
        c.taylor = known[k].taylor;
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

/* Fourth-order central differences over all entries of (U, J) of the case. */
static void check_case(const struct pm_case *c, const char *text, enum pm_form form, double scale)
{
    double q[42] = {0}, dq[42], want[42], w;
    char label[128];
    const int n = (int)c->nchambers;

    for (int i = 0; i < 6 + 6 * n; i++)
        q[i] = scale * sin(1 + 0.7 * i * i);
    const struct pm_load load = {.face = form == PM_FORM_VOLUME ? -1 : n - 1,
                                 .sign = form == PM_FORM_VOLUME ? 1 : -1};
    ok(pm_measure_point(c, form, &load, q, q + 6, &w, dq, dq + 6, &err) == PM_OK, "%s", text);
    for (int i = 0; i < 6 + 6 * n; i++) {
        const double h = 1e-3 * scale, old = q[i];
        double f[4];
        for (int k = 0; k < 4; k++) {
            double a[6], b[36];
            q[i] = old + h * (k < 2 ? k - 2 : k - 1);
            f[k] = NAN;
            pm_measure_point(c, form, &load, q, q + 6, &f[k], a, b, &err);
        }
        q[i] = old;
        want[i] = (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h);
    }
    snprintf(label, sizeof label, "%s, %s form, scale %g: derivatives", text, pm_form_name(form),
             scale);
    near_array(label, dq, want, 6 + 6 * n, 1e-9); /* h^4 and rounding/h, relative to the largest */
}

static void check_differences(const char *measure, enum pm_form form, double scale)
{
    struct pm_case c = {0};
    if (pm_measure_select(&c, measure, &err) != PM_OK)
        ok(0, "%s", err.text);
    c.nchambers = c.ndofs;
    check_case(&c, measure, form, scale);
}

/* Every weight on position and direction with every measure that takes one; widths of the order of
 * the poses. */
static void check_weights(void)
{
    static const char *const measures[] = {"2T", "3T", "1R2T", "3R", "3R3T", "manifold"};
    static const char *const kinds[] = {"none", "box", "gaussian", "half-space"};
    for (int m = 0; m < 6; m++)
        for (int k = 1; k <= PM_WEIGHT_HALF_SPACE; k++)
            for (int direction = 0; direction < 2; direction++) {
                struct pm_case c = {.ndofs = 3, .dofs = {0, 2, 4}, .lever = 20};
                char label[64];
                if (pm_measure_select(&c, measures[m], &err) != PM_OK)
                    ok(0, "%s", err.text);
                c.nchambers = m == 5 ? 2 : c.ndofs;
                c.weight = (struct pm_weight){.kind = (enum pm_weight_kind)k,
                                              .direction = direction,
                                              .center = {0.2, -0.1, direction ? 0.9 : 0.3},
                                              .size = {0.8, 1.1, 0.7},
                                              .normal = {0.6, 0, 0.8},
                                              .width = 0.5};
                snprintf(label, sizeof label, "%s, %s on %s", measures[m], kinds[k],
                         direction ? "direction" : "position");
                check_case(&c, label, PM_FORM_VOLUME, 1.1);
            }
}

/* The surface that U = (p1, p2, p1^2) makes, (1 + 4 p1^2)^(1/2) dp1 dp2; and of one chamber the
 * length of a helix with radius 3 and lever 20. */
static void check_manifold(void)
{
    struct pm_case c = {.nchambers = 2, .ndofs = 3, .dofs = {0, 1, 2}, .measure = "manifold"};
    const struct pm_load load = {.face = -1, .sign = 1};
    double U[6] = {0}, J[12] = {1, 0, 0, 1, 0.6, 0}, w, a[6], b[12];

    ok(pm_measure_point(&c, PM_FORM_VOLUME, &load, U, J, &w, a, b, &err) == PM_OK, "manifold");
    near_rel("area of a parabolic cylinder", w, sqrt(1.36), 1e-15);
    ok(strcmp(pm_measure_unit(&c), "mm2") == 0, "unit of two translations by two chambers: %s",
       pm_measure_unit(&c));
    check_case(&c, "manifold, 2 chambers, 3 DoFs", PM_FORM_VOLUME, 1.1);

    c = (struct pm_case){
        .nchambers = 1, .ndofs = 4, .dofs = {0, 1, 2, 5}, .lever = 20, .measure = "manifold"};
    const double helix[6] = {0, 3, 0.5, 0, 0, 1};
    ok(pm_measure_point(&c, PM_FORM_VOLUME, &load, U, helix, &w, a, b, &err) == PM_OK, "curve");
    near_rel("speed along a helix with its turn", w, sqrt(9 + 0.25 + 400), 1e-15);
    check_case(&c, "manifold, 1 chamber, 4 DoFs", PM_FORM_VOLUME, 1.1);

    err = (struct pm_err){0};
    const double parallel[12] = {1, 2, 1, 2, 1, 2};
    c = (struct pm_case){.nchambers = 2, .ndofs = 3, .dofs = {0, 1, 2}, .measure = "manifold"};
    ok(pm_measure_point(&c, PM_FORM_VOLUME, &load, U, parallel, &w, a, b, &err) == PM_NUMERIC,
       "dependent columns are refused: %s", err.text);
}

static void check_refusals(void)
{
    static const struct {
        const char *what;
        enum pm_form form;
        struct pm_case c;
    } bad[] = {
        {"2R: volume form", PM_FORM_VOLUME, {.measure = "2R", .nchambers = 3}},
        {"2R: chambers", PM_FORM_BOUNDARY, {.measure = "2R", .nchambers = 2}},
        {"3R: taylor by volume", PM_FORM_VOLUME, {.measure = "3R", .nchambers = 3, .taylor = 1}},
        {"3T: taylor", PM_FORM_BOUNDARY, {.measure = "3T", .nchambers = 3, .taylor = 1}},
        {"3T: weight by boundary",
         PM_FORM_BOUNDARY,
         {.measure = "3T", .nchambers = 3, .weight = {.kind = PM_WEIGHT_GAUSSIAN}}},
        {"2R: weight",
         PM_FORM_BOUNDARY,
         {.measure = "2R", .nchambers = 3, .weight = {.kind = PM_WEIGHT_GAUSSIAN}}},
        {"manifold: boundary",
         PM_FORM_BOUNDARY,
         {.measure = "manifold", .nchambers = 1, .ndofs = 1}},
        {"manifold: more chambers than DoFs",
         PM_FORM_VOLUME,
         {.measure = "manifold", .nchambers = 3, .ndofs = 2, .dofs = {0, 2}}},
        {"manifold: no lever",
         PM_FORM_VOLUME,
         {.measure = "manifold", .nchambers = 1, .ndofs = 2, .dofs = {0, 4}}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct pm_case c = bad[i].c;
        err = (struct pm_err){0};
        if (pm_measure_select(&c, bad[i].c.measure, &err) != PM_OK)
            ok(0, "%s", err.text);
        ok(pm_measure_check(&c, bad[i].form, &err) == PM_INPUT, "refused, %s: %s", bad[i].what,
           err.text);
    }
}

/* Three of four points alike, the last k times as large: its share of the geometric mean is
 * k^(1/4), so a = k^(3/4) there, and above the limit f = exp(-20 ln(a/limit)^2). */
static void check_amplification(void)
{
    enum { NG = 4, N = 72 };
    struct pm_case c = {.nchambers = 3, .height = 100, .amplification_max = 2};
    double J[N], slope[N], want[N], most, other;
    if (pm_measure_select(&c, "1R2T", &err) != PM_OK)
        ok(0, "%s", err.text);
    for (int i = 0; i < N; i++)
        J[i] = sin(1 + i % 18) * (i % 18 < 9 ? 300 : 3) * (i < 54 ? 1 : 6);
    double f = pm_amplification(&c, NG, J, &most, slope);
    near_rel("amplification of the last point", most, pow(6, 0.75), 1e-13);
    near_rel("f", f, exp(-20 * pow(log(most / 2), 2)), 1e-13);
    for (int i = 0; i < N; i++) {
        const double x = J[i], h = 1e-5 * fabs(x);
        J[i] = x + h;
        const double up = pm_amplification(&c, NG, J, &other, NULL);
        J[i] = x - h;
        want[i] = (up - pm_amplification(&c, NG, J, &other, NULL)) / (2 * h);
        J[i] = x;
    }
    near_array("its derivatives against differences", slope, want, N, 1e-8);
    c.amplification_max = 4;
    near_abs("f within the limit", pm_amplification(&c, NG, J, &most, slope), 1, 0);
    c.amplification_max = 0;
    near_abs("f without one", pm_amplification(&c, NG, J, &most, slope), 1, 0);
    memset(J, 0, 18 * sizeof *J);
    near_abs("f with a point at rest", pm_amplification(&c, NG, J, &most, slope), 1, 0);
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
    struct pm_case taylor = {.measure = "3R", .nchambers = 3, .taylor = 1};
    if (pm_measure_select(&taylor, "3R", &err) != PM_OK)
        ok(0, "%s", err.text);
    check_case(&taylor, "3R, taylor", PM_FORM_BOUNDARY, 1.1);
    /* at rest: a column of the matrix is zero */
    struct pm_case rest = {.nchambers = 3};
    double none[6] = {0}, any[18] = {0.3, 0.1, 2, 1, -1, 0.5, 0.2, 0.7, -0.4}, at_rest = NAN;
    ok(pm_measure_select(&rest, "3T", &err) == PM_OK &&
           pm_measure_point(&rest, PM_FORM_BOUNDARY, &load, none, any, &at_rest, a, b, &err) ==
               PM_OK &&
           at_rest == 0,
       "nothing at rest");
    check_weights();
    check_amplification();
    check_manifold();
    check_refusals();
    return tap_done();
}
