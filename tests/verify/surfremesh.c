/* Surfaces stay where they are over repeated redistributions: drift from the first ones, symmetry,
 * spacing. */
#include "tools/surfremesh/surfremesh.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/distance.h"
#include "common/geometry/symmetry.h"
#include "tests/tap.h"
#include "tools/surfgen/surfgen.h"

static const char *const CASE =
    "[case]\nname = bellows\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = envelope\nheight = 60\nwall = 3\nweb = 6\naround = 36\nrows = 24\n"
    "[chamber1]\nshape = bellows\ncenter = 12, 0, 30\nradius = 8\nlength = 50\namplitude = 1.5\n"
    "pitch = 15\nspacing = 2.5\n"
    "[symmetry]\ngroup = mirror-x mirror-y\n[actuation]\npmax = 0.1\n[workspace]\nmeasure = 2T\n"
    "[mesh]\nsize = 3\n[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

/* Largest and mean distance of chamber 1 of `to` from that of `from`. S is carried, so it starts
 * the foot. */
static void distance(const struct pm_surfaces *from, const struct pm_surfaces *to, double out[2],
                     double *volume_ratio)
{
    struct pm_err err = {0};
    struct pm_samples m = {0}, old = {0};
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *phi = NULL, *was = NULL;

    out[0] = out[1] = HUGE_VAL;
    if (pm_samples_new(to, HUGE_VAL, 3, &m, &err) != PM_OK ||
        pm_samples_new(from, HUGE_VAL, 3, &old, &err) != PM_OK ||
        pm_map_new(&from->s[1], &map, &err) != PM_OK ||
        PM_NEW(phi, 3 * to->offset[to->ns], &err) != PM_OK ||
        PM_NEW(was, 3 * from->offset[from->ns], &err) != PM_OK)
        return;
    pm_surfaces_gather(to, phi);
    pm_surfaces_gather(from, was);
    out[0] = out[1] = 0;
    for (ptrdiff_t i = m.first[1]; i < m.first[2]; i++) {
        double x[3], S[3], foot[3], d = 0;
        memcpy(S, &m.S[3 * i], sizeof S);
        pm_samples_at(&m, i, phi, x, NULL, NULL);
        pm_distance_project(map, PM_SURFACE_SPHERE, from->s[1].phi, x, &work, S, foot, &d, &err);
        out[0] = fmax(out[0], d);
        out[1] += d / (double)(m.first[2] - m.first[1]);
    }
    *volume_ratio = pm_samples_volume(&m, phi, 1) / pm_samples_volume(&old, was, 1);
    pm_samples_release(&m);
    pm_samples_release(&old);
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(phi);
    pm_free(was);
}

static void drift(const struct pm_surfaces *first)
{
    enum { CALLS = 5 };
    struct pm_err err = {0};
    struct pm_surfaces now = {0}, next = {0};
    const struct surfremesh_opts o = {.spacing = 2.5, .alpha = 0.1, .iterations = 20};
    double d[2], ratio = 0, *phi = NULL;
    int refused = 0;

    pm_surfaces_copy(first, &now, &err);
    for (int call = 0; call < CALLS && !refused; call++) {
        struct surfremesh_report report = {0};
        refused = surfremesh_report_init(&report, first->ns, &err) != PM_OK ||
                  pm_surfremesh(&now, &o, &next, &report, &err) != PM_OK || report.kept;
        if (refused) {
            printf("# %s%s\n", err.text, report.reason);
        } else {
            pm_surfaces_release(&now);
            now = next;
            memset(&next, 0, sizeof next);
        }
        surfremesh_report_release(&report);
    }
    ok(!refused, "%d redistributions", (int)CALLS);
    distance(first, &now, d, &ratio);
    ok(d[0] < 0.3, "largest distance from the first surface %.3f mm, mean %.4f", d[0], d[1]);
    ok(d[1] < 0.05, "mean distance %.4f mm", d[1]);
    near_abs("volume over the first one", ratio, 1, 0.005);
    if (PM_NEW(phi, 3 * now.offset[now.ns], &err) == PM_OK) {
        pm_surfaces_gather(&now, phi);
        near_abs("symmetry defect [mm]", pm_symmetry_defect(&now, phi), 0, 0);
    }
    ok(now.s[1].n == now.s[2].n && now.s[1].n > 0.95 * (double)first->s[1].n &&
           now.s[1].n < 1.05 * (double)first->s[1].n,
       "%td control points for %td", now.s[1].n, first->s[1].n);
    pm_surfaces_release(&now);
    pm_free(phi);
}

/* Algorithm 1 of the paper smooths: each call takes volume. The figures are what it does, not what
 * it should: theory says 1 to 2 % a call on bellows. New parameters keep the surface: they are held
 * to the bounds of the default. */
static void others(const struct pm_surfaces *first)
{
    static const enum surfremesh_method method[] = {SURFREMESH_PAPER, SURFREMESH_CONFORMAL};
    struct pm_err err = {0};
    double d[2][2], ratio[2] = {0};

    for (int m = 0; m < 2; m++) {
        const struct surfremesh_opts o = {.spacing = 2.5, .alpha = 0.1, .method = method[m]};
        struct surfremesh_report report = {0};
        struct pm_surfaces to = {0};
        d[m][0] = d[m][1] = HUGE_VAL;
        ok(surfremesh_report_init(&report, first->ns, &err) == PM_OK &&
               pm_surfremesh(first, &o, &to, &report, &err) == PM_OK && !report.kept,
           "method %d %s%s", (int)method[m], err.text, report.reason);
        d[m][0] = report.max[1];
        d[m][1] = report.mean[1];
        ratio[m] = report.volume_ratio[1];
        surfremesh_report_release(&report);
        pm_surfaces_release(&to);
    }
    ok(ratio[0] > 0.96 && ratio[0] < 0.995, "paper: volume times %.4f", ratio[0]);
    ok(d[0][1] > 3 * d[1][1], "paper: mean distance %.4f mm, conformal %.4f mm", d[0][1], d[1][1]);
    ok(d[1][0] < 0.3 && fabs(ratio[1] - 1) < 0.005, "conformal: max %.3f mm, volume times %.5f",
       d[1][0], ratio[1]);
}

/* One half of chamber 1 is drawn out by 40 % along x: its control points are uneven, and the tool
 * acts unasked. */
static void stretched(const struct pm_surfaces *first)
{
    struct pm_err err = {0};
    struct pm_surfaces s = {0}, to = {0};
    const struct surfremesh_opts o = {.alpha = 0.1, .iterations = 20};
    struct surfremesh_report report = {0};
    double *phi = NULL;

    pm_surfaces_copy(first, &s, &err);
    for (ptrdiff_t k = 0; k < s.ns; k++)
        for (ptrdiff_t i = 0; i < s.s[k].n; i++)
            if (fabs(s.s[k].phi[3 * i]) > 12)
                s.s[k].phi[3 * i] +=
                    copysign(0.1 * pow(fabs(s.s[k].phi[3 * i]) - 12, 2), s.s[k].phi[3 * i]);
    ok(surfremesh_report_init(&report, s.ns, &err) == PM_OK &&
           pm_surfremesh(&s, &o, &to, &report, &err) == PM_OK,
       "a stretched chamber: %s", err.text);
    ok(!report.kept, "is redistributed unasked %s", report.reason);
    ok(report.spacing_after[1] < 0.7 * report.spacing_before[1], "spacing variation %.3f -> %.3f",
       report.spacing_before[1], report.spacing_after[1]);
    ok(report.max[1] > 0 && report.max[1] < 0.3, "within %.3f mm", report.max[1]);
    if (to.ns > 0 && PM_NEW(phi, 3 * to.offset[to.ns], &err) == PM_OK) {
        pm_surfaces_gather(&to, phi);
        near_abs("symmetry defect [mm]", pm_symmetry_defect(&to, phi), 0, 0);
    }
    pm_free(phi);
    surfremesh_report_release(&report);
    pm_surfaces_release(&s);
    pm_surfaces_release(&to);
}

static const char *const ROUND =
    "[case]\nname = round\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = cylinder\nheight = 60\nradius = 22\naround = 24\nrows = 30\n"
    "[chamber1]\nshape = capsule\ncenter = 10, 0, 30\nradius = 7\nlength = 50\nspacing = 4\n"
    "[symmetry]\ngroup = mirror-x mirror-y\n[actuation]\npmax = 0.1\n[workspace]\nmeasure = 2T\n"
    "[mesh]\nsize = 3\n[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

/* A chamber kept by a mirror plane at 120 degrees, in a group of three planes. */
static const char *const RADIAL =
    "[case]\nname = radial\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = cylinder\nheight = 50\nradius = 22\naround = 24\nrows = 16\n"
    "[chamber1]\nshape = capsule\ncenter = -5.5, 9.526279441628825, 25\nradius = 5\nlength = 40\n"
    "spacing = 2.5\n[symmetry]\ngroup = c3 mirror-y\n[actuation]\npmax = 0.1\n"
    "[workspace]\nmeasure = 3T\n[mesh]\nsize = 3\n"
    "[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

static void radial(void)
{
    enum { CALLS = 4 };
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces now = {0}, to = {0};
    struct pm_surfgen_report fit;
    double *phi = NULL;
    int kept = 0;

    if (pm_case_parse(RADIAL, "radial", &c, &err) != PM_OK ||
        pm_surfgen(&c, &now, &fit, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    for (int call = 0; call < CALLS && !kept; call++) {
        const struct surfremesh_opts o = {
            .alpha = 0.1, .spacing = 2.5, .method = call % 2 ? SURFREMESH_CONFORMAL : 0};
        struct surfremesh_report report = {0};
        kept = surfremesh_report_init(&report, now.ns, &err) != PM_OK ||
               pm_surfremesh(&now, &o, &to, &report, &err) != PM_OK || report.kept;
        ok(!kept, "radial mirror plane, call %d %s%s", call + 1, err.text, report.reason);
        surfremesh_report_release(&report);
        if (kept)
            break;
        pm_surfaces_release(&now);
        now = to;
        memset(&to, 0, sizeof to);
    }
    if (PM_NEW(phi, 3 * now.offset[now.ns], &err) == PM_OK) {
        pm_surfaces_gather(&now, phi);
        near_abs("its symmetry defect [mm]", pm_symmetry_defect(&now, phi), 0, 1e-12);
    }
    pm_free(phi);
    pm_surfaces_release(&now);
    pm_case_release(&c);
}

static int round_robot(struct pm_case *c, struct pm_surfaces *s, struct surfremesh_report *report,
                       struct pm_err *err)
{
    struct pm_surfgen_report fit;

    if (pm_case_parse(ROUND, "round", c, err) == PM_OK && pm_surfgen(c, s, &fit, err) == PM_OK &&
        surfremesh_report_init(report, s->ns, err) == PM_OK)
        return 1;
    ok(0, "%s", err->text);
    return 0;
}

/* The rows of a wavy exterior are pushed towards the base: a new parametrisation spreads them
 * again. */
static void exterior(void)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0}, to = {0};
    const struct surfremesh_opts o = {.alpha = 0.1, .iterations = 20};
    struct surfremesh_report report = {0};
    double *phi = NULL;

    if (!round_robot(&c, &s, &report, &err))
        return;
    struct pm_surface *f = &s.s[0];
    for (ptrdiff_t i = 2 * f->nu; i < f->n - 2 * f->nu; i++) {
        double v = f->Phi[3 * i + 2], wave = 1 + 0.03 * sin(25 * v * v);
        f->phi[3 * i] *= wave;
        f->phi[3 * i + 1] *= wave;
        f->phi[3 * i + 2] = 60 * (v - 1.9 * v * (1 - v) * v);
    }
    ok(pm_surfremesh(&s, &o, &to, &report, &err) == PM_OK && !report.kept, "uneven exterior: %s%s",
       err.text, report.reason);
    ok(report.spacing_before[0] > 2 && report.spacing_after[0] < 0.75 * report.spacing_before[0],
       "longest edge over mean %.2f -> %.2f", report.spacing_before[0], report.spacing_after[0]);
    ok(report.max[0] < 0.3 && report.mean[0] < 0.05, "distance mean %.4f, max %.4f mm",
       report.mean[0], report.max[0]);
    if (!report.kept && PM_NEW(phi, 3 * to.offset[to.ns], &err) == PM_OK) {
        const ptrdiff_t n = to.s[0].n, nu = to.s[0].nu;
        int flat = nu >= f->nu;
        pm_surfaces_gather(&to, phi);
        near_abs("symmetry defect [mm]", pm_symmetry_defect(&to, phi), 0, 0);
        for (ptrdiff_t i = 0; i < nu; i++)
            flat &= to.s[0].phi[3 * i + 2] == 0 && to.s[0].phi[3 * (n - 1 - i) + 2] == 60;
        ok(flat, "the rims stay in their planes");
    }
    pm_free(phi);
    surfremesh_report_release(&report);
    pm_surfaces_release(&s);
    pm_surfaces_release(&to);
    pm_case_release(&c);
}

/* An exterior too rough for its fixed number of control points keeps them; the chambers get theirs.
 */
static void partly(void)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0}, to = {0};
    const struct surfremesh_opts o = {.alpha = 0.1};
    struct surfremesh_report report = {0};

    if (!round_robot(&c, &s, &report, &err))
        return;
    struct pm_surface *f = &s.s[0];
    for (ptrdiff_t i = 2 * f->nu; i < f->n - 2 * f->nu; i++) {
        const double v = f->Phi[3 * i + 2], wave = 1 + (i / f->nu % 2 ? 0.05 : -0.05);
        f->phi[3 * i] *= wave;
        f->phi[3 * i + 1] *= wave;
        f->phi[3 * i + 2] = 60 * (v - 1.9 * v * (1 - v) * v);
    }
    f->spacing[0] = f->spacing[1] = 0;
    s.pcase.chamber[0].spacing = s.pcase.chamber[1].spacing = 2.5;
    ok(pm_surfremesh(&s, &o, &to, &report, &err) == PM_OK && !report.kept, "a rough exterior: %s%s",
       err.text, report.reason);
    ok(strncmp(report.reason, "surface 0: ", 11) == 0 && report.spacing_before[0] > 2,
       "it is kept: %s", report.reason);
    ok(!report.kept && to.s[0].n == f->n &&
           memcmp(to.s[0].phi, f->phi, 3 * (size_t)f->n * sizeof(double)) == 0,
       "bit for bit");
    ok(!report.kept && to.s[1].n > 1.4 * (double)s.s[1].n && to.s[1].n == to.s[2].n,
       "chambers have %td control points for %td", report.kept ? 0 : to.s[1].n, s.s[1].n);
    surfremesh_report_release(&report);
    pm_surfaces_release(&s);
    pm_surfaces_release(&to);
    pm_case_release(&c);
}

int main(void)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces first = {0};
    struct pm_surfgen_report fit;

    if (pm_case_parse(CASE, "bellows", &c, &err) != PM_OK ||
        pm_surfgen(&c, &first, &fit, &err) != PM_OK)
        return tap_bail("%s", err.text);
    drift(&first);
    others(&first);
    stretched(&first);
    exterior();
    partly();
    radial();
    pm_surfaces_release(&first);
    pm_case_release(&c);
    return tap_done();
}
