#include "tools/surfexport/refine.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"
#include "common/geometry/surface_map.h"

/* The longest edge of a triangle off the surface. */
struct split {
    int32_t low, high; /* its ends */
    int32_t middle;
};

struct refining {
    const struct pm_surface *s; /* borrowed */
    const struct pm_map *map;   /* borrowed */
    struct pm_basis work;
    struct pm_patch *p; /* borrowed */
    ptrdiff_t n;
    struct split *split; /* by their ends (n) */
};

static int by_ends(const void *a, const void *b)
{
    const struct split *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    return (p->high > q->high) - (p->high < q->high);
}

static struct split edge_of(int32_t a, int32_t b)
{
    return (struct split){.low = a < b ? a : b, .high = a < b ? b : a, .middle = -1};
}

/* Largest distance of the surface from triangle t. */
static enum pm_status measure(struct refining *f, ptrdiff_t t, double *off, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_patch *p = f->p;
    const int32_t type = f->s->type, *v = p->tri + 3 * t;
    double S[4][3], r[3], foot[3];
    for (int k = 0; k < 3; k++)
        pm_map_middle(type, p->S + 3 * (ptrdiff_t)v[k], p->S + 3 * (ptrdiff_t)v[(k + 1) % 3], S[k]);
    /* two thirds of the way from a corner to the middle of the other side, nearly */
    pm_map_middle(type, S[0], S[1], S[3]);
    pm_map_middle(type, S[3], S[2], S[3]);
    *off = 0;
    for (int k = 0; k < 4; k++) {
        PM_TRY(pm_map_point(f->map, f->s->phi, S[k], &f->work, r, NULL, NULL, err));
        *off =
            fmax(*off, pm_collide_closest(r, p->x + 3 * (ptrdiff_t)v[0], p->x + 3 * (ptrdiff_t)v[1],
                                          p->x + 3 * (ptrdiff_t)v[2], foot));
    }
done:
    return status;
}

static double length2(const struct pm_patch *p, int32_t a, int32_t b)
{
    double sum = 0;
    for (ptrdiff_t i = 0; i < 3; i++)
        sum += (p->x[3 * a + i] - p->x[3 * b + i]) * (p->x[3 * a + i] - p->x[3 * b + i]);
    return sum;
}

/* Triangles above the tolerance, by their longest edges; their largest error. */
static enum pm_status look(struct refining *f, double tolerance, double *error, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_patch *p = f->p;
    ptrdiff_t n = 0;
    *error = 0;
    PM_GROW(f->split, p->nt, err);
    for (ptrdiff_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->tri + 3 * t;
        double off;
        int longest = 0;
        PM_TRY(measure(f, t, &off, err));
        *error = fmax(*error, off);
        for (int k = 1; k < 3; k++)
            if (length2(p, v[k], v[(k + 1) % 3]) > length2(p, v[longest], v[(longest + 1) % 3]))
                longest = k;
        if (off > tolerance)
            f->split[n++] = edge_of(v[longest], v[(longest + 1) % 3]);
    }
    qsort(f->split, (size_t)n, sizeof *f->split, by_ends);
    f->n = 0;
    for (ptrdiff_t k = 0; k < n; k++)
        if (k == 0 || by_ends(&f->split[k - 1], &f->split[k]) != 0)
            f->split[f->n++] = f->split[k];
done:
    return status;
}

/* Nodes in the middle of the edges to split, and room for their triangles. */
static enum pm_status add_middles(struct refining *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_patch *p = f->p;
    PM_GROW(p->S, 3 * (p->nn + f->n), err);
    PM_GROW(p->x, 3 * (p->nn + f->n), err);
    PM_GROW(p->size, p->nn + f->n, err);
    PM_GROW(p->rim, p->nn + f->n, err);
    PM_GROW(p->tri, 12 * p->nt, err); /* a triangle becomes four at most */
    for (ptrdiff_t k = 0; k < f->n; k++) {
        const ptrdiff_t a = f->split[k].low, b = f->split[k].high, c = p->nn;
        pm_map_middle(f->s->type, p->S + 3 * a, p->S + 3 * b, p->S + 3 * c);
        p->rim[c] = p->rim[a] & p->rim[b];
        pm_rim_constrain(f->s->type, p->rim[c], p->S + 3 * c);
        p->size[c] = (p->size[a] + p->size[b]) / 2;
        PM_TRY(
            pm_map_point(f->map, f->s->phi, p->S + 3 * c, &f->work, p->x + 3 * c, NULL, NULL, err));
        f->split[k].middle = (int32_t)p->nn++;
    }
done:
    return status;
}

/* Triangle t by its split sides, the longest first. */
static void cut(struct refining *f, ptrdiff_t t)
{
    struct pm_patch *p = f->p;
    const int32_t v[3] = {p->tri[3 * t], p->tri[3 * t + 1], p->tri[3 * t + 2]};
    const struct split *side = NULL;
    int k = -1;
    for (int j = 0; j < 3; j++) {
        const struct split key = edge_of(v[j], v[(j + 1) % 3]);
        const struct split *found = bsearch(&key, f->split, (size_t)f->n, sizeof key, by_ends);
        if (found != NULL &&
            (k < 0 || length2(p, v[j], v[(j + 1) % 3]) > length2(p, v[k], v[(k + 1) % 3]))) {
            side = found;
            k = j;
        }
    }
    if (side == NULL)
        return;
    const ptrdiff_t half[2] = {t, p->nt++};
    for (int j = 0; j < 2; j++) {
        int32_t *w = p->tri + 3 * half[j];
        w[0] = j == 0 ? v[k] : side->middle;
        w[1] = j == 0 ? side->middle : v[(k + 1) % 3];
        w[2] = v[(k + 2) % 3];
    }
    cut(f, half[0]);
    cut(f, half[1]);
}

enum pm_status patch_refine(const struct pm_surface *s, const struct pm_map *map, double tolerance,
                            int rounds, struct pm_patch *p, double *error, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct refining f = {.s = s, .map = map, .p = p};
    PM_TRY(look(&f, tolerance, error, err));
    for (int round = 0; round < rounds && f.n > 0; round++) {
        const ptrdiff_t nt = p->nt;
        PM_TRY(add_middles(&f, err));
        for (ptrdiff_t t = 0; t < nt; t++)
            cut(&f, t);
        PM_TRY(look(&f, tolerance, error, err));
    }
done:
    pm_free(f.split);
    pm_basis_release(&f.work);
    return status;
}
