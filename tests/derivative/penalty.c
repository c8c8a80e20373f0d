/* Gradients of the constraints of trstep against differences, with feet that follow the surfaces,
 * and what the constraints measure. */
#include "common/geometry/penalty.h"

#include <stdio.h>

#include "common/geometry/distance.h"
#include "tests/robot.h"
#include "tests/tap.h"

static struct pm_err err;

static const char text[] =
    "[case]\nname = penalty\n[material]\nmu = 0.5\n[body]\nheight = 60\nshape = cylinder\n"
    "radius = 14\n"
    "[constraints]\nwall_min = %g\ncurvature_max = %g\ncap_min = %g\n%s";

struct limits {
    double wall, curvature, cap;
    const char *domain;
};

/* A body of radius 14 and height 60 with one wavy chamber of radius 10 and half length 26. */
static int make(struct pm_surfaces *s, const struct limits *l)
{
    const struct robot_chamber chamber = {
        .center = {0.5, 0.2, 30}, .axes = {10, 10, 26}, .wave = 0.15};
    char buffer[512];

    snprintf(buffer, sizeof buffer, text, l->wall, l->curvature, l->cap, l->domain);
    *s = (struct pm_surfaces){0};
    if (pm_case_parse(buffer, "test", &s->pcase, &err) != PM_OK ||
        robot_init(s, 14, 60, 1, &chamber, &err) != PM_OK)
        return 0;
    memset(s->s[0].free, 1, (size_t)(3 * s->s[0].n));
    return PM_NEW(s->perm, s->offset[s->ns], &err) == PM_OK;
}

/* L at phi + h d; the feet are found anew, the multipliers stay. */
static double at(struct pm_penalty *p, const double *phi, const double *d, double h,
                 const double rho[2], ptrdiff_t n)
{
    struct pm_penalty_value v = {.lagrangian = NAN};
    double *q = NULL;
    if (PM_NEW(q, n, &err) != PM_OK)
        return NAN;
    for (ptrdiff_t i = 0; i < n; i++)
        q[i] = phi[i] + h * d[i];
    if (pm_penalty_collect(p, q, 0.5, 0.5, &err) == PM_OK)
        pm_penalty_at(p, q, rho, NULL, &v);
    pm_free(q);
    return v.lagrangian;
}

static void check_gradient(const char *name, const struct limits *l, const double rho[2])
{
    struct pm_surfaces s;
    struct pm_penalty p = {0};
    struct pm_penalty_value v;
    double *phi = NULL, *g = NULL, *d = NULL, slope = 0;

    if (!make(&s, l) || pm_penalty_new(&s, &p, &err) != PM_OK) {
        ok(0, "%s: %s", name, err.text);
        return;
    }
    const ptrdiff_t n = 3 * s.offset[s.ns];
    if (PM_NEW(phi, n, &err) != PM_OK || PM_NEW(g, n, &err) != PM_OK || PM_NEW(d, n, &err) != PM_OK)
        return;
    pm_surfaces_gather(&s, phi);
    for (ptrdiff_t i = 0; i < n; i++)
        d[i] = sin(1 + 0.37 * (double)i * (double)(i % 7));
    ok(pm_penalty_collect(&p, phi, 0.5, 0.5, &err) == PM_OK, "%s: feet", name);
    pm_penalty_raise(&p, phi, (const double[]){0.3, 0.3});
    pm_penalty_at(&p, phi, rho, g, &v);
    for (ptrdiff_t i = 0; i < n; i++)
        slope += g[i] * d[i];
    const double h = 1e-5;
    const double want = (at(&p, phi, d, -2 * h, rho, n) - 8 * at(&p, phi, d, -h, rho, n) +
                         8 * at(&p, phi, d, h, rho, n) - at(&p, phi, d, 2 * h, rho, n)) /
                        (12 * h);
    ok(v.sum[0] + v.sum[1] > 0, "%s: something is violated, %g %g", name, v.sum[0], v.sum[1]);
    near_rel(name, slope, want, 1e-6);
    pm_free(phi);
    pm_free(g);
    pm_free(d);
    pm_penalty_release(&p);
    pm_surfaces_release(&s);
}

static void shift(const struct pm_surfaces *s, double *phi, double dx)
{
    for (ptrdiff_t m = s->offset[1]; m < s->offset[2]; m++)
        phi[3 * m] += dx;
}

/* Wall 3 mm, chamber radius near 10 in a body of 14. */
static void check_measured(void)
{
    struct pm_surfaces s;
    struct pm_penalty p = {0};
    struct pm_penalty_value v;
    const struct limits l = {3, 1, 2, ""};
    const double rho[2] = {0, 1};
    struct pm_approach near[4];
    double *phi = NULL, *g = NULL;

    if (!make(&s, &l) || pm_penalty_new(&s, &p, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[2], &err) != PM_OK || PM_NEW(g, 3 * s.offset[2], &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    pm_surfaces_gather(&s, phi);
    shift(&s, phi, 2);
    pm_surfaces_scatter(&s, phi);
    ok(pm_penalty_collect(&p, phi, 0, 1, &err) == PM_OK, "feet");
    pm_penalty_at(&p, phi, rho, NULL, &v);
    ok(pm_distance_nearest(&s, &p.samples, 4, near, &err) == PM_OK, "nearest");
    /* samples miss the thinnest place by less than cover^2/2 (1/10 - 1/14), the curvatures */
    near_abs("worst wall", v.worst[1], 1 - near[1].distance / 3, p.cover * p.cover * 0.015 / 3);
    ok(v.worst[0] == 0, "no curvature above 1 /mm");
    /* the chamber crosses the exterior by about 1 mm: it is pulled back, the exterior outwards */
    shift(&s, phi, 2.5);
    ok(pm_penalty_collect(&p, phi, 0, 1, &err) == PM_OK, "feet");
    pm_penalty_at(&p, phi, rho, g, &v);
    ok(v.worst[1] > 1 && v.worst[1] < 2, "a wall of -1 mm lacks 4 of 3 mm: %g", v.worst[1]);
    double pull[2] = {0};
    for (ptrdiff_t m = 0; m < s.offset[2]; m++)
        pull[m >= s.offset[1]] -= g[3 * m];
    ok(pull[0] > 0 && pull[1] < 0, "forces part them the right way: %g %g", pull[0], pull[1]);
    pm_free(phi);
    pm_free(g);
    pm_penalty_release(&p);
    pm_surfaces_release(&s);
}

/* The void between the faces of a lens, 2 mm wide, where 3 mm are asked for of what is no fold. */
static double lack_of_lens(double a)
{
    const struct robot_chamber chamber = {.center = {0.5, 0.2, 30}, .axes = {a, a, 1.1}};
    struct pm_surfaces s = {0};
    double curvature[2], wall[4] = {0, 0, 0, NAN};
    char buffer[512];

    snprintf(buffer, sizeof buffer, text, 3.0, 1.0, 2.0, "void_min = 3\n");
    if (pm_case_parse(buffer, "test", &s.pcase, &err) == PM_OK &&
        robot_init(&s, 14, 60, 1, &chamber, &err) == PM_OK &&
        PM_NEW(s.perm, s.offset[s.ns], &err) == PM_OK)
        pm_penalty_survey(&s, curvature, wall, &err);
    pm_surfaces_release(&s);
    return wall[3];
}

/* The limit grows with the way along the surface by 1/4 mm a mm, so 1 - 2/limit by less than
 * 0.25/mm as the lens grows by twice that way; samples that change add a little. */
static void check_continuous(void)
{
    const double step = 0.05;
    double last = lack_of_lens(1.5), most = 0;

    ok(last == 0, "a ball of 3 mm is a fold");
    for (int k = 1; k <= 36; k++) {
        const double now = lack_of_lens(1.5 + step * k);
        most = fmax(most, fabs(now - last));
        last = now;
    }
    ok(most < 2 * 0.25 * step + 0.01, "no limit comes into force at once: %.4f", most);
    ok(last > 0.25, "a lens of 6.6 mm lacks %.3f", last);
}

int main(void)
{
    const double bend[2] = {2, 0}, wall[2] = {0, 3}, both[2] = {2, 3};
    check_gradient("curvature", &(struct limits){1.9, 0.3, 0.1, ""}, bend);
    check_gradient("wall and void", &(struct limits){4, 1, 0.1, ""}, wall);
    check_gradient("ends", &(struct limits){1.9, 10, 8, ""}, wall);
    check_gradient("cylinder",
                   &(struct limits){1.9, 10, 0.1, "domain = cylinder\ndomain_radius = 13\n"}, wall);
    check_gradient("box",
                   &(struct limits){1.9, 10, 0.1, "domain = box\ndomain_x = 12\ndomain_y = 13\n"},
                   wall);
    check_gradient("all", &(struct limits){4, 0.3, 8, "domain = cylinder\ndomain_radius = 13\n"},
                   both);
    check_measured();
    check_continuous();
    return tap_done();
}
