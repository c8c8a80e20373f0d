/* Initial surfaces: exact orbits, projections, walls as the case asks. */
#include "tools/surfgen/surfgen.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/check.h"
#include "common/geometry/symmetry.h"
#include "tests/tap.h"
#include "tools/surfgen/pneunet.h"

static const char *const MIRRORS =
    "[case]\nname = two\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = envelope\nheight = 60\nwall = 3\nweb = 6\naround = 36\nrows = 20\n"
    "[chamber1]\nshape = bellows\ncenter = 12, 0, 30\nradius = 8\nlength = 50\namplitude = 1.5\n"
    "pitch = 15\nspacing = 3.5\n"
    "[symmetry]\ngroup = mirror-x mirror-y\n[actuation]\npmax = 0.1\n[workspace]\nmeasure = 2T\n"
    "[mesh]\nsize = 3\n[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

static const char *const TURNS =
    "[case]\nname = three\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = envelope\nheight = 60\nwall = 3\nweb = 6\naround = 36\nrows = 20\n"
    "[chamber1]\nshape = capsule\ncenter = 11, 0, 30\nradius = 7\nlength = 50\nspacing = 3.5\n"
    "[symmetry]\ngroup = c3 mirror-y\n[actuation]\npmax = 0.1\n[workspace]\nmeasure = 3T\n"
    "[mesh]\nsize = 3\n[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

static double inner(const double *a, const double *b, ptrdiff_t n)
{
    double sum = 0;

    for (ptrdiff_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static int is_permutation(const int32_t *perm, ptrdiff_t n, ptrdiff_t twice)
{
    for (ptrdiff_t i = 0; i < n; i++)
        if (perm[i] < 0 || perm[i] >= n || (twice && perm[perm[i]] != i))
            return 0;
    return 1;
}

static int on_mirror_plane_moves(const struct pm_surfaces *s, const double *phi, const double *v)
{
    int moves = 0;

    for (ptrdiff_t i = 0; i < s->offset[s->ns]; i++)
        moves |= phi[3 * i + 1] == 0 && v[3 * i + 1] != 0;
    return moves;
}

/* defect: 0 for mirrors (sign flips are exact), rounding of coordinates below 60 mm for turns. */
static void compare(const char *text, const char *name, ptrdiff_t nops, double defect)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;
    double *phi = NULL, *v = NULL, *w = NULL;
    ptrdiff_t n;

    if (pm_case_parse(text, name, &c, &err) != PM_OK || pm_surfgen(&c, &s, &fit, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[s.ns], &err) != PM_OK ||
        PM_NEW(v, 3 * s.offset[s.ns], &err) != PM_OK ||
        PM_NEW(w, 3 * s.offset[s.ns], &err) != PM_OK) {
        ok(0, "%s: %s", name, err.text);
        return;
    }
    n = 3 * s.offset[s.ns];
    ok(c.symmetry.nops == nops, "%s: group of %td operations", name, nops);
    for (ptrdiff_t g = 0; g < nops; g++)
        ok(is_permutation(&s.perm[g * n / 3], n / 3, c.symmetry.Q[g][1] == 0),
           "%s: operation %td permutes the control points", name, g);
    pm_surfaces_gather(&s, phi);
    near_abs("symmetry defect [mm]", pm_symmetry_defect(&s, phi), 0, defect);
    memcpy(v, phi, (size_t)n * sizeof *v);
    pm_symmetrise_points(&s, v);
    if (defect == 0)
        ok(memcmp(v, phi, (size_t)n * sizeof *v) == 0, "%s: exact orbits stay bit for bit", name);
    for (ptrdiff_t i = 0; i < n; i++) {
        v[i] = sin(0.7 * (double)i);
        w[i] = cos(1.1 * (double)i);
    }
    double before = inner(v, w, n), after;
    memcpy(phi, v, (size_t)n * sizeof *v);
    pm_symmetrise_vectors(&s, v); /* P v */
    after = inner(v, w, n);
    pm_symmetrise_vectors(&s, w); /* P w: (P v).w = v.(P w) */
    near_abs("projection of vectors is symmetric", inner(phi, w, n), after, 1e-11 * (double)n);
    ok(fabs(before - after) > 1e-3, "%s: projection changes a general vector", name);
    memcpy(w, v, (size_t)n * sizeof *v);
    pm_symmetrise_vectors(&s, w);
    near_array("projection of vectors is idempotent", w, v, n, defect == 0 ? 0 : 1e-15);
    pm_surfaces_gather(&s, phi);
    ok(!on_mirror_plane_moves(&s, phi, v), "%s: points on the plane y = 0 stay on it", name);
    ok(fit.check.wall.distance < 3.2 && fit.check.coverage > 2,
       "%s: wall %.3f mm for 3 wanted, cover %.2f", name, fit.check.wall.distance,
       fit.check.coverage);
    pm_surfaces_release(&s);
    pm_case_release(&c);
    pm_free(phi);
    pm_free(v);
    pm_free(w);
}

/* Replaces one line of MIRRORS; the refusal must say `why`. */
static void refuse(const char *from, const char *to, const char *why)
{
    char text[2048];
    const char *at = strstr(MIRRORS, from);
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;

    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - MIRRORS), MIRRORS, to, at + strlen(from));
    ok(pm_case_parse(text, "bad", &c, &err) == PM_OK &&
           pm_surfgen(&c, &s, &fit, &err) == PM_INPUT && strstr(err.text, why) != NULL &&
           s.s == NULL,
       "'%s' is refused: %s", to, err.text);
    pm_case_release(&c);
    pm_surfaces_release(&s);
}

/* Moves chamber 1 along x. */
static void displace(double by, const char *why)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;
    struct pm_check check;

    if (pm_case_parse(MIRRORS, "moved", &c, &err) != PM_OK ||
        pm_surfgen(&c, &s, &fit, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    for (ptrdiff_t i = 0; i < s.s[1].n; i++)
        s.s[1].phi[3 * i] += by;
    ok(pm_surfaces_check(&s, &check, &err) == PM_INPUT && strstr(err.text, why) != NULL,
       "moved by %g mm: %s", by, err.text);
    pm_case_release(&c);
    pm_surfaces_release(&s);
}

/* Helices: C3 alone keeps them, and their images turn alike. */
static const char *const HELICES =
    "[case]\nname = helices\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = envelope\nheight = 60\nwall = 3\nweb = 8\naround = 36\nrows = 20\n"
    "[chamber1]\nshape = capsule\ncenter = 12, 0, 30\nradius = 6.5\nlength = 50\nspacing = 2.5\n"
    "section = 1.2, 0.8\nturn = 65\ntwist = 90\n"
    "[symmetry]\ngroup = c3\n[workspace]\nmeasure = 3R\n"
    "[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

/* Two helices under half a turn about y = 0, z = H/2: each goes to itself. */
static const char *const SELF =
    "[case]\nname = self\n[material]\nlaw = neo-hookean\nmu = 1\n"
    "[body]\nshape = envelope\nheight = 60\nwall = 3\nweb = 8\naround = 36\nrows = 20\n"
    "[chamber1]\nshape = ellipsoid\ncenter = 12, 0, 30\nradius = 6.5\nlength = 50\nspacing = 2.5\n"
    "section = 1.2, 0.8\ntwist = 60\n"
    "[chamber2]\nshape = ellipsoid\ncenter = -12, 0, 30\nradius = 6.5\nlength = 50\nspacing = 2.5\n"
    "section = 0.8, 1.2\nturn = 90\ntwist = -60\n"
    "[symmetry]\ngroup = c2-x\n[workspace]\nmeasure = 2T\n"
    "[constraints]\nwall_min = 2.4\ncurvature_max = 1\ncap_min = 3\n";

/* The ends of the long half-axis lie where turn and twist put them. */
static void helix(void)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};

    if (pm_case_parse(HELICES, "helices", &c, &err) != PM_OK ||
        pm_surfgen(&c, &s, &fit, &err) != PM_OK || pm_map_new(&s.s[2], &map, &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    for (int k = -1; k <= 1; k++) {
        /* Chamber 2: 120 degrees around, turned by 65, twisted by 90 over 50 mm. */
        const double z = 15 * k, a = (120 + 65 + 90 * z / 50) * acos(-1.0) / 180;
        const double end[3] = {-6 + 7.8 * cos(a), 6 * sqrt(3) + 7.8 * sin(a), 30 + z};
        double S[3] = {cos(a), sin(a), 0.1 * k}, r[3], distance;
        ok(pm_distance_project(map, PM_SURFACE_SPHERE, s.s[2].phi, end, &work, S, r, &distance,
                               &err) == PM_OK,
           "%s", err.text);
        near_abs("end of the half-axis off the surface [mm]", distance, 0, fit.max[2] + 1e-9);
    }
    pm_basis_release(&work);
    pm_map_free(map);
    pm_surfaces_release(&s);
    pm_case_release(&c);
}

/* Walls of a box with two elliptic chambers: 20 - (10 + 1.1 6) outside, 12 - 0.9 6 = 6.6 aside. */
static void box(void)
{
    static const char text[] =
        "[case]\nname = box\n[material]\nmu = 1\n[body]\nshape = rounded-box\nheight = 60\n"
        "width = 40\ndepth = 24\nrounding = 4\nrows = 12\n[chamber1]\nshape = capsule\n"
        "center = 10, 0, 30\nradius = 6\nlength = 50\nsection = 1.1, 0.9\n"
        "[symmetry]\ngroup = mirror-x mirror-y\n";
    struct pm_surfgen_report fit;
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};

    ok(pm_case_parse(text, "box", &c, &err) == PM_OK && pm_surfgen(&c, &s, &fit, &err) == PM_OK,
       "rounded box %s", err.text);
    near_abs("wall of the box [mm]", fit.check.wall.distance, 3.4, fit.max[0] + fit.max[1]);
    pm_surfaces_release(&s);
    pm_case_release(&c);
}

/* The limb of cells: places on its parts, the symmetry of halves, tables. */
static void cells(void)
{
    const struct pm_chamber c = {.shape = PM_SHAPE_PNEUNET,
                                 .length = 32.7,
                                 .pitch = 13.6,
                                 .cells = 3,
                                 .thickness = 5.5,
                                 .width = 13,
                                 .depth = 13,
                                 .channel = 4};
    struct pm_pneunet *net = NULL;
    struct pm_err err = {0};
    double x[3], y[3], s[1001], r[1001];

    if (!ok(pm_pneunet_cavity(&c, &net, &err) == PM_OK, "limb %s", err.text))
        return;
    ok(pm_pneunet_parts(net) == 10, "3 parts at each end, 2 for each gap");
    pm_pneunet_point(net, 0, 0.3, x);
    near_abs("the pole is one point [mm]", x[2], -16.35, 1e-12);
    pm_pneunet_point(net, 5, 0, x); /* middle cell, outer side: -2 - 1.6 + 13 */
    near_abs("outer side of a cell [mm]", x[0], 9.4, 1e-12);
    near_abs("middle of the middle cell [mm]", x[2], 0, 1e-12);
    pm_pneunet_point(net, 4, 0, x);
    near_abs("outer side of the channel [mm]", x[0], 2, 1e-12);
    near_abs("middle of the gap [mm]", x[2], -6.8, 1e-12);
    pm_pneunet_point(net, 4.5, 0.1, x);
    pm_pneunet_point(net, 5.5, 0.9, y);
    near_abs("halves are mirror images: x [mm]", y[0], x[0], 1e-12);
    near_abs("halves are mirror images: y [mm]", y[1], -x[1], 1e-12);
    near_abs("halves are mirror images: z [mm]", y[2], -x[2], 1e-12);
    pm_pneunet_table(net, 100, s, r);
    /* Perimeter of 4 by 4 with corners of 1.8, by 96 chords. */
    near_abs("circumference of the channel [mm]", 2 * acos(-1.0) * r[400],
             16 - (8 - 2 * acos(-1.0)) * 1.8, 0.05);
    pm_pneunet_free(net);
}

/* A mirror reverses a twist and turns an ellipse: what it lists twice must agree. */
static void refuse_image(const char *change, const char *why)
{
    char text[2048];
    struct pm_err err = {0};
    struct pm_case c = {0};

    snprintf(text, sizeof text, "%s[chamber1]\n%s", MIRRORS, change);
    ok(pm_case_parse(text, "bad", &c, &err) == PM_INPUT && strstr(err.text, why) != NULL,
       "'%s' is refused: %s", change, err.text);
    pm_case_release(&c);
}

/* Tips of slender ellipsoids: their radius of curvature is far below the spacing. */
static enum pm_status slender(double radius, struct pm_surfgen_report *fit, struct pm_err *err)
{
    char text[512];
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    enum pm_status status;

    snprintf(text, sizeof text,
             "[case]\nname = thin\n[material]\nmu = 1\n[body]\nshape = cylinder\nheight = 100\n"
             "radius = 12\n[chamber1]\nshape = ellipsoid\ncenter = 0, 0, 50\nradius = %g\n"
             "length = 80\nspacing = 2.5\n[constraints]\ncurvature_max = 4\n",
             radius);
    status = pm_case_parse(text, "thin", &c, err);
    status = status == PM_OK ? pm_surfgen(&c, &s, fit, err) : status;
    pm_surfaces_release(&s);
    pm_case_release(&c);
    return status;
}

static void tips(void)
{
    struct pm_surfgen_report fit;
    struct pm_err err = {0};

    ok(slender(4, &fit, &err) == PM_OK, "slender ellipsoid %s", err.text);
    /* A tenth of the radius of curvature of the tip, 4^2 / 40. */
    ok(fit.max[1] > 0 && fit.max[1] < 0.04, "largest error %.4f mm, mean %.4f mm", fit.max[1],
       fit.mean[1]);
    ok(slender(1.2, &fit, &err) == PM_INPUT && strstr(err.text, "misses its shape") != NULL,
       "a needle is refused: %s", err.text);
}

int main(void)
{
    compare(MIRRORS, "mirrors", 4, 0);
    compare(TURNS, "turns", 6, 1e-13);
    compare(HELICES, "helices", 3, 1e-13);
    compare(SELF, "chambers that are their own images", 2, 1e-13);
    helix();
    tips();
    box();
    cells();
    refuse("wall = 3", "wall = 2.5", "wall between");
    refuse_image("section = 1.2, 0.8\ntwist = 30\n", "same shape, turn and twist");
    refuse_image("section = 1.2, 0.8\nturn = 30\n", "same shape, turn and twist");
    refuse_image("twist = 30\n", "'twist' without 'section'");
    refuse_image("section = 1.2\n", "expected two numbers");
    refuse("cap_min = 3", "cap_min = 3\ndomain = cylinder\ndomain_radius = 20",
           "leaves the design domain");
    displace(-6, "chambers 1 and 2 meet");
    displace(8, "leaves the body");
    displace(60, "leaves the body");
    return tap_done();
}
