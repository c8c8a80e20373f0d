#include "common/geometry/skin.h"

#include <math.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"

static const int PART[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

void pm_skin_release(struct pm_skin *s)
{
    pm_free(s->tri);
    pm_free(s->tag);
    pm_free(s->y);
    pm_free(s->facet);
    pm_boxes_free(s->boxes);
}

static void add_plane(struct pm_skin *s, ptrdiff_t f)
{
    const struct pm_mesh *m = s->m;
    struct pm_skin_plane p = {.tag = m->tri_tag[f], .axis = PM_FACE_SYM_X - m->tri_tag[f]};
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

static enum pm_status cut(const struct pm_mesh *m, struct pm_skin *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_skin){.m = m, .parts = m->npf == 6 ? 4 : 1};
    PM_TRY(PM_NEW(s->tri, 3 * s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->tag, s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->facet, 3 * s->parts * m->nf, err));
    PM_TRY(PM_NEW(s->y, 3 * m->nn, err));
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *node = m->tri + m->npf * f, tag = m->tri_tag[f];
        if (tag <= PM_FACE_SYM_X) {
            add_plane(s, f);
            continue;
        }
        for (ptrdiff_t k = 0; k < s->parts; k++, s->nt++) {
            s->tag[s->nt] = tag;
            for (int v = 0; v < 3; v++)
                s->tri[3 * s->nt + v] = node[s->parts == 4 ? PART[k][v] : v];
        }
    }
done:
    return status;
}

/* Positions x + u, normals, boxes. */
static enum pm_status place(struct pm_skin *s, const double *u, struct pm_err *err)
{
    for (ptrdiff_t i = 0; i < 3 * s->m->nn; i++)
        s->y[i] = s->m->x[i] + u[i];
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        const int32_t *v = s->tri + 3 * t;
        const double *a = s->y + 3 * v[0], *b = s->y + 3 * v[1], *c = s->y + 3 * v[2];
        double *n = s->facet + 3 * t;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
        }
        const double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int i = 0; i < 3 && l > 0; i++)
            n[i] /= l;
    }
    return pm_collide_boxes(s->y, s->nt, s->tri, s->facet, &s->boxes, err);
}

enum pm_status pm_skin_new(const struct pm_mesh *m, const double *u, struct pm_skin *s,
                           struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(cut(m, s, err));
    PM_TRY(place(s, u, err));
done:
    return status;
}
