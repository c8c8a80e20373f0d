#include "common/geometry/contact.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/collide.h"

/* Of the cones in which two points face each other. */
static const double COSINE = 0.8;
/* Of the angle to the mean normal beyond which a node at an edge looks along each triangle's. */
static const double SMOOTH = 0.9;

static const int PART[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

struct plane {
    int32_t tag;
    int axis;
    double at, side; /* coordinate [mm]; the body is where side * (x - at) > 0 */
};

/* The boundary but the symmetry planes, as flat triangles. */
struct skin {
    const struct pm_mesh *m;
    ptrdiff_t nt, parts; /* triangles, of one face */
    int32_t *tri;        /* (nt x 3) */
    int32_t *tag;        /* of a triangle                      (nt) */
    int32_t *node_tag;   /* the largest of a node's faces, PM_FACE_SYM_Z: not on the skin (nn) */
    double *y;           /* positions                          (nn x 3) [mm] */
    double *normal;      /* of the nodes, unit                 (nn x 3) */
    double *facet;       /* of the triangles, unit             (nt x 3) */
    struct pm_boxes *boxes;
    struct plane plane[3];
    int nplanes;
};

static void skin_release(struct skin *s)
{
    pm_free(s->tri);
    pm_free(s->tag);
    pm_free(s->node_tag);
    pm_free(s->y);
    pm_free(s->normal);
    pm_free(s->facet);
    pm_boxes_free(s->boxes);
}

static void add_plane(struct skin *s, ptrdiff_t f)
{
    const struct pm_mesh *m = s->m;
    struct plane p = {.tag = m->tri_tag[f], .axis = PM_FACE_SYM_X - m->tri_tag[f]};
    for (int k = 0; k < s->nplanes; k++)
        if (s->plane[k].tag == p.tag)
            return;
    p.at = m->x[3 * (ptrdiff_t)m->tri[m->npf * f] + p.axis];
    double sum = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        sum += m->x[3 * a + p.axis] - p.at;
    p.side = sum < 0 ? -1 : 1;
    s->plane[s->nplanes++] = p;
}

static enum pm_status skin_new(const struct pm_mesh *m, struct skin *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct skin){.m = m, .parts = m->npf == 6 ? 4 : 1};
    PM_TRY(PM_NEW(s->tri, 3 * s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->tag, s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->facet, 3 * s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->node_tag, m->nn, err));
    PM_TRY(PM_NEW(s->y, 3 * m->nn, err));
    PM_TRY(PM_NEW(s->normal, 3 * m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        s->node_tag[a] = PM_FACE_SYM_Z;
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *node = m->tri + m->npf * f, tag = m->tri_tag[f];
        if (tag <= PM_FACE_SYM_X) {
            add_plane(s, f);
            continue;
        }
        for (ptrdiff_t k = 0; k < m->npf; k++)
            if (s->node_tag[node[k]] < tag)
                s->node_tag[node[k]] = tag;
        for (ptrdiff_t k = 0; k < s->parts; k++, s->nt++) {
            s->tag[s->nt] = tag;
            for (int v = 0; v < 3; v++)
                s->tri[3 * s->nt + v] = node[s->parts == 4 ? PART[k][v] : v];
        }
    }
done:
    return status;
}

static void scale_to_one(double *v)
{
    const double l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3 && l > 0; i++)
        v[i] /= l;
}

/* Positions x + u (u NULL: x), normals, boxes. */
static enum pm_status skin_place(struct skin *s, const double *u, struct pm_err *err)
{
    const ptrdiff_t nn = s->m->nn;
    for (ptrdiff_t i = 0; i < 3 * nn; i++)
        s->y[i] = s->m->x[i] + (u != NULL ? u[i] : 0);
    memset(s->normal, 0, 3 * (size_t)nn * sizeof *s->normal);
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        const int32_t *v = s->tri + 3 * t;
        const double *a = s->y + 3 * v[0], *b = s->y + 3 * v[1], *c = s->y + 3 * v[2];
        double *n = s->facet + 3 * t;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
        }
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                s->normal[3 * v[k] + i] += n[i];
        scale_to_one(n);
    }
    for (ptrdiff_t a = 0; a < nn; a++)
        scale_to_one(s->normal + 3 * a);
    pm_boxes_free(s->boxes);
    s->boxes = NULL;
    return pm_collide_boxes(s->y, s->nt, s->tri, &s->boxes, err);
}

/* What a node looks for. */
struct look {
    const struct skin *s;
    const double *x, *n;
    int32_t triangle;
};

static double look_at(void *data, int32_t t, double best)
{
    struct look *l = data;
    const int32_t *v = l->s->tri + 3 * (ptrdiff_t)t;
    const double *n = l->n, *m = l->s->facet + 3 * (ptrdiff_t)t, *y = l->s->y;
    double q[3], dn = 0, dm = 0;
    /* outside of both cones whatever the direction */
    if (n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 1 - 2 * COSINE * COSINE)
        return best;
    const double d = pm_collide_closest(l->x, y + 3 * v[0], y + 3 * v[1], y + 3 * v[2], q);
    for (int i = 0; i < 3; i++) {
        dn += (q[i] - l->x[i]) * n[i];
        dm -= (q[i] - l->x[i]) * m[i];
    }
    if (!(d > 0 && d < best && dn >= COSINE * d && dm >= COSINE * d))
        return best;
    l->triangle = t;
    return d;
}

/* The node faces the plane and its image beyond. */
static double mirror_gap(const struct plane *p, const double *x, const double *n)
{
    const double d = p->side * (x[p->axis] - p->at);
    return d > 0 && -p->side * n[p->axis] >= COSINE ? 2 * d : HUGE_VAL;
}

/* What node a sees along n, if nearer than c->gap. */
static void look_from(const struct skin *s, ptrdiff_t a, const double *n, struct pm_self_contact *c)
{
    struct look l = {.s = s, .x = s->y + 3 * a, .n = n, .triangle = -1};
    double best = pm_boxes_nearest(s->boxes, l.x, n, COSINE, c->gap, look_at, &l);
    int32_t other = l.triangle >= 0 ? s->tag[l.triangle] : 0;
    for (int k = 0; k < s->nplanes; k++)
        if (mirror_gap(&s->plane[k], l.x, n) < best) {
            best = mirror_gap(&s->plane[k], l.x, n);
            other = s->plane[k].tag;
        }
    if (best < c->gap) {
        c->gap = best;
        memcpy(c->at, l.x, sizeof c->at);
        c->surface[0] = s->node_tag[a];
        c->surface[1] = other;
    }
}

static void find_gap(const struct skin *s, struct pm_self_contact *c)
{
    c->gap = HUGE_VAL;
    for (ptrdiff_t a = 0; a < s->m->nn; a++)
        if (s->node_tag[a] != PM_FACE_SYM_Z)
            look_from(s, a, s->normal + 3 * a, c);
    for (ptrdiff_t t = 0; t < s->nt; t++)
        for (int k = 0; k < 3; k++) {
            const ptrdiff_t a = s->tri[3 * t + k];
            const double *n = s->normal + 3 * a, *m = s->facet + 3 * t;
            if (n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < SMOOTH)
                look_from(s, a, m, c);
        }
    c->gap = c->gap < HUGE_VAL ? c->gap : -1;
}

/* A face that reaches through a plane: further than rounding of a node that is held on it. */
static int beyond(const struct skin *s, const struct plane *p, ptrdiff_t t, double at[3])
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

static void find_mirrored(const struct skin *s, struct pm_self_contact *c)
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
    struct skin s;
    struct pm_contact pierced;

    *c = (struct pm_self_contact){.gap = -1};
    PM_TRY(skin_new(m, &s, err));
    PM_TRY(skin_place(&s, NULL, err));
    find_gap(&s, c);
    *c = (struct pm_self_contact){.gap_reference = c->gap};
    PM_TRY(skin_place(&s, u, err));
    PM_TRY(pm_collide_faces(s.boxes, s.y, s.nt, s.tri, s.parts, &pierced, err));
    if (pierced.pairs > 0) {
        c->intersections = pierced.pairs;
        memcpy(c->at, pierced.at, sizeof c->at);
        c->surface[0] = s.tag[pierced.a];
        c->surface[1] = s.tag[pierced.b];
    }
    find_mirrored(&s, c);
    if (c->intersections == 0)
        find_gap(&s, c);
done:
    skin_release(&s);
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
        pm_log(1,
               "smallest gap %.3g mm (undeformed %.3g mm), of %s and %s at (%.4g, %.4g, %.4g) mm",
               c->gap, c->gap_reference, first, second, c->at[0], c->at[1], c->at[2]);
}
