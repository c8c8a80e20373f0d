/* Sums of measures over whole Gauss sets: full and reduced, both forms as points grow, closed forms
 * [model 7.1 to 7.5]. */
#include <gsl/gsl_integration.h>

#include "common/actuation/loads.h"
#include "common/base/memory.h"
#include "tests/actuated.h"
#include "tests/tap.h"

static struct pm_err err;

/* The measure of the synthetic robot with the symmetry of `y`; *absolute = sum of |terms|. */
static double sum_of(const struct pm_case *c, enum pm_form form, const struct pm_symmetry *y,
                     ptrdiff_t *n, double *absolute)
{
    struct pm_load *loads = NULL;
    double sum = 0;

    *n = 0;
    *absolute = 0;
    if (pm_load_set(c, form, &loads, n, &err) != PM_OK)
        return NAN;
    for (ptrdiff_t g = 0; g < *n; g++) {
        double U[6], J[6 * PM_MAX_CHAMBERS], w = NAN, a[6], b[6 * PM_MAX_CHAMBERS];
        actuated_robot(y, (int)c->nchambers, c->pmax, loads[g].p, U, J);
        pm_measure_point(c, form, &loads[g], U, J, &w, a, b, &err);
        sum += loads[g].weight * w;
        *absolute += fabs(loads[g].weight * w);
    }
    pm_free(loads);
    return sum;
}

/* Full against reduced set, pmin = -0.03; `change` sets what the case text of actuated.h has not.
 */
static void check_full(const char *text, const char *chambers, const char *group,
                       const char *measure, int m, void (*change)(struct pm_case *), double within)
{
    struct pm_case c = {0};
    double size;
    ptrdiff_t reduced, full;
    char name[128];

    if (actuated_case(&c, chambers, group, measure, m, &err) != PM_OK)
        ok(0, "%s", err.text);
    c.pmin = -0.03;
    if (change != NULL)
        change(&c);
    for (int f = 0; f < 2; f++) {
        if (!pm_measure_has_form(&c, (enum pm_form)f))
            continue;
        c.full_set = 0;
        const double a = sum_of(&c, (enum pm_form)f, &c.symmetry, &reduced, &size);
        c.full_set = 1;
        const double b = sum_of(&c, (enum pm_form)f, &c.symmetry, &full, &size);
        snprintf(name, sizeof name, "%s, %s form, m = %d: %td points for %td", text,
                 pm_form_name((enum pm_form)f), m, reduced, full);
        ok(reduced < full, "%s", name);
        near_abs(name, a, b, within * size);
        if (within > 1e-10)
            printf("# %s: %.2e apart\n", text, fabs(a - b) / size);
    }
    pm_case_release(&c);
}

static void weigh_kept(struct pm_case *c)
{
    c->weight =
        (struct pm_weight){.kind = PM_WEIGHT_GAUSSIAN, .center = {0, 0, 1}, .size = {4, 4, 6}};
}

static void weigh_mirror(struct pm_case *c) /* kept by mirror-y alone */
{
    c->weight = (struct pm_weight){
        .kind = PM_WEIGHT_HALF_SPACE, .normal = {0.8, 0, 0.6}, .center = {1, 0, 0}, .width = 2};
}

static void by_taylor(struct pm_case *c)
{
    c->taylor = 1;
}

static void as_surface(struct pm_case *c)
{
    pm_measure_select(c, "manifold", &err);
    c->form = PM_FORM_VOLUME;
}

static void check_symmetry(void)
{
    /* rounding of sums of up to 54 terms */
    check_full("2T", actuated_two, "mirror-x mirror-y", "2T", 3, NULL, 1e-14);
    check_full("3T", actuated_three, "c3 mirror-y", "3T", 3, NULL, 1e-14);
    check_full("3R", actuated_three, "c3", "3R", 3, NULL, 1e-14);
    check_full("2R", actuated_three, "c3 mirror-y", "2R", 4, NULL, 1e-14);
    check_full("3T, gaussian", actuated_three, "c3 mirror-y", "3T", 3, weigh_kept, 1e-14);
    check_full("3T, half-space", actuated_three, "c3 mirror-y", "3T", 3, weigh_mirror, 1e-14);
    check_full("manifold", actuated_three, "c3 mirror-y", "3T", 3, as_surface, 1e-14);
    /* the Taylor field does not turn with theta: 2e-6 of the measure at 1.2 rad, of which the terms
       are a multiple */
    check_full("3R, taylor", actuated_three, "c3", "3R", 3, by_taylor, 5e-5);
}

/* 3R is odd under mirrors: the full set of a mirror-symmetric robot sums to zero, its terms are
 * not.
 */
static void check_mirror(void)
{
    static const char pair[] = ACTUATED_SPHERE(1, 15, 0, 50) ACTUATED_SPHERE(2, -7.5, 13, 50);
    struct pm_case c = {0};
    double size;
    ptrdiff_t n;

    for (int f = 0; f < 2; f++) {
        if (actuated_case(&c, pair, "mirror-y", "3R", 3, &err) != PM_OK)
            ok(0, "%s", err.text);
        c.full_set = 1;
        const double sum = sum_of(&c, (enum pm_form)f, &c.symmetry, &n, &size);
        printf("# mirror: terms of %.3g in all, sum %.3g\n", size, sum);
        ok(size > 1e-4, "3R of a mirror-symmetric robot has terms");
        near_abs("that sum to zero", sum, 0, 1e-14 * size);
        pm_case_release(&c);
    }
}

/* Both forms as points per axis grow, a table; `last` points resolve the map to `within`. */
static void check_forms(const char *measure, int last, double within)
{
    struct pm_case c = {.pmin = -0.03, .pmax = 0.12, .symmetry = {.nops = 1}};
    const double eye[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double b = 0, v = 0, size, first = 0;
    ptrdiff_t nb, nv;

    if (pm_measure_select(&c, measure, &err) != PM_OK)
        ok(0, "%s", err.text);
    c.nchambers = c.ndofs;
    memcpy(c.symmetry.Q[0], eye, sizeof eye);
    for (int r = 0; r < c.nchambers; r++)
        c.symmetry.chamber[0][r] = r;
    for (c.points = 1; c.points <= last; c.points++) {
        b = sum_of(&c, PM_FORM_BOUNDARY, &c.symmetry, &nb, &size);
        v = sum_of(&c, PM_FORM_VOLUME, &c.symmetry, &nv, &size);
        printf("# %-4s m = %2ld: boundary %16.9e (%5td points), volume %16.9e (%5td), %8.1e\n",
               measure, c.points, b, nb, v, nv, fabs(b / v - 1));
        if (c.points == 2)
            first = fabs(b / v - 1);
    }
    near_rel("boundary form = volume form", b, v, within);
    ok(first < 0.1, "%s: at m = 2 the forms differ by %.1e", measure, first);
}

/* 3R of the ball of rotations by at most a, by the flux through its sphere: exact pi (a - sin a),
 * Taylor pi (a^3/6 - a^5/120). */
static double ball(double a, int taylor)
{
    struct pm_case c = {.nchambers = 3, .taylor = taylor};
    const struct pm_load load = {.face = 0, .sign = 1};
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(24);
    double sum = 0;

    pm_measure_select(&c, "3R", &err);
    for (size_t i = 0; i < 24; i++)
        for (size_t j = 0; j < 24; j++) {
            double t, f, wt, wf, w = NAN, dU[6], dJ[18], J[18] = {0};
            gsl_integration_glfixed_point(0, acos(-1), i, &t, &wt, rule);
            gsl_integration_glfixed_point(0, 2 * acos(-1), j, &f, &wf, rule);
            const double U[6] = {0, 0, 0, a * sin(t) * cos(f), a * sin(t) * sin(f), a * cos(t)};
            J[10] = a * cos(t) * cos(f);
            J[13] = a * cos(t) * sin(f);
            J[16] = -a * sin(t);
            J[11] = -U[4];
            J[14] = U[3];
            pm_measure_point(&c, PM_FORM_BOUNDARY, &load, U, J, &w, dU, dJ, &err);
            sum += wt * wf * w;
        }
    gsl_integration_glfixed_table_free(rule);
    return sum;
}

static void check_ball(void)
{
    /* the deviation of the Taylor density at these angles, as published to its digits */
    static const struct {
        double degrees, value, off;
    } known[] = {{30, 0.0741377401, 0.0001},
                 {53.3, 0.4036470517, 0.0009},
                 {90, 1.7932095470, 0.008},
                 {180, 9.8696044011, 0.17}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const double a = known[i].degrees * acos(-1) / 180;
        const double exact = ball(a, 0), taylor = ball(a, 1);
        near_rel("3R of a ball of rotations", exact, known[i].value, 1e-9); /* its digits */
        near_rel("3R by the Taylor field", taylor, acos(-1) * (a * a * a / 6 - pow(a, 5) / 120),
                 1e-12);
        near_rel("its deviation", 1 - taylor / exact, known[i].off, 0.1);
    }
}

int main(void)
{
    check_symmetry();
    check_mirror();
    /* analytic maps: m where the error reaches rounding; 3R3T as far as its 5-dimensional faces
       allow */
    check_forms("2T", 8, 1e-12);
    check_forms("3T", 8, 1e-12);
    check_forms("1R2T", 8, 1e-12);
    check_forms("3R", 10, 1e-11);
    check_forms("3R3T", 4, 1e-4);
    check_ball();
    return tap_done();
}
