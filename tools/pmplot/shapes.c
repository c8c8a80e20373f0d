#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/surface_map.h"
#include "tools/pmplot/pmplot.h"

/* Points of surface k at the parameters of its control points, and its triangles; the tube gets a
 * fan over each planar rim, so that every surface is closed. */
struct shape {
    ptrdiff_t n, nt;
    double *x;    /* (n x 3) [mm] */
    int32_t *tri; /* (nt x 3) */
};

static void shape_release(struct shape *h)
{
    pm_free(h->x);
    pm_free(h->tri);
    *h = (struct shape){0};
}

static void add_fans(const struct pm_surface *s, struct shape *h)
{
    for (int end = 0; end < 2; end++) {
        const ptrdiff_t row = end == 0 ? 0 : s->nu * (s->nv - 1), centre = h->n++;
        for (ptrdiff_t a = 0; a < s->nu; a++) {
            const int32_t i = (int32_t)(row + a), j = (int32_t)(row + (a + 1) % s->nu);
            const int32_t fan[3] = {(int32_t)centre, end == 0 ? j : i, end == 0 ? i : j};
            memcpy(h->tri + 3 * h->nt++, fan, sizeof fan);
            for (int k = 0; k < 3; k++)
                h->x[3 * centre + k] += h->x[3 * i + k] / (double)s->nu;
        }
    }
}

static enum pm_status make_shape(const struct pm_surface *s, struct shape *h, struct pm_err *err)
{
    enum pm_status status;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};

    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(h->x, 3 * (s->n + 2), err));
    PM_TRY(PM_NEW(h->tri, 3 * (s->nt + 2 * s->nu), err));
    h->n = s->n;
    h->nt = s->nt;
    for (ptrdiff_t m = 0; m < s->n; m++)
        PM_TRY(pm_map_point(map, s->phi, s->Phi + 3 * m, &work, h->x + 3 * m, NULL, NULL, err));
    memcpy(h->tri, s->tri, (size_t)(3 * s->nt) * sizeof *h->tri);
    if (s->type == PM_SURFACE_BSPLINE)
        add_fans(s, h);
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status pmplot_surface(const struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct shape h = {0};

    for (ptrdiff_t k = 0; k < s->ns; k++) {
        PM_TRY(make_shape(&s->s[k], &h, err));
        printf("# surface %td: x y z [mm]\n", k);
        for (ptrdiff_t t = 0; t < h.nt; t++) {
            for (int v = 0; v < 3; v++) {
                const double *x = h.x + 3 * h.tri[3 * t + v];
                printf("%.4f %.4f %.4f\n", x[0], x[1], x[2]);
            }
            puts("");
        }
        puts("");
        shape_release(&h);
    }
done:
    shape_release(&h);
    return status;
}

/* The cut of one triangle: from the edge that enters the half space above the plane to the one that
 * leaves it. Edges are named by their two nodes, so that neighbours share the point. */
struct cut {
    int32_t from[2], to[2];
    double a[2], b[2]; /* x z */
    int used;
};

static void cross(const struct shape *h, double y, int32_t i, int32_t j, int32_t name[2],
                  double out[2])
{
    const double *a = h->x + 3 * i, *b = h->x + 3 * j, t = (y - a[1]) / (b[1] - a[1]);
    name[0] = i < j ? i : j;
    name[1] = i < j ? j : i;
    out[0] = a[0] + t * (b[0] - a[0]);
    out[1] = a[2] + t * (b[2] - a[2]);
}

static ptrdiff_t cut_shape(const struct shape *h, double y, struct cut *cuts)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t t = 0; t < h->nt; t++) {
        struct cut c = {.used = 0};
        int ends = 0;
        for (int v = 0; v < 3; v++) {
            const int32_t i = h->tri[3 * t + v], j = h->tri[3 * t + (v + 1) % 3];
            const int above = h->x[3 * i + 1] > y, next = h->x[3 * j + 1] > y;
            if (above == next)
                continue;
            cross(h, y, i, j, next ? c.from : c.to, next ? c.a : c.b);
            ends++;
        }
        if (ends == 2)
            cuts[n++] = c;
    }
    return n;
}

static void print_loops(struct cut *cuts, ptrdiff_t n)
{
    for (ptrdiff_t start = 0; start < n; start++) {
        ptrdiff_t at = start;
        if (cuts[start].used)
            continue;
        while (at >= 0 && !cuts[at].used) {
            const struct cut *c = &cuts[at];
            cuts[at].used = 1;
            printf("%.4f %.4f\n", c->a[0], c->a[1]);
            at = -1;
            for (ptrdiff_t k = 0; k < n && at < 0; k++)
                if (memcmp(cuts[k].from, c->to, sizeof c->to) == 0)
                    at = k;
        }
        printf("%.4f %.4f\n\n", cuts[start].a[0], cuts[start].a[1]);
    }
}

enum pm_status pmplot_section(const struct pm_surfaces *s, double y, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct shape h = {0};
    struct cut *cuts = NULL;

    for (ptrdiff_t k = 0; k < s->ns; k++) {
        PM_TRY(make_shape(&s->s[k], &h, err));
        PM_TRY(PM_NEW(cuts, h.nt, err));
        printf("# surface %td: x z [mm]\n", k);
        print_loops(cuts, cut_shape(&h, y, cuts));
        puts("");
        pm_free(cuts);
        cuts = NULL;
        shape_release(&h);
    }
done:
    pm_free(cuts);
    shape_release(&h);
    return status;
}

static void print_faces(const struct pm_state *s, int chamber)
{
    static const int part[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    const struct pm_mesh *m = &s->mesh;

    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t tag = m->tri_tag[f];
        if (chamber > 0 ? tag != chamber : tag > 0)
            continue;
        for (int p = 0; p < 4; p++) {
            for (int v = 0; v < 3; v++) {
                const ptrdiff_t a = m->tri[6 * f + part[p][v]];
                const double *x = m->x + 3 * a, *u = s->u + 3 * a;
                printf("%.4f %.4f %.4f %.4f\n", x[0] + u[0], x[1] + u[1], x[2] + u[2],
                       sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
            }
            puts("");
        }
    }
    puts("");
}

void pmplot_deformed(const struct pm_state *s)
{
    for (int k = 0; k <= s->mesh.nc; k++) {
        printf("# %s %d: x y z |u| [mm]\n", k == 0 ? "outside" : "chamber", k);
        print_faces(s, k);
    }
}
