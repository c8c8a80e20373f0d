#include "tools/surfremesh/spacing.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/geometry/surface_map.h"

static double distance(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Heron's formula, safe against rounding of flat triangles. */
static double area_of(double a, double b, double c)
{
    double h = (a + b + c) / 2;

    return sqrt(fmax(0, h * (h - a) * (h - b) * (h - c)));
}

static double anisotropy(const double r_a[6])
{
    double g[3] = {0}, trace, root;

    for (int j = 0; j < 3; j++) {
        g[0] += r_a[j] * r_a[j];
        g[1] += r_a[j] * r_a[3 + j];
        g[2] += r_a[3 + j] * r_a[3 + j];
    }
    trace = g[0] + g[2];
    root = hypot(g[0] - g[2], 2 * g[1]);
    return trace > root ? sqrt((trace + root) / (trace - root)) : (double)INFINITY;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double variation(ptrdiff_t n, const double *l)
{
    double mean = 0, square = 0;

    for (ptrdiff_t i = 0; i < n; i++)
        mean += l[i] / (double)n;
    for (ptrdiff_t i = 0; i < n; i++)
        square += (l[i] - mean) * (l[i] - mean) / (double)n;
    return sqrt(square) / mean;
}

/* near (n): distance to the nearest neighbour in the triangulation. */
static enum pm_status edges(const struct pm_surface *s, const double *x, double *near,
                            struct pm_spacing *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *length = NULL;

    PM_TRY(PM_NEW(length, 3 * s->nt, err));
    for (ptrdiff_t i = 0; i < s->n; i++)
        near[i] = INFINITY;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double *l = &length[3 * t];
        for (int j = 0; j < 3; j++) {
            ptrdiff_t a = s->tri[3 * t + j], b = s->tri[3 * t + (j + 1) % 3];
            l[j] = distance(&x[3 * a], &x[3 * b]);
            near[a] = fmin(near[a], l[j]);
            near[b] = fmin(near[b], l[j]);
            out->mean += l[j] / (3 * (double)s->nt);
            out->longest = fmax(out->longest, l[j]);
        }
        out->area += area_of(l[0], l[1], l[2]);
    }
    out->longest /= out->mean;
    out->cv = variation(3 * s->nt, length);
done:
    pm_free(length);
    return status;
}

enum pm_status pm_spacing_of(const struct pm_surface *s, struct pm_spacing *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *x = NULL, *ratio = NULL, *near = NULL;

    *out = (struct pm_spacing){0};
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(x, 3 * s->n, err));
    PM_TRY(PM_NEW(ratio, s->n, err));
    PM_TRY(PM_NEW(near, s->n, err));
    for (ptrdiff_t i = 0; i < s->n; i++) {
        double r_a[6];
        PM_TRY(pm_map_point(map, s->phi, &s->Phi[3 * i], &work, &x[3 * i], r_a, NULL, err));
        ratio[i] = anisotropy(r_a);
    }
    PM_TRY(edges(s, x, near, out, err));
    out->near_cv = variation(s->n, near);
    qsort(ratio, (size_t)s->n, sizeof *ratio, ascending);
    out->median = ratio[s->n / 2];
    out->most = ratio[s->n * 95 / 100];
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    pm_free(ratio);
    pm_free(near);
    return status;
}
