/* The plate that closes the base of the mould and holds the prints. */
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/surfexport/close.h"
#include "tools/surfexport/mould.h"

/* An outline in the plane z = constant, counter-clockwise from above. */
struct outline {
    ptrdiff_t n;
    double *xy; /* (n x 2) [mm] */
};

/* The wall over an outline from z0 up to z1, normals away from it (sense 1) or into it (-1). */
static enum pm_status add_wall(struct skin *s, const struct outline *o, double z0, double z1,
                               int sense, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t first = s->nn;
    for (ptrdiff_t i = 0; i < 2 * o->n; i++) {
        const double *p = o->xy + 2 * (i % o->n), x[3] = {p[0], p[1], i < o->n ? z0 : z1};
        PM_TRY(skin_add_node(s, x, -1, err));
    }
    for (ptrdiff_t i = 0; i < o->n; i++) {
        const ptrdiff_t j = (i + 1) % o->n, a = first + (sense > 0 ? i : j),
                        b = first + (sense > 0 ? j : i);
        PM_TRY(skin_add_triangle(s, a, b, b + o->n, SKIN_MOULD, err));
        PM_TRY(skin_add_triangle(s, a, b + o->n, a + o->n, SKIN_MOULD, err));
    }
done:
    return status;
}

static enum pm_status add_rectangle(struct skin *s, const double low[3], const double high[3],
                                    double margin, double z0, double z1, int sense,
                                    struct pm_err *err)
{
    const double a = low[0] - margin, b = high[0] + margin, c = low[1] - margin,
                 d = high[1] + margin;
    double xy[] = {a, c, b, c, b, d, a, d};
    const struct outline o = {4, xy};
    return add_wall(s, &o, z0, z1, sense, err);
}

/* The outline l of a section moved out by `gap`, along the mean normal of both edges of a node. */
static enum pm_status widen(const struct skin *s, const struct skin_loops *l, ptrdiff_t which,
                            double gap, struct outline *o, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int32_t *node = l->node + l->first[which];
    o->n = l->first[which + 1] - l->first[which];
    PM_TRY(PM_NEW(o->xy, 2 * o->n, err));
    for (ptrdiff_t i = 0; i < o->n; i++) {
        const double *p = s->x + 3 * (ptrdiff_t)node[i];
        double n[2] = {0};
        for (int side = 0; side < 2; side++) {
            const double *a = s->x + 3 * (ptrdiff_t)node[(i + o->n - 1 + side) % o->n];
            const double *b = s->x + 3 * (ptrdiff_t)node[(i + side) % o->n];
            const double length = hypot(b[0] - a[0], b[1] - a[1]);
            n[0] += (b[1] - a[1]) / length;
            n[1] -= (b[0] - a[0]) / length;
        }
        const double length = hypot(n[0], n[1]);
        for (int k = 0; k < 2; k++)
            o->xy[2 * i + k] = p[k] + (length > 0 ? gap * n[k] / length : 0);
    }
done:
    return status;
}

/* The one loop where s is open. */
static enum pm_status open_outline(const struct skin *s, double gap, struct outline *o,
                                   struct pm_err *err)
{
    enum pm_status status;
    struct skin_loops loops = {0};
    int32_t *open = NULL;
    ptrdiff_t n = 0;
    PM_TRY(skin_open_edges(s, &open, &n, err));
    if (n == 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "a surface that should be open is closed"));
    PM_TRY(skin_find_loops(s, 2, s->x[3 * open[0] + 2], &loops, err));
    PM_TRY(widen(s, &loops, 0, gap, o, err));
done:
    pm_free(open);
    skin_loops_release(&loops);
    return status;
}

/* ---- openings to pour and to vent ---- */

static double to_segment(const double p[2], const double *a, const double *b)
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]}, dd = d[0] * d[0] + d[1] * d[1];
    const double t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (dd > 0 ? dd : 1);
    const double s = fmin(fmax(t, 0), 1);
    return hypot(p[0] - a[0] - s * d[0], p[1] - a[1] - s * d[1]);
}

/* Distance of p from the outline, negative inside. */
static double distance(const struct outline *o, const double p[2])
{
    double least = INFINITY;
    int inside = 0;
    for (ptrdiff_t i = 0; i < o->n; i++) {
        const double *a = o->xy + 2 * i, *b = o->xy + 2 * ((i + 1) % o->n);
        least = fmin(least, to_segment(p, a, b));
        if ((a[1] > p[1]) != (b[1] > p[1]) &&
            p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]))
            inside = !inside;
    }
    return inside ? -least : least;
}

/* The point of a grid that is furthest from the rim, inside it, and from n outlines; *free is that
 * distance. */
static void roomiest(const struct outline *rim, const struct outline *o, ptrdiff_t n,
                     double best[2], double *free)
{
    enum { GRID = 80 };
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    *free = 0;
    for (ptrdiff_t i = 0; i < 2 * rim->n; i++) {
        low[i % 2] = fmin(low[i % 2], rim->xy[i]);
        high[i % 2] = fmax(high[i % 2], rim->xy[i]);
    }
    for (int k = 0; k < (GRID + 1) * (GRID + 1); k++) {
        const int column = k % (GRID + 1), row = k / (GRID + 1);
        const double p[2] = {low[0] + (high[0] - low[0]) * column / GRID,
                             low[1] + (high[1] - low[1]) * row / GRID};
        double d = -distance(rim, p);
        for (ptrdiff_t j = 0; j < n && d > *free; j++)
            d = fmin(d, distance(&o[j], p));
        if (d > *free) {
            *free = d;
            memcpy(best, p, sizeof p);
        }
    }
}

/* A round opening where there is most room, at most `radius`, a millimetre from everything. */
static enum pm_status opening(const struct outline *rim, const struct outline *others, ptrdiff_t n,
                              double radius, struct outline *o, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    enum { AROUND = 32 };
    double center[2] = {0}, free;
    roomiest(rim, others, n, center, &free);
    const double r = fmin(free - 1, radius);
    if (!(r >= 0.5))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "there is no room to pour between the prints and the rim of the base: %.3g "
                       "mm, expected 1.5 mm (a smaller --print-diameter leaves more)",
                       free));
    o->n = AROUND;
    PM_TRY(PM_NEW(o->xy, 2 * o->n, err));
    for (ptrdiff_t i = 0; i < o->n; i++) {
        const double angle = 2 * acos(-1.0) * (double)i / AROUND;
        o->xy[2 * i] = center[0] + r * cos(angle);
        o->xy[2 * i + 1] = center[1] + r * sin(angle);
    }
done:
    return status;
}

/* ---- the plate ---- */

static enum pm_status find_holes(const struct skin *robot, const struct mould_opts *o,
                                 ptrdiff_t nchambers, struct outline *hole, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct outline rim = {0};
    struct skin body = {0}, core = {0};
    for (int32_t k = 1; k <= nchambers; k++) {
        PM_TRY(mould_core(robot, o, k, nchambers, &body, err));
        PM_TRY(skin_extract(&body, k, k, &core, err));
        PM_TRY(open_outline(&core, o->clearance, &hole[k - 1], err));
        skin_release(&body);
        skin_release(&core);
    }
    PM_TRY(skin_extract(robot, PM_FACE_TIP, PM_FACE_EXTERIOR, &body, err));
    skin_drop(&body, PM_FACE_BASE);
    PM_TRY(open_outline(&body, 0, &rim, err));
    for (ptrdiff_t k = nchambers; k < nchambers + 2; k++)
        PM_TRY(opening(&rim, hole, k, 3, &hole[k], err));
done:
    pm_free(rim.xy);
    skin_release(&body);
    skin_release(&core);
    return status;
}

enum pm_status mould_plate(const struct skin *robot, const struct mould_opts *o,
                           ptrdiff_t nchambers, struct skin *plate, struct pm_err *err)
{
    enum pm_status status;
    struct outline *hole = NULL;
    double low[3], high[3];
    PM_TRY(mould_block(robot, o, low, high, err));
    const double base = low[2], bottom = base - o->wall, lip = base + o->wall / 2;
    PM_TRY(PM_NEW(hole, nchambers + 2, err));
    PM_TRY(find_holes(robot, o, nchambers, hole, err));
    PM_TRY(add_rectangle(plate, low, high, o->clearance + o->wall / 2, bottom, lip, 1, err));
    PM_TRY(add_rectangle(plate, low, high, o->clearance, base, lip, -1, err));
    for (ptrdiff_t k = 0; k < nchambers + 2; k++)
        PM_TRY(add_wall(plate, &hole[k], bottom, base, -1, err));
    PM_TRY(skin_close(plate, 2, lip, 1, SKIN_MOULD, err));
    PM_TRY(skin_close(plate, 2, base, 1, SKIN_MOULD, err));
    PM_TRY(skin_close(plate, 2, bottom, -1, SKIN_MOULD, err));
done:
    for (ptrdiff_t k = 0; hole != NULL && k < nchambers + 2; k++)
        pm_free(hole[k].xy);
    pm_free(hole);
    return status;
}
