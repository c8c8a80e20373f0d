/* Cores of chambers with their prints. */
#include <math.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"
#include "tools/surfexport/close.h"
#include "tools/surfexport/cut.h"
#include "tools/surfexport/mould.h"

/* Area of the section at z [mm2]. */
static double section_area(const struct skin *s, double z)
{
    double sum = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double p[2][2]; /* where the boundary goes down, up */
        int n = 0;
        for (int k = 0; k < 3; k++) {
            const double *a = s->x + 3 * (ptrdiff_t)s->tri[3 * t + k];
            const double *b = s->x + 3 * (ptrdiff_t)s->tri[3 * t + (k + 1) % 3];
            if ((a[2] > z) == (b[2] > z))
                continue;
            const double f = (z - a[2]) / (b[2] - a[2]);
            for (int i = 0; i < 2; i++)
                p[b[2] > z][i] = a[i] + f * (b[i] - a[i]);
            n++;
        }
        if (n == 2)
            sum += p[0][0] * p[1][1] - p[0][1] * p[1][0];
    }
    return fabs(sum) / 2;
}

/* The lowest z with a section of that area. */
static enum pm_status find_section(const struct skin *s, double area, double *z, struct pm_err *err)
{
    enum { STEPS = 400, HALVINGS = 40 };
    double low = INFINITY, high = -INFINITY, below, above;
    for (ptrdiff_t a = 0; a < s->nn; a++) {
        low = fmin(low, s->x[3 * a + 2]);
        high = fmax(high, s->x[3 * a + 2]);
    }
    int k = 1;
    while (k < STEPS && section_area(s, low + (high - low) * k / STEPS) < area)
        k++;
    if (k == STEPS)
        return pm_fail(err, PM_INPUT, "no section is as large as the print, %g mm2", area);
    below = low + (high - low) * (k - 1) / STEPS;
    above = low + (high - low) * k / STEPS;
    for (int half = 0; half < HALVINGS; half++) {
        const double middle = (below + above) / 2;
        if (section_area(s, middle) < area)
            below = middle;
        else
            above = middle;
    }
    *z = above;
    return PM_OK;
}

/* One piece, and what is below lies within it seen from below. Nodes next to the section may be on
 * it. */
static enum pm_status check_section(const struct skin *chamber, const struct skin *cut, double z,
                                    double snap, struct pm_err *err)
{
    enum pm_status status;
    struct skin_loops loops = {0};
    PM_TRY(skin_find_loops(cut, 2, z, &loops, err));
    if (loops.n != 1)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "its section at z = %.3f mm has %td pieces, expected one for the print", z,
                       loops.n));
    for (ptrdiff_t a = 0; a < chamber->nn; a++) {
        const double *x = chamber->x + 3 * a;
        if (x[2] < z - 2 * snap && !skin_loop_contains(cut, &loops, 0, 2, x))
            PM_TRY(pm_fail(err, PM_INPUT,
                           "it is wider below the print's section at z = %.3f mm: at (%.3f, %.3f, "
                           "%.3f) mm",
                           z, x[0], x[1], x[2]));
    }
done:
    skin_loops_release(&loops);
    return status;
}

/* The prism from the section at z down to `end`. */
static enum pm_status add_print(struct skin *s, double z, double end, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct skin_loops loops = {0};
    PM_TRY(skin_find_loops(s, 2, z, &loops, err));
    const ptrdiff_t n = loops.first[1], first = s->nn;
    for (ptrdiff_t i = 0; i < n; i++) {
        const double *x = s->x + 3 * (ptrdiff_t)loops.node[i];
        const double below[3] = {x[0], x[1], end};
        PM_TRY(skin_add_node(s, below, -1, err));
    }
    for (ptrdiff_t i = 0; i < n; i++) {
        const ptrdiff_t j = (i + 1) % n;
        PM_TRY(skin_add_triangle(s, loops.node[j], loops.node[i], first + i, SKIN_PRINT, err));
        PM_TRY(skin_add_triangle(s, loops.node[j], first + i, first + j, SKIN_PRINT, err));
    }
    PM_TRY(skin_close(s, 2, end, -1, SKIN_PRINT, err));
done:
    skin_loops_release(&loops);
    return status;
}

/* The print leaves the body through the base alone. */
static enum pm_status check_print(const struct skin *robot, const struct skin *core,
                                  int32_t chamber, ptrdiff_t nchambers, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct skin all = {0};
    struct pm_contact c;
    char name[32];
    PM_TRY(skin_extract(core, SKIN_PRINT, SKIN_PRINT, &all, err));
    PM_TRY(skin_extract(robot, PM_FACE_EXTERIOR, PM_FACE_EXTERIOR, &all, err));
    for (int32_t k = 1; k <= nchambers; k++)
        if (k != chamber)
            PM_TRY(skin_extract(robot, k, k, &all, err));
    PM_TRY(pm_collide_pierce(all.x, all.nt, all.tri, &c, err));
    if (c.a >= 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "the print of chamber%d meets %s at (%.3f, %.3f, %.3f) mm: expected a free "
                       "way to the base (--print-diameter 0: no print)",
                       (int)chamber, skin_tag_name(all.tag[c.b], name), c.at[0], c.at[1], c.at[2]));
done:
    skin_release(&all);
    return status;
}

enum pm_status mould_core(const struct skin *robot, const struct mould_opts *o, int32_t chamber,
                          ptrdiff_t nchambers, struct skin *core, struct pm_err *err)
{
    enum pm_status status;
    struct skin s = {0};
    double z = 0, base = 0;
    PM_TRY(skin_extract(robot, chamber, chamber, o->print > 0 ? &s : core, err));
    if (o->print <= 0)
        goto done;
    for (ptrdiff_t t = 0; t < robot->nt; t++)
        if (robot->tag[t] == PM_FACE_BASE)
            base = robot->x[3 * robot->tri[3 * t] + 2];
    PM_TRY(find_section(&s, acos(-1.0) * o->print * o->print / 4, &z, err));
    PM_TRY(skin_cut(&s, 2, z, 1, o->snap, core, err));
    PM_TRY(check_section(&s, core, z, o->snap, err));
    PM_TRY(add_print(core, z, base - o->wall, err));
    PM_TRY(check_print(robot, core, chamber, nchambers, err));
done:
    skin_release(&s);
    return status;
}
