#include "tools/tetmesh/walls.h"

#include <math.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"

/* Of the cones in which two points face each other. */
static const double COSINE = 0.5;

enum pm_status pm_walls_init(struct pm_walls *w, const struct pm_shell *bent, long layers,
                             int apart, double size, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    *w = (struct pm_walls){.bent = bent, .layers = layers, .apart = apart};
    w->reach = size * fmax((double)layers, 1);
    PM_TRY(PM_NEW(w->normal, 3 * bent->nt, err));
    for (ptrdiff_t t = 0; t < bent->nt; t++) {
        const int32_t *v = bent->tri + 3 * t;
        const double *a = bent->x + 3 * v[0], *b = bent->x + 3 * v[1], *c = bent->x + 3 * v[2];
        double *n = w->normal + 3 * t, l = 0;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
            l += n[i] * n[i];
        }
        for (int i = 0; i < 3 && l > 0; i++)
            n[i] /= sqrt(l);
    }
    PM_TRY(pm_collide_boxes(bent->x, bent->nt, bent->tri, NULL, &w->boxes, err));
done:
    if (status != PM_OK)
        pm_walls_release(w);
    return status;
}

void pm_walls_release(struct pm_walls *w)
{
    pm_boxes_free(w->boxes);
    pm_free(w->normal);
    *w = (struct pm_walls){0};
}

struct look {
    const struct pm_walls *w;
    double x[3], n[3]; /* where from, which way */
    int solid;
};

static double look_at(void *data, int32_t t, double best)
{
    const struct look *l = data;
    const struct pm_shell *s = l->w->bent;
    const int32_t *v = s->tri + 3 * (ptrdiff_t)t;
    const double *m = l->w->normal + 3 * (ptrdiff_t)t;
    /* normals of chambers point into the solid, those of the exterior out of it */
    const double way = (s->tag[t] > 0) == l->solid ? -1 : 1;
    double q[3], dn = 0, dm = 0;
    const double d = pm_collide_closest(l->x, s->x + 3 * v[0], s->x + 3 * v[1], s->x + 3 * v[2], q);
    for (int i = 0; i < 3; i++) {
        dn += (q[i] - l->x[i]) * l->n[i];
        dm += way * (q[i] - l->x[i]) * m[i];
    }
    return d > 0 && d < best && dn >= COSINE * d && dm >= COSINE * d ? d : best;
}

double pm_walls_facing(const struct pm_walls *w, const double x[3], const double n[3], int solid,
                       double best)
{
    for (unsigned image = 0; image < 4; image++) {
        struct look l = {.w = w, .solid = solid};
        if ((image & ~w->bent->planes) != 0)
            continue;
        for (unsigned i = 0; i < 3; i++) {
            const double sign = i < 2 && image >> i & 1 ? -1 : 1;
            l.x[i] = sign * x[i];
            l.n[i] = sign * n[i];
        }
        best = pm_boxes_nearest(w->boxes, l.x, best, look_at, &l);
    }
    return best;
}

double pm_walls_bound(const void *data, const double x[3], const double normal[3], double curvature)
{
    const struct pm_wall_side *side = data;
    const struct pm_walls *w = side->walls;
    const double into = side->chamber ? 1 : -1; /* the solid */
    const double n[3] = {into * normal[0], into * normal[1], into * normal[2]};
    const double back[3] = {-n[0], -n[1], -n[2]};
    double d = pm_walls_facing(w, x, n, 1, w->reach), bound = INFINITY;
    if (w->layers > 0 && d < w->reach)
        bound = d / (double)w->layers;
    if (!w->apart)
        return bound;
    d = pm_walls_facing(w, x, back, 0, d);
    return d < w->reach ? fmin(bound, fmin(sqrt(2 * d / curvature), 5 * d)) : bound;
}
