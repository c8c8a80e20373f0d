/* Close pairs of samples by a cell grid. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/samples.h"

static const double TWO_PI = 6.283185307179586476925;

struct grid {
    double lo[3], cell;
    ptrdiff_t dim[3], *start; /* samples of cell k are list[start[k]..start[k+1]-1], ascending */
    int32_t *list;
};

static ptrdiff_t place(const struct grid *g, double x, int axis)
{
    return (ptrdiff_t)((x - g->lo[axis]) / g->cell);
}

static ptrdiff_t cell_of(const struct grid *g, const double *x)
{
    return (place(g, x[0], 0) * g->dim[1] + place(g, x[1], 1)) * g->dim[2] + place(g, x[2], 2);
}

static enum pm_status grid_new(ptrdiff_t n, const double *x, double cutoff, struct grid *g,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double hi[3];
    ptrdiff_t cells;

    memset(g, 0, sizeof *g);
    g->cell = cutoff;
    for (int j = 0; j < 3; j++) {
        g->lo[j] = INFINITY;
        hi[j] = -INFINITY;
        for (ptrdiff_t i = 0; i < n; i++) {
            g->lo[j] = fmin(g->lo[j], x[3 * i + j]);
            hi[j] = fmax(hi[j], x[3 * i + j]);
        }
        if (hi[j] - g->lo[j] > 127 * g->cell) /* bounds the grid whatever the points are */
            g->cell = (hi[j] - g->lo[j]) / 127;
    }
    if (!(g->cell > 0 && isfinite(g->cell)))
        return pm_fail(err, PM_NUMERIC, "surfaces have no finite extent");
    for (int j = 0; j < 3; j++)
        g->dim[j] = n > 0 ? place(g, hi[j], j) + 1 : 1;
    cells = g->dim[0] * g->dim[1] * g->dim[2];
    PM_TRY(PM_NEW(g->start, cells + 2, err));
    PM_TRY(PM_NEW(g->list, n, err));
    for (ptrdiff_t i = 0; i < n; i++)
        g->start[cell_of(g, &x[3 * i]) + 2]++;
    for (ptrdiff_t k = 0; k < cells; k++)
        g->start[k + 2] += g->start[k + 1];
    for (ptrdiff_t i = 0; i < n; i++)
        g->list[g->start[cell_of(g, &x[3 * i]) + 1]++] = (int32_t)i;
done:
    return status;
}

static double length(const double *metric, double a, double b)
{
    return sqrt(metric[0] * a * a + 2 * metric[1] * a * b + metric[2] * b * b);
}

/* Estimate of the distance along the surface, never much too small. */
static double along(const struct pm_samples *m, ptrdiff_t i, ptrdiff_t j, int tube)
{
    const double *S = &m->S[3 * i], *R = &m->S[3 * j], *g = &m->metric[3 * i],
                 *h = &m->metric[3 * j];
    double d[3] = {R[0] - S[0], R[1] - S[1], R[2] - S[2]}, chord;

    if (tube) {
        double turn = atan2(R[1], R[0]) - atan2(S[1], S[0]);
        turn -= TWO_PI * round(turn / TWO_PI);
        return fmax(length(g, turn, d[2]), length(h, turn, d[2]));
    }
    chord = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return chord * sqrt(sqrt(fmax(g[0] * g[2] - g[1] * g[1], h[0] * h[2] - h[1] * h[1])));
}

struct found {
    struct pm_pair *pair;
    ptrdiff_t n, capacity;
};

static enum pm_status push(struct found *f, ptrdiff_t i, ptrdiff_t j, double distance,
                           struct pm_err *err)
{
    if (f->n == f->capacity) {
        ptrdiff_t more = 2 * f->capacity + 1024;
        struct pm_pair *p = pm_realloc(f->pair, more, sizeof *p, err);
        if (p == NULL)
            return PM_SYSTEM;
        f->pair = p;
        f->capacity = more;
    }
    f->pair[f->n++] = (struct pm_pair){(int32_t)i, (int32_t)j, distance};
    return PM_OK;
}

struct search {
    const struct pm_samples *m;
    const double *x;
    double cutoff, geodesic;
    ptrdiff_t tube_end; /* samples below are of the exterior */
};

static int within(const struct search *q, ptrdiff_t i, ptrdiff_t j, double *distance)
{
    const double *a = &q->x[3 * i], *b = &q->x[3 * j];
    const double d2 = (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                      (a[2] - b[2]) * (a[2] - b[2]);

    *distance = sqrt(d2);
    return d2 < q->cutoff * q->cutoff;
}

static int apart(const struct search *q, ptrdiff_t i, ptrdiff_t j)
{
    return q->m->surface[i] != q->m->surface[j] ||
           (q->geodesic != HUGE_VAL && along(q->m, i, j, i < q->tube_end) > q->geodesic);
}

static int close_pair(const struct search *q, ptrdiff_t i, ptrdiff_t j, double *distance)
{
    return within(q, i, j, distance) && apart(q, i, j);
}

static enum pm_status search_cell(const struct search *q, const struct grid *g, ptrdiff_t i,
                                  ptrdiff_t cell, struct found *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double distance;

    for (ptrdiff_t k = g->start[cell]; status == PM_OK && k < g->start[cell + 1]; k++) {
        ptrdiff_t j = g->list[k];
        if (j > i && close_pair(q, i, j, &distance))
            status = push(f, i, j, distance, err);
    }
    return status;
}

static int by_j(const void *a, const void *b)
{
    const struct pm_pair *p = a, *q = b;
    return (p->j > q->j) - (p->j < q->j);
}

static enum pm_status search_around(const struct search *q, const struct grid *g, ptrdiff_t i,
                                    struct found *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t at[3], first = f->n;

    for (int j = 0; j < 3; j++)
        at[j] = place(g, q->x[3 * i + j], j);
    for (ptrdiff_t a = at[0] > 0 ? at[0] - 1 : 0; a <= at[0] + 1 && a < g->dim[0]; a++)
        for (ptrdiff_t b = at[1] > 0 ? at[1] - 1 : 0; b <= at[1] + 1 && b < g->dim[1]; b++)
            for (ptrdiff_t c = at[2] > 0 ? at[2] - 1 : 0; c <= at[2] + 1 && c < g->dim[2]; c++)
                PM_TRY(search_cell(q, g, i, (a * g->dim[1] + b) * g->dim[2] + c, f, err));
    if (f->n > first)
        qsort(f->pair + first, (size_t)(f->n - first), sizeof *f->pair, by_j);
done:
    return status;
}

enum pm_status pm_samples_pairs(const struct pm_samples *samples, const double *x, double cutoff,
                                double geodesic, struct pm_pair **pairs, ptrdiff_t *n,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct grid g = {0};
    struct found f = {0};
    struct search q = {samples, x, cutoff, geodesic, samples->first[1]};

    *pairs = NULL;
    PM_TRY(grid_new(samples->n, x, cutoff, &g, err));
    for (ptrdiff_t i = 0; i < samples->n; i++)
        PM_TRY(search_around(&q, &g, i, &f, err));
    *pairs = f.pair;
    *n = f.n;
    f.pair = NULL;
done:
    pm_free(f.pair);
    pm_free(g.start);
    pm_free(g.list);
    return status;
}

/* The best of one sample: slots 0 .. ns - 1 by surface, behind them inside and outside. */
enum { SLOTS = PM_MAX_CHAMBERS + 3 };

static double across(const double *normal, const double *from, const double *to)
{
    return normal[0] * (to[0] - from[0]) + normal[1] * (to[1] - from[1]) +
           normal[2] * (to[2] - from[2]);
}

/* Within 60 degrees of the normals at both ends: -1 where the two do not face each other. */
static int32_t facing(const struct search *q, const double *normal, ptrdiff_t i, ptrdiff_t j,
                      double distance)
{
    const double *a = &q->x[3 * i], *b = &q->x[3 * j];
    if (q->m->surface[i] != q->m->surface[j])
        return q->m->surface[j];
    const double leave = across(&normal[3 * i], a, b), enter = across(&normal[3 * j], b, a);
    if (fmin(leave, enter) > distance / 2)
        return SLOTS + PM_NEAR_OUTSIDE;
    return fmax(leave, enter) < -distance / 2 ? SLOTS + PM_NEAR_INSIDE : -1;
}

static void best_in_cell(const struct search *q, const struct grid *g, const double *normal,
                         ptrdiff_t i, ptrdiff_t cell, struct pm_pair best[SLOTS])
{
    double distance;

    for (ptrdiff_t k = g->start[cell]; k < g->start[cell + 1]; k++) {
        const ptrdiff_t j = g->list[k];
        if (j == i || !within(q, i, j, &distance))
            continue;
        const int32_t slot = facing(q, normal, i, j, distance);
        if (slot >= 0 && distance < best[slot].distance && apart(q, i, j))
            best[slot] = (struct pm_pair){(int32_t)i, (int32_t)j, distance};
    }
}

static void best_around(const struct search *q, const struct grid *g, const double *normal,
                        ptrdiff_t i, struct pm_pair best[SLOTS])
{
    ptrdiff_t lo[3], hi[3];

    for (int j = 0; j < 3; j++) {
        const ptrdiff_t at = place(g, q->x[3 * i + j], j);
        lo[j] = at > 0 ? at - 1 : 0;
        hi[j] = at + 1 < g->dim[j] ? at + 1 : at;
    }
    for (int k = 0; k < SLOTS; k++)
        best[k].distance = HUGE_VAL;
    for (ptrdiff_t a = lo[0]; a <= hi[0]; a++)
        for (ptrdiff_t b = lo[1]; b <= hi[1]; b++)
            for (ptrdiff_t c = lo[2]; c <= hi[2]; c++)
                best_in_cell(q, g, normal, i, (a * g->dim[1] + b) * g->dim[2] + c, best);
}

static enum pm_status push_near(struct pm_near **near, ptrdiff_t *n, ptrdiff_t *capacity,
                                const struct pm_pair best[SLOTS], struct pm_err *err)
{
    if (*n + SLOTS > *capacity) {
        const ptrdiff_t more = 2 * *capacity + 1024;
        struct pm_near *p = pm_realloc(*near, more, sizeof *p, err);
        if (p == NULL)
            return PM_SYSTEM;
        *near = p;
        *capacity = more;
    }
    for (int32_t k = 0; k < SLOTS; k++)
        if (best[k].distance != HUGE_VAL)
            (*near)[(*n)++] = (struct pm_near){
                best[k].i, best[k].j, k > PM_MAX_CHAMBERS ? k - SLOTS : k, best[k].distance};
    return PM_OK;
}

enum pm_status pm_samples_near(const struct pm_samples *samples, const double *x,
                               const double *normal, const unsigned char *from, double cutoff,
                               double geodesic, struct pm_near **near, ptrdiff_t *n,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct grid g = {0};
    struct search q = {samples, x, cutoff, geodesic, samples->first[1]};
    struct pm_pair best[SLOTS];
    ptrdiff_t capacity = 0;

    *near = NULL;
    *n = 0;
    PM_TRY(grid_new(samples->n, x, cutoff, &g, err));
    for (ptrdiff_t i = 0; i < samples->n; i++) {
        if (!from[i])
            continue;
        best_around(&q, &g, normal, i, best);
        PM_TRY(push_near(near, n, &capacity, best, err));
    }
done:
    if (status != PM_OK) {
        pm_free(*near);
        *near = NULL;
    }
    pm_free(g.start);
    pm_free(g.list);
    return status;
}
