#include "common/geometry/contact.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/geometry/closeness.h"
#include "common/geometry/collide.h"
#include "common/geometry/skin.h"

/* Of the cones in which two points face each other. */
static const double COSINE = 0.8;
/* Largest gap, in parts of the body's diagonal. */
static const double WIDE = 0.05;

struct look {
    const struct pm_skin *s;
    struct pm_self_contact *c;
};

/* From the corners of triangle a to triangle b. */
static double look_across(const struct look *l, int32_t a, int32_t b, double best)
{
    const struct pm_skin *s = l->s;
    const int32_t *v = s->tri + 3 * (ptrdiff_t)a, *w = s->tri + 3 * (ptrdiff_t)b;
    const double *n = s->facet + 3 * (ptrdiff_t)a, *m = s->facet + 3 * (ptrdiff_t)b;
    for (int k = 0; k < 3; k++) {
        const double *x = s->y + 3 * v[k];
        double q[3], dn = 0, dm = 0;
        if (v[k] == w[0] || v[k] == w[1] || v[k] == w[2])
            continue; /* rounding would make a distance of it */
        const double d =
            pm_collide_closest(x, s->y + 3 * w[0], s->y + 3 * w[1], s->y + 3 * w[2], q);
        for (int i = 0; i < 3; i++) {
            dn += (q[i] - x[i]) * n[i];
            dm -= (q[i] - x[i]) * m[i];
        }
        if (!(d > 0 && d < best && dn >= COSINE * d && dm >= COSINE * d))
            continue;
        best = d;
        memcpy(l->c->at, x, sizeof l->c->at);
        l->c->surface[0] = s->tag[a];
        l->c->surface[1] = s->tag[b];
    }
    return best;
}

static double look_both(void *data, int32_t a, int32_t b, double best)
{
    return look_across(data, b, a, look_across(data, a, b, best));
}

/* The plane and the image beyond, which corners face. */
static double look_at_plane(const struct look *l, const struct pm_skin_plane *p, double best)
{
    const struct pm_skin *s = l->s;
    for (ptrdiff_t t = 0; t < s->nt; t++)
        for (int k = 0; k < 3 && -p->side * s->facet[3 * t + p->axis] >= COSINE; k++) {
            const double *x = s->y + 3 * s->tri[3 * t + k];
            const double d = 2 * p->side * (x[p->axis] - p->at);
            if (!(d > 0 && d < best))
                continue;
            best = d;
            memcpy(l->c->at, x, sizeof l->c->at);
            l->c->surface[0] = s->tag[t];
            l->c->surface[1] = p->tag;
        }
    return best;
}

static double diagonal(const struct pm_mesh *m)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double lo = m->x[i], hi = lo;
        for (ptrdiff_t a = 1; a < m->nn; a++) {
            lo = m->x[3 * a + i] < lo ? m->x[3 * a + i] : lo;
            hi = m->x[3 * a + i] > hi ? m->x[3 * a + i] : hi;
        }
        sum += (hi - lo) * (hi - lo);
    }
    return sqrt(sum);
}

static void find_gap(const struct pm_skin *s, struct pm_self_contact *c)
{
    struct look l = {s, c};
    const double wide = WIDE * diagonal(s->m);
    double best = pm_boxes_pairs(s->boxes, COSINE, wide, look_both, &l);
    for (int k = 0; k < s->nplanes; k++)
        best = look_at_plane(&l, &s->plane[k], best);
    c->gap = best < wide ? best : -1;
}

/* A face that reaches through a plane: further than rounding of a node that is held on it. */
static int beyond(const struct pm_skin *s, const struct pm_skin_plane *p, ptrdiff_t t, double at[3])
{
    for (int k = 0; k < 3; k++) {
        const double *y = s->y + 3 * (ptrdiff_t)s->tri[3 * t + k];
        const double d = p->side * (y[p->axis] - p->at);
        if (d < -1e-9 * (1 + fabs(p->at))) {
            memcpy(at, y, 3 * sizeof *at);
            return 1;
        }
    }
    return 0;
}

static void find_mirrored(const struct pm_skin *s, struct pm_self_contact *c)
{
    for (int k = 0; k < s->nplanes; k++)
        for (ptrdiff_t f = 0; f < s->nt / s->parts; f++) {
            double at[3];
            int hit = 0;
            for (ptrdiff_t t = s->parts * f; t < s->parts * (f + 1) && !hit; t++)
                hit = beyond(s, &s->plane[k], t, at);
            if (!hit || c->intersections++ > 0)
                continue;
            memcpy(c->at, at, sizeof c->at);
            c->surface[0] = s->tag[s->parts * f];
            c->surface[1] = s->plane[k].tag;
        }
}

enum pm_status pm_contact_find(const struct pm_mesh *m, const double *u, struct pm_self_contact *c,
                               struct pm_err *err)
{
    enum pm_status status;
    struct pm_skin s;
    struct pm_contact pierced;
    double G[PM_CLOSENESS_PARTS];

    *c = (struct pm_self_contact){.gap = 0};
    PM_TRY(pm_skin_new(m, u, &s, err));
    PM_TRY(pm_collide_faces(s.boxes, s.y, s.tri, s.parts, &pierced, err));
    if (pierced.pairs > 0) {
        c->intersections = pierced.pairs;
        memcpy(c->at, pierced.at, sizeof c->at);
        c->surface[0] = s.tag[pierced.a];
        c->surface[1] = s.tag[pierced.b];
    }
    find_mirrored(&s, c);
    if (c->intersections == 0)
        find_gap(&s, c);
    PM_TRY(pm_closeness_of(&s, G, NULL, err));
    c->closeness = pm_closeness_sum(G);
done:
    pm_skin_release(&s);
    return status;
}

static const char *name(int32_t tag, char text[32])
{
    static const char *const other[] = {"the exterior",     "the base",         "the tip",
                                        "symmetry plane x", "symmetry plane y", "symmetry plane z"};
    if (tag <= 0)
        return other[-tag];
    snprintf(text, 32, "chamber %d", (int)tag);
    return text;
}

void pm_contact_tell(const struct pm_self_contact *c)
{
    char a[32], b[32];
    const char *first = name(c->surface[0], a),
               *second = c->surface[0] == c->surface[1] ? "itself" : name(c->surface[1], b);
    if (c->intersections > 0)
        pm_warn("self-contact is not modelled: %lld pairs of faces pierce each other, the first of "
                "%s and %s at (%.4g, %.4g, %.4g) mm",
                (long long)c->intersections, first, second, c->at[0], c->at[1], c->at[2]);
    else if (c->gap >= 0)
        pm_log(1, "smallest gap %.3g mm, of %s and %s at (%.4g, %.4g, %.4g) mm", c->gap, first,
               second, c->at[0], c->at[1], c->at[2]);
}
