#include "tools/tetmesh/mirror.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/symmetry.h"

/* Control points may be off their images by this part of the body's height: rounding. */
static const double defect_limit = 1e-9;

void pm_mirrors_find(const struct pm_surfaces *s, struct pm_mirrors *y)
{
    const struct pm_symmetry *group = &s->pcase.symmetry;
    *y = (struct pm_mirrors){0};
    for (ptrdiff_t g = 0; g < group->nops; g++) {
        const double *Q = group->Q[g];
        for (int j = 0; j < 2; j++) {
            if (Q[4 * j] != -1 || Q[4 * (1 - j)] != 1 || Q[8] != 1)
                continue;
            y->planes |= 1u << j;
            y->own |= 1u << j;
            y->op[j] = g;
            for (ptrdiff_t r = 0; r < s->ns - 1; r++)
                if (group->chamber[g][r] != r)
                    y->own &= ~(1u << j);
        }
    }
}

enum pm_status pm_mirrors_check(const struct pm_surfaces *s, const struct pm_mirrors *y,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *phi = NULL;
    if (y->planes == 0)
        return PM_OK;
    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    pm_surfaces_gather(s, phi);
    const double defect = pm_symmetry_defect(s, phi), limit = defect_limit * s->pcase.height;
    if (!(defect <= limit))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "control points are up to %.3g mm off their images under the symmetry of "
                       "the case, expected %.1g mm at most",
                       defect, limit));
done:
    pm_free(phi);
    return status;
}

unsigned pm_mirrors_cut(const struct pm_mirrors *y, const struct pm_surfaces *s, ptrdiff_t k,
                        int *kept)
{
    const struct pm_surface *f = &s->s[k];
    unsigned cut = 0;
    *kept = 1;
    for (int j = 0; j < 2; j++) {
        if (!(y->planes >> j & 1))
            continue;
        double sum = 0;
        for (ptrdiff_t i = 0; i < f->n; i++)
            sum += f->phi[3 * i + j];
        if (k == 0 || s->pcase.symmetry.chamber[y->op[j]][k - 1] == k - 1)
            cut |= 1u << j;
        else if (sum < 0)
            *kept = 0;
    }
    return cut;
}

unsigned pm_mirrors_of(const struct pm_mesh *m)
{
    unsigned planes = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        if (m->tri_tag[f] <= PM_FACE_SYM_X)
            planes |= 1u << (PM_FACE_SYM_X - m->tri_tag[f]);
    return planes;
}

/* ---- reflection ---- */

/* An odd exchange of corners, with the mid-side nodes in the order of mesh.h. */
static const int turned_tet[10] = {1, 0, 2, 3, 4, 6, 5, 9, 8, 7};
static const int turned_tri[6] = {1, 0, 2, 3, 5, 4};

struct reflection {
    const struct pm_surfaces *s;
    struct pm_mesh *m;
    int axis;
    ptrdiff_t g;    /* operation */
    ptrdiff_t nn;   /* nodes before */
    int32_t *image; /* of each of them (nn before) */
};

static int32_t surface_image(const struct reflection *r, int32_t k)
{
    return k > 0 ? (int32_t)(r->s->pcase.symmetry.chamber[r->g][k - 1] + 1) : k;
}

static enum pm_status find_images(struct reflection *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = r->m;
    r->nn = m->nn;
    PM_TRY(PM_NEW(r->image, m->nn, err));
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (ptrdiff_t k = 0; k < m->npf && m->tri_tag[f] == PM_FACE_SYM_X - r->axis; k++)
            r->image[m->tri[m->npf * f + k]] = -1;
    for (ptrdiff_t a = 0; a < r->nn; a++)
        r->image[a] = (int32_t)(r->image[a] < 0 ? a : m->nn++);
done:
    return status;
}

static void flip_points(const struct reflection *r, double *x)
{
    for (ptrdiff_t a = 0; a < r->nn; a++)
        for (int i = 0; i < 3 && r->image[a] != a; i++)
            x[3 * r->image[a] + i] = i == r->axis ? 0 - x[3 * a + i] : x[3 * a + i];
}

static enum pm_status reflect_nodes(struct reflection *r, struct pm_err *err)
{
    struct pm_mesh *m = r->m;
    PM_GROW(m->x, 3 * m->nn, err);
    PM_GROW(m->x_generated, 3 * m->nn, err);
    PM_GROW(m->S, 3 * m->nn, err);
    PM_GROW(m->surface, m->nn, err);
    flip_points(r, m->x);
    flip_points(r, m->x_generated);
    flip_points(r, m->S);
    for (ptrdiff_t a = 0; a < r->nn; a++)
        m->surface[r->image[a]] = surface_image(r, m->surface[a]);
    return PM_OK;
}

struct weight {
    int32_t col;
    double val;
};

static int by_column(const void *a, const void *b)
{
    const struct weight *p = a, *q = b;
    return (p->col > q->col) - (p->col < q->col);
}

/* Rows of the images follow in the order of their nodes: weights of the images of control points,
 * columns ascending. */
static enum pm_status reflect_weights(struct reflection *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = r->m;
    const int32_t *perm = r->s->perm + r->g * m->N;
    struct weight *row = NULL;
    int64_t n = m->nw;
    PM_GROW(m->wptr, m->nn + 1, err);
    PM_GROW(m->wcol, 2 * m->nw, err);
    PM_GROW(m->wval, 2 * m->nw, err);
    PM_TRY(PM_NEW(row, m->N, err));
    for (ptrdiff_t a = 0; a < r->nn; a++) {
        const int64_t first = m->wptr[a], count = m->wptr[a + 1] - first;
        if (r->image[a] == a)
            continue;
        for (int64_t k = 0; k < count; k++)
            row[k] = (struct weight){perm[m->wcol[first + k]], m->wval[first + k]};
        qsort(row, (size_t)count, sizeof *row, by_column);
        for (int64_t k = 0; k < count; k++, n++) {
            m->wcol[n] = row[k].col;
            m->wval[n] = row[k].val;
        }
        m->wptr[r->image[a] + 1] = n;
    }
    m->nw = (ptrdiff_t)n;
done:
    pm_free(row);
    return status;
}

static enum pm_status reflect_elements(struct reflection *r, struct pm_err *err)
{
    struct pm_mesh *m = r->m;
    PM_GROW(m->tet, 2 * m->npe * m->ne, err);
    for (ptrdiff_t e = 0; e < m->ne; e++)
        for (int k = 0; k < m->npe; k++)
            m->tet[m->npe * (m->ne + e) + k] = r->image[m->tet[m->npe * e + turned_tet[k]]];
    m->ne *= 2;
    return PM_OK;
}

/* Faces on the plane are no more. */
static enum pm_status reflect_faces(struct reflection *r, struct pm_err *err)
{
    struct pm_mesh *m = r->m;
    const ptrdiff_t npf = m->npf;
    ptrdiff_t n = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        if (m->tri_tag[f] == PM_FACE_SYM_X - r->axis)
            continue;
        memmove(m->tri + npf * n, m->tri + npf * f, (size_t)npf * sizeof *m->tri);
        m->tri_tag[n++] = m->tri_tag[f];
    }
    PM_GROW(m->tri, 2 * npf * n, err);
    PM_GROW(m->tri_tag, 2 * n, err);
    for (ptrdiff_t f = 0; f < n; f++) {
        m->tri_tag[n + f] = surface_image(r, m->tri_tag[f]);
        for (int k = 0; k < npf; k++)
            m->tri[npf * (n + f) + k] = r->image[m->tri[npf * f + turned_tri[k]]];
    }
    m->nf = 2 * n;
    return PM_OK;
}

enum pm_status pm_mesh_reflect(const struct pm_surfaces *s, const struct pm_mirrors *y, int axis,
                               struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct reflection r = {.s = s, .m = m, .axis = axis, .g = y->op[axis]};
    PM_TRY(find_images(&r, err));
    PM_TRY(reflect_nodes(&r, err));
    PM_TRY(reflect_weights(&r, err));
    PM_TRY(reflect_elements(&r, err));
    PM_TRY(reflect_faces(&r, err));
done:
    pm_free(r.image);
    return status;
}

static int is_image(const struct pm_mesh *m, int axis, ptrdiff_t a, ptrdiff_t b)
{
    double off = 0, size = 1;
    for (int i = 0; i < 3; i++) {
        off = fmax(off, fabs(m->x[3 * a + i] - (i == axis ? -1 : 1) * m->x[3 * b + i]));
        size = fmax(size, fabs(m->x[3 * a + i]));
    }
    return off < 1e-6 * size;
}

enum pm_status pm_mesh_images(const struct pm_mesh *m, unsigned planes, int32_t *image[2],
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t half = m->ne;
    image[0] = image[1] = NULL;
    for (int axis = 1; axis >= 0; axis--) { /* the last completion is the outermost */
        if (!(planes >> axis & 1))
            continue;
        int good = half % 2 == 0;
        half /= 2;
        PM_TRY(PM_NEW(image[axis], m->nn, err));
        for (ptrdiff_t first = 0; first + 2 * half <= m->ne && half > 0; first += 2 * half)
            for (ptrdiff_t e = first; e < first + half; e++)
                for (int k = 0; k < m->npe; k++) {
                    const int32_t a = m->tet[m->npe * e + turned_tet[k]],
                                  b = m->tet[m->npe * (e + half) + k];
                    image[axis][a] = b;
                    image[axis][b] = a;
                    good &= is_image(m, axis, a, b);
                }
        if (!good)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "the previous mesh is not its own image at the plane %c = 0",
                           "xy"[axis]));
    }
done:
    return status;
}
