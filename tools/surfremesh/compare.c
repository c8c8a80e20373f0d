#include "tools/surfremesh/compare.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/boxes.h"
#include "common/geometry/distance.h"

enum pm_status compare_side_init(struct compare_side *c, const struct pm_surface *s,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surface copy = *s;
    ptrdiff_t offset[2] = {0, s->n};
    const struct pm_surfaces one = {.ns = 1, .s = &copy, .offset = offset};

    *c = (struct compare_side){.s = s};
    PM_TRY(pm_samples_new(&one, HUGE_VAL, COMPARE_CUTS, &c->m, err));
    PM_TRY(PM_NEW(c->x, 3 * c->m.n, err));
    PM_TRY(PM_NEW(c->normal, 3 * c->m.n, err));
    pm_samples_all(&c->m, s->phi, c->x, c->normal);
done:
    return status;
}

void compare_side_release(struct compare_side *c)
{
    pm_samples_release(&c->m);
    pm_free(c->x);
    pm_free(c->normal);
    *c = (struct compare_side){0};
}

/* The nearest sample of a surface whose normal points the way of `normal`. */
struct search {
    const double *x, *n, *at, *normal;
    ptrdiff_t found;
};

static double visit(void *data, int32_t id, double best)
{
    struct search *s = data;
    const double *x = &s->x[3 * (ptrdiff_t)id], *n = &s->n[3 * (ptrdiff_t)id];
    double d2 = 0;

    if (!(n[0] * s->normal[0] + n[1] * s->normal[1] + n[2] * s->normal[2] > 0))
        return best;
    for (int j = 0; j < 3; j++)
        d2 += (x[j] - s->at[j]) * (x[j] - s->at[j]);
    if (!(d2 < best * best))
        return best;
    s->found = id;
    return sqrt(d2);
}

/* S (samples of `from` x 3): parameter of the nearest sample of `to`. */
static enum pm_status nearest(const struct compare_side *from, const struct compare_side *to,
                              double *S, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *boxes = NULL;
    double *box = NULL;

    PM_TRY(PM_NEW(box, 6 * to->m.n, err));
    for (ptrdiff_t i = 0; i < 6 * to->m.n; i++)
        box[i] = to->x[i / 6 * 3 + i % 3];
    PM_TRY(pm_boxes_new(to->m.n, box, NULL, &boxes, err));
    for (ptrdiff_t i = 0; i < from->m.n; i++) {
        struct search s = {.x = to->x,
                           .n = to->normal,
                           .at = &from->x[3 * i],
                           .normal = &from->normal[3 * i],
                           .found = -1};
        pm_boxes_nearest(boxes, s.at, INFINITY, visit, &s);
        if (s.found < 0)
            PM_TRY(pm_fail(err, PM_NUMERIC,
                           "nothing of the other form of the surface faces the way it does at "
                           "(%.4g, %.4g, %.4g)",
                           s.at[0], s.at[1], s.at[2]));
        memcpy(&S[3 * i], &to->m.S[3 * s.found], 3 * sizeof *S);
    }
done:
    pm_boxes_free(boxes);
    pm_free(box);
    return status;
}

/* Adds the distances of the samples of `from` from the surface of `to`, feet starting at S. */
static enum pm_status measure(const struct compare_side *from, const struct compare_side *to,
                              double *S, double *mean, double *max, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *s = to->s;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double sum = 0, total = 0;

    PM_TRY(pm_map_new(s, &map, err));
    for (ptrdiff_t i = 0; i < from->m.n; i++) {
        double foot[3], d;
        PM_TRY(pm_distance_project(map, s->type, s->phi, &from->x[3 * i], &work, &S[3 * i], foot,
                                   &d, err));
        *max = fmax(*max, d);
        sum += d * from->m.area[i];
        total += from->m.area[i];
    }
    *mean += sum / total / 2;
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status compare_surfaces(const struct compare_side *old, const struct compare_side *now,
                                double *S, double *mean, double *max, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *near = NULL;

    *mean = *max = 0;
    PM_TRY(PM_NEW(near, 3 * (old->m.n > now->m.n ? old->m.n : now->m.n), err));
    if (S == NULL)
        PM_TRY(nearest(now, old, near, err));
    PM_TRY(measure(now, old, S != NULL ? S : near, mean, max, err));
    PM_TRY(nearest(old, now, near, err));
    PM_TRY(measure(old, now, near, mean, max, err));
done:
    pm_free(near);
    return status;
}
