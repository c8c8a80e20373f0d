#include "tools/surfexport/surfexport.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/step.h"
#include "common/geometry/collide.h"
#include "tools/surfexport/build.h"
#include "tools/surfexport/write.h"

enum part { BODY, EXTERIOR, CHAMBERS, CHAMBER, MOULD, CORE, PLATE };

struct order {
    enum part part;
    int32_t number; /* of the chamber or half */
};

static enum pm_status parse_what(const char *what, ptrdiff_t nchambers, struct order *o,
                                 struct pm_err *err)
{
    static const struct {
        const char *name;
        enum part part;
        int numbered;
    } known[] = {{"body", BODY, 0},       {"exterior", EXTERIOR, 0}, {"chambers", CHAMBERS, 0},
                 {"chamber", CHAMBER, 1}, {"mould", MOULD, 1},       {"core", CORE, 1},
                 {"plate", PLATE, 0}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const size_t n = strlen(known[k].name);
        const char *digit = what + n;
        const ptrdiff_t most = known[k].part == MOULD ? 2 : nchambers;
        if (strncmp(what, known[k].name, n) != 0 || strlen(digit) != (size_t)known[k].numbered)
            continue;
        if (known[k].numbered && (*digit < '1' || *digit > '0' + most))
            continue;
        *o = (struct order){known[k].part, known[k].numbered ? *digit - '0' : 0};
        return PM_OK;
    }
    return pm_fail(err, PM_USAGE,
                   "option --what: found '%s', expected body, exterior, chambers, chamberN, coreN "
                   "(N from 1 to %td), mould1, mould2 or plate",
                   what, nchambers);
}

static enum pm_status load(const char *path, int accepted, struct pm_surfaces *s,
                           struct pm_err *err)
{
    enum pm_status status;
    struct pm_step step = {0};
    if (!accepted)
        return pm_surfaces_load(path, s, err);
    PM_TRY(pm_step_load(path, &step, err));
    PM_TRY(pm_surfaces_copy(&step.accepted, s, err));
done:
    pm_step_release(&step);
    return status;
}

/* ---- what is told ---- */

struct sample {
    double wall, area;
    ptrdiff_t node;
};

static int by_wall(const void *a, const void *b)
{
    const struct sample *p = a, *q = b;
    return p->wall != q->wall ? (p->wall < q->wall ? -1 : 1)
                              : (p->node > q->node) - (p->node < q->node);
}

/* Least wall and median by area, over the exterior without caps. */
static enum pm_status tell_walls(const struct skin *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct sample *w = NULL;
    double all = 0, sum = 0;
    ptrdiff_t n = 0, k = 0;
    PM_TRY(PM_NEW(w, s->nn, err));
    for (ptrdiff_t a = 0; a < s->nn; a++)
        w[a] = (struct sample){s->wall[a], 0, a};
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double d[3];
        skin_normal(s, t, d);
        const double area = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 6;
        for (int i = 0; i < 3 && s->tag[t] == PM_FACE_EXTERIOR; i++)
            w[s->tri[3 * t + i]].area += area;
    }
    for (ptrdiff_t a = 0; a < s->nn; a++)
        if (w[a].area > 0) {
            all += w[a].area;
            w[n++] = w[a];
        }
    qsort(w, (size_t)n, sizeof *w, by_wall);
    while (k + 1 < n && sum + w[k].area < all / 2)
        sum += w[k++].area;
    const double *x = s->x + 3 * w[0].node;
    pm_log(1, "wall: least %.3f mm at (%.3f, %.3f, %.3f) mm, half of the exterior below %.3f mm",
           w[0].wall, x[0], x[1], x[2], w[k].wall);
done:
    pm_free(w);
    return status;
}

static void tell_product(const char *what, const struct skin *s)
{
    double area = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double n[3];
        skin_normal(s, t, n);
        area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    }
    pm_log(1, "%s: %td nodes, %td triangles, area %.2f mm2, volume %.2f mm3", what, s->nn, s->nt,
           area, pm_collide_volume(s->x, s->nt, s->tri));
}

/* ---- products ---- */

static enum pm_status make(const struct skin *robot, const struct surfexport_opts *o,
                           const struct order *order, ptrdiff_t nchambers, struct skin *s,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int32_t n = order->number;
    double undercut = 0;
    switch (order->part) {
    case BODY:
        PM_TRY(skin_extract(robot, PM_FACE_TIP, PM_MAX_CHAMBERS, s, err));
        skin_flip(s, 1, PM_MAX_CHAMBERS);
        break;
    case EXTERIOR:
        PM_TRY(skin_extract(robot, PM_FACE_TIP, PM_FACE_EXTERIOR, s, err));
        break;
    case CHAMBERS:
        PM_TRY(skin_extract(robot, 1, PM_MAX_CHAMBERS, s, err));
        break;
    case CHAMBER:
        PM_TRY(skin_extract(robot, n, n, s, err));
        break;
    case CORE:
        PM_TRY(mould_core(robot, &o->mould, n, nchambers, s, err));
        break;
    case PLATE:
        PM_TRY(mould_plate(robot, &o->mould, nchambers, s, err));
        break;
    case MOULD:
        PM_TRY(mould_half(robot, &o->mould, n == 1 ? 1 : -1, s, &undercut, err));
        if (undercut > 1e-3)
            pm_warn("undercut: %.1f %% of the area of this half of the body faces against the pull "
                    "along %c: it leaves a rigid mould only by bending",
                    100 * undercut, "xyz"[o->mould.pull]);
        break;
    }
done:
    return status;
}

/* Where in the file the surfaces are wrong, the file is to blame. */
static enum pm_status blame(enum pm_status status, const char *path, struct pm_err *err)
{
    struct pm_err whole = {.status = PM_OK};
    if (status != PM_INPUT && status != PM_NUMERIC)
        return status;
    pm_fail(&whole, status, "cannot use '%s': %.400s", path, err->text);
    *err = whole;
    return status;
}

static enum pm_status triangulate(const struct surfexport_opts *opts, const struct pm_surfaces *s,
                                  const struct order *order, struct skin *product,
                                  struct pm_err *err)
{
    enum pm_status status;
    struct skin robot = {0};
    double error;
    struct surfexport_opts o = *opts;
    const double size = o.size > 0 ? o.size : s->pcase.mesh_size;
    /* moves no node further than the triangles are off */
    o.mould.snap = fmin(o.tolerance, size / 50) / 2;
    PM_TRY(skin_build(s, size, o.tolerance, &robot, &error, err));
    PM_TRY(skin_check_nesting(&robot, s->ns - 1, err));
    pm_log(1, "surfaces within %.4f mm of the triangles", error);
    if (s->ns > 1) {
        PM_TRY(skin_walls(&robot, s->ns - 1, err));
        PM_TRY(tell_walls(&robot, err));
    }
    PM_TRY(make(&robot, &o, order, s->ns - 1, product, err));
    PM_TRY(skin_check(product, err));
    tell_product(o.what, product);
done:
    skin_release(&robot);
    return status;
}

enum pm_status surfexport_run(const struct surfexport_opts *opts, const struct pm_common *common,
                              struct pm_err *err)
{
    enum pm_status status;
    struct pm_surfaces s = {0};
    struct skin product = {0};
    struct order order = {.number = 0};
    enum write_format format;
    PM_TRY(write_format_of(common->output, &format, err));
    if (opts->ascii && format != WRITE_STL)
        PM_TRY(pm_fail(err, PM_USAGE, "option --ascii: expected an output that ends in .stl"));
    if (opts->mould.clearance > opts->mould.wall / 5)
        PM_TRY(pm_fail(err, PM_USAGE,
                       "option --clearance: found %g, expected at most a fifth of "
                       "--mould-wall, %g",
                       opts->mould.clearance, opts->mould.wall / 5));
    if (strcmp(opts->what, "plate") == 0 && opts->mould.print <= 0)
        PM_TRY(pm_fail(err, PM_USAGE, "--what plate needs prints, found --print-diameter 0"));
    PM_TRY(load(common->operands[0], opts->accepted, &s, err));
    PM_TRY(parse_what(opts->what, s.ns - 1, &order, err));
    PM_TRY(blame(triangulate(opts, &s, &order, &product, err), common->operands[0], err));
    if (format == WRITE_VTK)
        PM_TRY(write_vtk(&product, &s.pcase, s.ns > 1 && order.part < MOULD, common, err));
    else
        PM_TRY(write_triangles(&product, opts->ascii ? WRITE_STL_ASCII : format, opts->what,
                               common->output, err));
done:
    skin_release(&product);
    pm_surfaces_release(&s);
    return status;
}
