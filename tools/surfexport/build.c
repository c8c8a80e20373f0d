#include "tools/surfexport/build.h"

#include <math.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/collide.h"
#include "common/geometry/curvature.h"
#include "common/geometry/remesh.h"
#include "tools/surfexport/close.h"

/* Edges of sqrt(8 e / c) leave e, those that come out up to 4/3 longer 16/9 e; what is bent more
 * between the places where its curvature was seen is split. */
static enum pm_status triangulate(const struct pm_surface *s, int k, double size, double tolerance,
                                  struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_remesh_opts o = {.size = size,
                                     .size_min = size / 100,
                                     .crest = 1.2,
                                     .chord = 9 * tolerance / 16,
                                     .tolerance = tolerance,
                                     .growth = 0.35,
                                     .sweeps = 8};
    pm_patch_release(p);
    PM_TRY(pm_remesh(s, k, &o, p, err));
    pm_log(2, "surface %d: %td triangles and %td by splits, %.4f mm off", k, p->nt - p->splits,
           p->splits, p->off);
    if (p->off > tolerance)
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "surface %d stays %.3g mm from its triangles, expected at most %.3g mm: "
                       "smaller edges (--size) may do",
                       k, p->off, tolerance));
done:
    return status;
}

static enum pm_status add_patch(struct skin *skin, const struct pm_surface *s,
                                const struct pm_map *map, const struct pm_patch *p, int32_t k,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis work = {0};
    const ptrdiff_t first = skin->nn;
    for (ptrdiff_t a = 0; a < p->nn; a++) {
        double r_a[6], r_ab[9];
        struct pm_curvature c;
        PM_TRY(skin_add_node(skin, p->x + 3 * a, k, err));
        PM_TRY(pm_map_point(map, s->phi, p->S + 3 * a, &work, NULL, r_a, r_ab, err));
        pm_curvature_at(r_a, r_ab, &c);
        skin->curvature[first + a] = sqrt(fmax(c.Q, 0));
    }
    for (ptrdiff_t t = 0; t < p->nt; t++)
        PM_TRY(skin_add_triangle(skin, first + p->tri[3 * t], first + p->tri[3 * t + 1],
                                 first + p->tri[3 * t + 2], k, err));
done:
    pm_basis_release(&work);
    return status;
}

/* The rims lie in planes z = constant exactly; the first nodes of the skin are the patch's. */
static enum pm_status add_cap(struct skin *skin, const struct pm_patch *p, int rim, double z,
                              struct pm_err *err)
{
    for (ptrdiff_t a = 0; a < p->nn; a++) {
        if (p->rim[a] != rim)
            continue;
        if (fabs(skin->x[3 * a + 2] - z) > 1e-9 * fmax(1, fabs(z)))
            return pm_fail(err, PM_INPUT,
                           "the rim of the exterior at the %s is not planar: z = %g and %g",
                           rim == 1 ? "base" : "tip", z, skin->x[3 * a + 2]);
        skin->x[3 * a + 2] = z;
    }
    return skin_close(skin, 2, z, rim == 1 ? -1 : 1, rim == 1 ? PM_FACE_BASE : PM_FACE_TIP, err);
}

enum pm_status skin_build(const struct pm_surfaces *s, double size, double tolerance,
                          struct skin *skin, double *error, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_patch p = {0};
    struct pm_map *map = NULL;
    *error = 0;
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        const struct pm_surface *surface = &s->s[k];
        PM_TRY(pm_map_new(surface, &map, err));
        PM_TRY(triangulate(surface, (int)k, size, tolerance, &p, err));
        PM_TRY(add_patch(skin, surface, map, &p, (int32_t)k, err));
        *error = fmax(*error, p.off);
        if (k == 0) {
            PM_TRY(add_cap(skin, &p, 1, surface->phi[2], err));
            PM_TRY(add_cap(skin, &p, 2, surface->phi[3 * surface->n - 1], err));
        }
        pm_map_free(map);
        map = NULL;
    }
done:
    pm_patch_release(&p);
    pm_map_free(map);
    return status;
}

/* ---- walls ---- */

struct nearest {
    const struct skin *s;
    const int32_t *tri;
    const double *p;
};

static double visit(void *data, int32_t t, double best)
{
    const struct nearest *n = data;
    const int32_t *v = n->tri + 3 * (ptrdiff_t)t;
    const double *x = n->s->x;
    double q[3];
    return fmin(best, pm_collide_closest(n->p, x + 3 * (ptrdiff_t)v[0], x + 3 * (ptrdiff_t)v[1],
                                         x + 3 * (ptrdiff_t)v[2], q));
}

/* Triangles of surface k, which stand together: the exterior with its caps, chamber 1, .. */
static void range(const struct skin *s, ptrdiff_t k, ptrdiff_t *first, ptrdiff_t *n)
{
    *first = 0;
    while (*first < s->nt && (s->tag[*first] > 0 ? s->tag[*first] : 0) != k)
        (*first)++;
    for (*n = 0; *first + *n < s->nt && (s->tag[*first + *n] > 0 ? s->tag[*first + *n] : 0) == k;)
        (*n)++;
}

enum pm_status skin_walls(struct skin *s, ptrdiff_t nchambers, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *boxes = NULL;
    ptrdiff_t first, n;
    for (ptrdiff_t a = 0; a < s->nn; a++)
        s->wall[a] = INFINITY;
    for (ptrdiff_t k = 0; k <= nchambers; k++) {
        range(s, k, &first, &n);
        struct nearest near = {.s = s, .tri = s->tri + 3 * first};
        PM_TRY(pm_collide_boxes(s->x, n, near.tri, NULL, &boxes, err));
        for (ptrdiff_t a = 0; a < s->nn; a++) {
            near.p = s->x + 3 * a;
            if (s->surface[a] != k)
                s->wall[a] = pm_boxes_nearest(boxes, near.p, s->wall[a], visit, &near);
        }
        pm_boxes_free(boxes);
        boxes = NULL;
    }
done:
    pm_boxes_free(boxes);
    return status;
}

/* ---- nesting ---- */

enum pm_status skin_check_nesting(const struct skin *s, ptrdiff_t nchambers, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_contact c;
    char a[32], b[32];
    PM_TRY(pm_collide_pierce(s->x, s->nt, s->tri, &c, err));
    if (c.a >= 0)
        PM_TRY(pm_fail(err, PM_INPUT, "%s cuts %s at (%.3f, %.3f, %.3f) mm",
                       skin_tag_name(s->tag[c.b], b), skin_tag_name(s->tag[c.a], a), c.at[0],
                       c.at[1], c.at[2]));
    /* Nothing crosses, so one node decides. */
    for (ptrdiff_t k = 1; k <= nchambers; k++)
        for (ptrdiff_t j = 0; j <= nchambers; j++) {
            ptrdiff_t first, n, mine;
            range(s, k, &mine, &n);
            range(s, j, &first, &n);
            const double *x = s->x + 3 * (ptrdiff_t)s->tri[3 * mine];
            if (j == k || (pm_collide_winding(x, s->x, n, s->tri + 3 * first) > 0.5) == (j == 0))
                continue;
            PM_TRY(pm_fail(err, PM_INPUT, "chamber%td at (%.3f, %.3f, %.3f) mm is %s %s", k, x[0],
                           x[1], x[2], j == 0 ? "outside of the" : "inside",
                           skin_tag_name((int32_t)j, a)));
        }
done:
    return status;
}
