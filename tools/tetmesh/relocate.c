#include "tools/tetmesh/relocate.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/tetmesh/quality.h"

enum { SWEEPS = 12, HALVINGS = 5 };
static const double FIRST = 0.2; /* step in parts of the edges around */

struct star {
    struct pm_mesh *m;
    const struct pm_relocate_opts *o;
    uint8_t *fixed;   /* bit i: coordinate i stays (nn) */
    ptrdiff_t *ptr;   /* elements around a node (nn + 1) */
    int32_t *element; /* (10 ne) */
};

static void release(struct star *s)
{
    pm_free(s->fixed);
    pm_free(s->ptr);
    pm_free(s->element);
}

static enum pm_status init(struct star *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_mesh *m = s->m;
    ptrdiff_t *next = NULL;
    PM_TRY(PM_NEW(s->fixed, m->nn, err));
    PM_TRY(PM_NEW(s->ptr, m->nn + 1, err));
    PM_TRY(PM_NEW(s->element, 10 * m->ne, err));
    PM_TRY(PM_NEW(next, m->nn, err));
    for (ptrdiff_t k = 0; k < 6 * m->nf; k++) {
        const int32_t tag = m->tri_tag[k / 6];
        s->fixed[m->tri[k]] |= (uint8_t)(tag <= PM_FACE_SYM_X ? 1 << (PM_FACE_SYM_X - tag) : 7);
    }
    for (int j = 0; j < 2; j++)
        for (ptrdiff_t a = 0; a < m->nn && s->o->image[j] != NULL; a++)
            if (s->o->image[j][a] == a)
                s->fixed[a] |= (uint8_t)(1 << j);
    for (ptrdiff_t k = 0; k < 10 * m->ne; k++)
        s->ptr[m->tet[k] + 1]++;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        s->ptr[a + 1] += s->ptr[a];
        next[a] = s->ptr[a];
    }
    for (ptrdiff_t k = 0; k < 10 * m->ne; k++)
        s->element[next[m->tet[k]]++] = (int32_t)(k / 10);
done:
    pm_free(next);
    return status;
}

/* 1 at the bounds; where the element is inverted at most 0, by its smallest Jacobian, less what its
 * vertices lack in mean ratio: they shall not get flat for curved edges. */
static double quality(const struct star *s, ptrdiff_t e)
{
    double X[30], b[20], low = INFINITY, edges = 0;
    pm_quality_gather(s->m, s->m->x, e, X);
    pm_quality_bernstein(X, b);
    for (int k = 0; k < 20; k++)
        low = fmin(low, b[k]);
    const double ratio = pm_quality_mean_ratio(X) / s->o->mean_ratio;
    if (low > 0)
        return fmin(pm_quality_scaled(X) / s->o->scaled, ratio);
    for (int a = 0; a < 4; a++)
        for (int i = 0; i < 3 * a; i++)
            edges += (X[3 * a + i % 3] - X[i]) * (X[3 * a + i % 3] - X[i]);
    return low / pow(edges / 6, 1.5) + fmin(ratio, 1) - 1;
}

static double worst_around(const struct star *s, ptrdiff_t a)
{
    double worst = INFINITY;
    for (ptrdiff_t k = s->ptr[a]; k < s->ptr[a + 1]; k++)
        worst = fmin(worst, quality(s, s->element[k]));
    return worst;
}

static void add(const struct star *s, ptrdiff_t a, int axis, double d)
{
    if (!(s->fixed[a] >> axis & 1))
        s->m->x[3 * a + axis] += d;
}

/* Node a by d along an axis, a vertex with the middles of its edges by half of that. */
static void shift_one(const struct star *s, ptrdiff_t a, int axis, double d)
{
    static const int middle[4][3] = {{4, 6, 7}, {4, 5, 9}, {5, 6, 8}, {7, 8, 9}};
    add(s, a, axis, d);
    for (ptrdiff_t k = s->ptr[a]; k < s->ptr[a + 1]; k++) {
        const int32_t *v = s->m->tet + 10 * (ptrdiff_t)s->element[k];
        int corner = 0;
        while (corner < 4 && v[corner] != a)
            corner++;
        for (int j = 0; j < 3 && corner < 4; j++) {
            const int32_t b = v[middle[corner][j]];
            int first = 1; /* the edge's first element around a */
            for (ptrdiff_t l = s->ptr[b]; l < s->ptr[b + 1] && s->element[l] < s->element[k]; l++)
                first = 0;
            if (first)
                add(s, b, axis, d / 2);
        }
    }
}

/* Image g of node a: bit j for the mirror at x_j = 0; -1: there is none, or it is another one's. */
static ptrdiff_t image_of(const struct star *s, ptrdiff_t a, unsigned g)
{
    for (unsigned j = 0; j < 2; j++)
        if (g >> j & 1) {
            if (s->o->image[j] == NULL || s->o->image[j][a] == a)
                return -1;
            a = s->o->image[j][a];
        }
    return a;
}

static void shift(const struct star *s, ptrdiff_t a, int axis, double d)
{
    for (unsigned g = 0; g < 4; g++) {
        const ptrdiff_t b = image_of(s, a, g);
        if (b >= 0)
            shift_one(s, b, axis, axis < 2 && g >> axis & 1 ? -d : d);
    }
}

/* The first of its images moves them all. */
static int leads(const struct star *s, ptrdiff_t a)
{
    for (unsigned g = 1; g < 4; g++) {
        const ptrdiff_t b = image_of(s, a, g);
        if (b >= 0 && b < a)
            return 0;
    }
    return 1;
}

static double mean_edge(const struct star *s, ptrdiff_t a)
{
    double sum = 0;
    for (ptrdiff_t k = s->ptr[a]; k < s->ptr[a + 1]; k++) {
        double X[30];
        pm_quality_gather(s->m, s->m->x, s->element[k], X);
        for (int i = 0; i < 3; i++)
            sum += (X[3 + i] - X[i]) * (X[3 + i] - X[i]) +
                   (X[9 + i] - X[6 + i]) * (X[9 + i] - X[6 + i]);
    }
    return sqrt(sum / (double)(2 * (s->ptr[a + 1] - s->ptr[a])));
}

/* Steps along the axes while the worst element around a gets better. */
static void improve(const struct star *s, ptrdiff_t a)
{
    double now = worst_around(s, a), step = FIRST * mean_edge(s, a);
    for (int half = 0; half < HALVINGS && now < 1.5; half++, step /= 2) {
        for (int way = 0; way < 6; way++) {
            const double d = way % 2 ? -step : step;
            if (s->fixed[a] >> way / 2 & 1)
                continue;
            shift(s, a, way / 2, d);
            const double then = worst_around(s, a);
            if (then > now)
                now = then;
            else
                shift(s, a, way / 2, -d);
        }
    }
}

enum pm_status pm_relocate(const struct pm_relocate_opts *o, struct pm_mesh *m, ptrdiff_t *left,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct star s = {.m = m, .o = o};
    uint8_t *todo = NULL;
    PM_TRY(init(&s, err));
    PM_TRY(PM_NEW(todo, m->nn, err));
    *left = 1;
    for (int sweep = 0; sweep <= SWEEPS && *left > 0; sweep++) {
        *left = 0;
        memset(todo, 0, (size_t)m->nn);
        for (ptrdiff_t e = 0; e < m->ne; e++)
            if (quality(&s, e) < 1) {
                ++*left;
                for (int k = 0; k < 10; k++)
                    todo[m->tet[10 * e + k]] = s.fixed[m->tet[10 * e + k]] != 7;
            }
        for (ptrdiff_t a = 0; a < m->nn && sweep < SWEEPS; a++)
            if (todo[a] && leads(&s, a))
                improve(&s, a);
    }
done:
    release(&s);
    pm_free(todo);
    return status;
}
