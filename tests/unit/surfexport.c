/* surfexport: polygons with holes, sections of solids, moulds whose parts fill their block, what is
 * refused. */
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"
#include "tests/robot.h"
#include "tests/tap.h"
#include "tools/surfexport/build.h"
#include "tools/surfexport/close.h"
#include "tools/surfexport/cut.h"
#include "tools/surfexport/ears.h"
#include "tools/surfexport/mould.h"

static const double pi = 3.14159265358979323846;

static double volume(const struct skin *s)
{
    return pm_collide_volume(s->x, s->nt, s->tri);
}

static double triangle_area(const double *a, const double *b, const double *c)
{
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

/* A star of n points around c, radius 1 and r by turns; sense -1: clockwise. */
static ptrdiff_t star(double *uv, ptrdiff_t first, ptrdiff_t n, double x, double y, double scale,
                      double r, int sense)
{
    for (ptrdiff_t k = 0; k < n; k++) {
        const double angle = sense * 2 * pi * (double)k / (double)n, l = k % 2 ? r * scale : scale;
        uv[2 * (first + k)] = x + l * cos(angle);
        uv[2 * (first + k) + 1] = y + l * sin(angle);
    }
    return first + n;
}

/* A star with three holes, two of them side by side at one height. */
static void test_ears(void)
{
    enum { OUTER = 60, HOLE = 14, N = OUTER + 3 * HOLE };
    double uv[2 * N], area = 0, want, smallest = 1;
    int32_t id[N], tri[3 * (N + 8)];
    ptrdiff_t n = 0, nt = 0;
    struct pm_err err = {.status = PM_OK};
    n = star(uv, n, OUTER, 0, 0, 10, 0.8, 1);
    n = star(uv, n, HOLE, -3, 1, 2, 0.5, -1);
    n = star(uv, n, HOLE, 3, 1, 2, 0.5, -1);
    star(uv, n, HOLE, 0, -4, 2, 0.5, -1);
    for (int32_t i = 0; i < N; i++)
        id[i] = i;
    const struct ears_loop loop[] = {
        {OUTER, id}, {HOLE, id + OUTER}, {HOLE, id + OUTER + HOLE}, {HOLE, id + OUTER + 2 * HOLE}};
    want = OUTER / 2.0 * 0.8 * 100 * sin(2 * pi / OUTER) -
           3 * (HOLE / 2.0 * 0.5 * 4 * sin(2 * pi / HOLE));
    ok(ears_clip(loop, 4, uv, tri, &nt, &err) == PM_OK, "a star with three holes");
    for (ptrdiff_t t = 0; t < nt; t++) {
        const double a =
            triangle_area(uv + 2 * tri[3 * t], uv + 2 * tri[3 * t + 1], uv + 2 * tri[3 * t + 2]);
        area += a;
        smallest = fmin(smallest, a);
    }
    ok(nt == N + 2 * 3 - 2, "%td triangles", nt);
    ok(fabs(area - want) < 1e-12 * want, "area %.15g, want %.15g", area, want); /* rounding */
    ok(smallest > 0, "all of them turn the same way: %g", smallest);
    const double bow[] = {0, 0, 1, 1, 1, 0, 0, 1};
    const struct ears_loop crossed = {4, id};
    nt = 0;
    ok(ears_clip(&crossed, 1, bow, tri, &nt, &err) == PM_NUMERIC, "a crossed outline: %s",
       err.text);
}

/* A box with a box as void. */
static enum pm_status add_box(struct skin *s, double half, int inside, struct pm_err *err)
{
    static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    enum pm_status status = PM_OK;
    const ptrdiff_t first = s->nn;
    for (int k = 0; k < 8; k++) {
        const double x[3] = {k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half};
        PM_TRY(skin_add_node(s, x, 0, err));
    }
    for (int f = 0; f < 6; f++)
        for (int k = 1; k < 3; k++)
            PM_TRY(skin_add_triangle(s, first + face[f][0], first + face[f][inside ? k + 1 : k],
                                     first + face[f][inside ? k : k + 1], inside, err));
done:
    return status;
}

static void test_sections(void)
{
    struct pm_err err = {.status = PM_OK};
    struct skin box = {0}, part = {0}, open = {0};
    ok(add_box(&box, 2, 0, &err) == PM_OK && add_box(&box, 1, 1, &err) == PM_OK &&
           skin_check(&box, &err) == PM_OK && fabs(volume(&box) - 56) < 1e-12,
       "a hollow box");
    for (int axis = 0; axis < 3; axis++)
        for (int sense = -1; sense < 2; sense += 2) {
            skin_release(&part);
            const enum pm_status status = skin_cut(&box, axis, 0.5, sense, 1e-6, &part, &err);
            ok(status == PM_OK && skin_check(&part, &err) == PM_NUMERIC,
               "axis %d, side %+d: open: %s", axis, sense, err.text);
            err = (struct pm_err){.status = PM_OK};
            ok(skin_close(&part, axis, 0.5, -sense, 7, &err) == PM_OK &&
                   skin_check(&part, &err) == PM_OK,
               "closed: %s", err.text);
            const double want = 16 * (2 - sense * 0.5) - 4 * (1 - sense * 0.5);
            ok(fabs(volume(&part) - want) < 1e-12 * want, "volume %.15g, want %.15g", volume(&part),
               want);
        }
    skin_release(&part);
    ok(skin_cut(&box, 2, 1 - 1e-4, 1, 1e-3, &part, &err) == PM_OK &&
           skin_close(&part, 2, 1 - 1e-4, -1, 7, &err) == PM_OK && skin_check(&part, &err) == PM_OK,
       "a plane that grazes a face: nodes move into it: %s", err.text);
    skin_flip(&box, 0, 0);
    ok(skin_check(&box, &err) == PM_NUMERIC && strstr(err.text, "encloses -72 mm3") != NULL,
       "inside out: %s", err.text);
    err = (struct pm_err){.status = PM_OK};
    skin_release(&box);
    ok(add_box(&box, 2, 0, &err) == PM_OK, "another box");
    box.tri[1] = box.tri[0];
    ok(skin_check(&box, &err) == PM_NUMERIC, "a triangle spoilt: %s", err.text);
    skin_release(&box);
    skin_release(&part);
    skin_release(&open);
}

/* Both halves and the body fill the block; the core is chamber and prism. */
static void test_mould(const struct skin *robot)
{
    struct pm_err err = {.status = PM_OK};
    struct mould_opts o = {.pull = 1, .wall = 6, .print = 4, .clearance = 0, .snap = 1e-6};
    struct skin body = {0}, half[2] = {{0}, {0}}, core = {0};
    ok(skin_extract(robot, PM_FACE_TIP, PM_FACE_EXTERIOR, &body, &err) == PM_OK, "exterior");
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9}, undercut;
    for (ptrdiff_t i = 0; i < 3 * body.nn; i++) {
        low[i % 3] = fmin(low[i % 3], body.x[i]);
        high[i % 3] = fmax(high[i % 3], body.x[i]);
    }
    const double block = (high[0] - low[0] + 12) * (high[1] - low[1] + 12) * (high[2] - low[2] + 6);
    for (o.pull = 0; o.pull < 2; o.pull++) {
        for (int k = 0; k < 2; k++) {
            skin_release(&half[k]);
            ok(mould_half(robot, &o, k == 0 ? 1 : -1, &half[k], &undercut, &err) == PM_OK &&
                   skin_check(&half[k], &err) == PM_OK,
               "half %d across %c: %s", k + 1, "xyz"[o.pull], err.text);
            ok(undercut == 0, "a round body has no undercut: %g", undercut);
        }
        /* pins and holes without a gap are alike; what nodes move into the plane */
        const double sum = volume(&half[0]) + volume(&half[1]) + volume(&body);
        ok(fabs(sum - block) < o.snap * 5e3, "halves and body: %.12g, block %.12g", sum, block);
    }
    ok(mould_core(robot, &o, 1, 2, &core, &err) == PM_OK && skin_check(&core, &err) == PM_OK,
       "core: %s", err.text);
    skin_release(&body);
    ok(skin_extract(robot, 1, 1, &body, &err) == PM_OK, "chamber");
    double bottom = 1e9;
    for (ptrdiff_t a = 0; a < body.nn; a++)
        bottom = fmin(bottom, body.x[3 * a + 2]);
    /* the prism has the area that was asked for; of what is above the lowest node only a cap of the
     * chamber's bottom is its own: half of its height or less */
    const double print = pi * 4, more = volume(&core) - volume(&body);
    ok(more > print * (bottom + 6) && more < print * (bottom + 6 + 1),
       "print adds %.3f mm3, below the chamber %.3f mm3", more, print * (bottom + 6));
    o.print = 100;
    skin_release(&core);
    ok(mould_core(robot, &o, 1, 2, &core, &err) == PM_INPUT, "print too large: %s", err.text);
    skin_release(&body);
    skin_release(&half[0]);
    skin_release(&half[1]);
    skin_release(&core);
}

/* Halves, plate and cores fit into each other: nothing pierces. Faces that would touch stand a
 * thousandth of a millimetre apart. */
static void test_kit(const struct skin *robot)
{
    struct pm_err err = {.status = PM_OK};
    const struct mould_opts o = {.pull = 1, .wall = 8, .print = 3, .clearance = 0.2, .snap = 1e-3};
    struct skin kit = {0}, part = {0};
    struct pm_contact c = {.a = 0};
    double undercut;
    for (int k = 0; k < 5; k++) {
        skin_release(&part);
        const enum pm_status status = k < 2
                                          ? mould_half(robot, &o, 1 - 2 * k, &part, &undercut, &err)
                                      : k == 2 ? mould_plate(robot, &o, 2, &part, &err)
                                               : mould_core(robot, &o, k - 2, 2, &part, &err);
        for (ptrdiff_t a = 0; a < part.nn; a++) {
            part.x[3 * a + 1] -= k == 1 ? 1e-3 : 0;
            part.x[3 * a + 2] -= k == 2 ? 1e-3 : 0;
        }
        ok(status == PM_OK && skin_check(&part, &err) == PM_OK &&
               skin_extract(&part, INT32_MIN, INT32_MAX, &kit, &err) == PM_OK,
           "part %d: %s", k, err.text);
        /* lip, floor, sockets, openings of a radius of 0.5 to 3 */
        const double block = 28 + 16 + 0.4, outer = block + 8;
        const double want = outer * outer * 12 - block * block * 4 - 2 * 8 * pi * 1.7 * 1.7;
        if (k == 2)
            ok(volume(&part) < want - 2 * 8 * 0.7 && volume(&part) > want - 2 * 8 * pi * 9.1,
               "plate %.1f mm3, without openings %.1f mm3", volume(&part), want);
    }
    ok(pm_collide_pierce(kit.x, kit.nt, kit.tri, &c, &err) == PM_OK, "all of them");
    ok(c.a < 0, "they fit: %td intersections, first at (%.3f, %.3f, %.3f)", c.pairs, c.at[0],
       c.at[1], c.at[2]);
    skin_release(&part);
    skin_release(&kit);
}

int main(void)
{
    static const struct robot_chamber chambers[] = {{{-6, 0, 16}, {4, 4, 11}, 0},
                                                    {{6, 0, 16}, {4, 4, 11}, 0}};
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces s = {.ns = 0};
    struct skin robot = {0};
    double error = 0, least = 1e9;
    test_ears();
    test_sections();
    ok(robot_init(&s, 14, 32, 2, chambers, &err) == PM_OK &&
           skin_build(&s, 4, 0.1, &robot, &error, &err) == PM_OK &&
           skin_check_nesting(&robot, 2, &err) == PM_OK,
       "a robot: %s", err.text);
    ok(error > 0.01 && error <= 0.1, "%.3f mm off, asked for 0.1", error);
    /* least distance of the axes minus both radii; chambers come out a little smaller (robot.h) */
    ok(skin_walls(&robot, 2, &err) == PM_OK, "walls");
    for (ptrdiff_t a = 0; a < robot.nn; a++)
        least = fmin(least, robot.wall[a]);
    ok(least > 3.9 && least < 4.6, "least wall %.3f, want a little more than 4", least);
    /* a cylinder: curvature 1/14 off the caps */
    double worst = 0;
    for (ptrdiff_t t = 0; t < robot.nt; t++)
        if (robot.tag[t] == PM_FACE_EXTERIOR)
            worst = fmax(worst, fabs(robot.curvature[robot.tri[3 * t]] * 14 - 1));
    ok(worst < 0.02, "curvature of the cylinder: %g off", worst); /* of the spline, robot.h */
    test_mould(&robot);
    test_kit(&robot);
    for (ptrdiff_t i = 0; i < s.s[2].n; i++)
        s.s[2].phi[3 * i] -= 9;
    skin_release(&robot);
    ok(skin_build(&s, 4, 0.1, &robot, &error, &err) == PM_OK &&
           skin_check_nesting(&robot, 2, &err) == PM_INPUT,
       "chambers that cross: %s", err.text);
    skin_release(&robot);
    pm_surfaces_release(&s);
    return tap_done();
}
