/* Gradients of the curvature, wall and end penalties against differences, and what they measure. */
#include "tools/trstep/penalty.h"

#include <stdio.h>

#include "common/geometry/distance.h"
#include "tests/robot.h"
#include "tests/tap.h"

static struct pm_err err;

static const char text[] =
    "[case]\nname = penalty\n[material]\nmu = 0.5\n[body]\nheight = 60\nshape = cylinder\n"
    "radius = 14\n"
    "[constraints]\nwall_min = %g\ncurvature_max = %g\ncap_min = %g\n";

/* A body of radius 14 and height 60 with one wavy chamber of radius 10 and half length 26. */
static int make(struct pm_surfaces *s, double wall, double curvature, double cap)
{
    const struct robot_chamber chamber = {
        .center = {0.5, 0.2, 30}, .axes = {10, 10, 26}, .wave = 0.15};
    char buffer[512];

    snprintf(buffer, sizeof buffer, text, wall, curvature, cap);
    *s = (struct pm_surfaces){0};
    if (pm_case_parse(buffer, "test", &s->pcase, &err) != PM_OK ||
        robot_init(s, 14, 60, 1, &chamber, &err) != PM_OK)
        return 0;
    memset(s->s[0].free, 1, (size_t)(3 * s->s[0].n));
    return PM_NEW(s->perm, s->offset[s->ns], &err) == PM_OK;
}

static double at(struct penalty *p, const struct penalty_watch *w, const double *phi,
                 const double *d, double h, const double rho[2], ptrdiff_t n)
{
    struct penalty_value v;
    double *q = NULL;
    if (PM_NEW(q, n, &err) != PM_OK)
        return NAN;
    for (ptrdiff_t i = 0; i < n; i++)
        q[i] = phi[i] + h * d[i];
    penalty_at(p, w, q, rho, NULL, &v);
    pm_free(q);
    return rho[0] * v.curvature + rho[1] * v.wall;
}

static void check_gradient(const char *name, double wall, double curvature, double cap,
                           const double rho[2])
{
    struct pm_surfaces s;
    struct penalty p = {0};
    struct penalty_watch w = {0};
    struct penalty_value v;
    double *phi = NULL, *g = NULL, *d = NULL, slope = 0;

    if (!make(&s, wall, curvature, cap) || penalty_new(&s, &p, &err) != PM_OK) {
        ok(0, "%s: %s", name, err.text);
        return;
    }
    const ptrdiff_t n = 3 * s.offset[s.ns];
    if (PM_NEW(phi, n, &err) != PM_OK || PM_NEW(g, n, &err) != PM_OK || PM_NEW(d, n, &err) != PM_OK)
        return;
    pm_surfaces_gather(&s, phi);
    for (ptrdiff_t i = 0; i < n; i++)
        d[i] = sin(1 + 0.37 * (double)i * (double)(i % 7));
    ok(penalty_collect(&p, &w, phi, 0.5, 0.5, &err) == PM_OK, "%s: watch", name);
    penalty_at(&p, &w, phi, rho, g, &v);
    for (ptrdiff_t i = 0; i < n; i++)
        slope += g[i] * d[i];
    const double h = 1e-4;
    const double want = (at(&p, &w, phi, d, -2 * h, rho, n) - 8 * at(&p, &w, phi, d, -h, rho, n) +
                         8 * at(&p, &w, phi, d, h, rho, n) - at(&p, &w, phi, d, 2 * h, rho, n)) /
                        (12 * h);
    /* The penalties are once differentiable: terms that switch on within h leave h relative to the
     * rest. */
    ok(v.curvature + v.wall > 0, "%s: something is violated, %g %g", name, v.curvature, v.wall);
    near_rel(name, slope, want, 1e-5);
    pm_free(phi);
    pm_free(g);
    pm_free(d);
    penalty_watch_release(&w);
    penalty_release(&p);
    pm_surfaces_release(&s);
}

static void check_measured(void)
{
    struct pm_surfaces s;
    struct penalty p = {0};
    struct penalty_watch w = {0};
    struct penalty_value v;
    const double none[2] = {0, 0};
    double *phi = NULL, *step = NULL;

    if (!make(&s, 3, 1, 2) || penalty_new(&s, &p, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[2], &err) != PM_OK ||
        PM_NEW(step, 3 * s.offset[2], &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    pm_surfaces_gather(&s, phi);
    ok(penalty_collect(&p, &w, phi, 0, 1, &err) == PM_OK, "watch");
    penalty_at(&p, &w, phi, none, NULL, &v);
    struct pm_approach near[4];
    ok(pm_distance_nearest(&s, &p.samples, 4, INFINITY, near, &err) == PM_OK, "nearest");
    /* the margin covers the spacing of the samples */
    near_abs("worst wall", v.worst_wall, 1 - near[1].distance / 3, 2 * p.margin / 3);
    ok(v.worst_curvature == 0, "no curvature above 1 /mm");
    /* the chamber moves 10 mm to the side, through the exterior */
    for (ptrdiff_t m = s.offset[1]; m < s.offset[2]; m++)
        step[3 * m] = 10;
    ok(penalty_collect(&p, &w, phi, 3, 1, &err) == PM_OK, "watch");
    const double part = penalty_safe_part(&p, &w, phi, step);
    ok(part > 0.05 && part < 0.15, "a wall of 2 mm lets 1 mm of a step of 10 mm through: part %.3g",
       part);
    pm_free(phi);
    pm_free(step);
    penalty_watch_release(&w);
    penalty_release(&p);
    pm_surfaces_release(&s);
}

int main(void)
{
    check_gradient("curvature", 1.9, 0.3, 0.1, (const double[]){2, 0});
    check_gradient("wall and void", 4, 1, 0.1, (const double[]){0, 3});
    check_gradient("ends", 1.9, 10, 8, (const double[]){0, 3});
    check_gradient("all", 4, 0.3, 8, (const double[]){2, 3});
    check_measured();
    return tap_done();
}
