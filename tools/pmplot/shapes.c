#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/surface_map.h"
#include "tools/pmplot/pmplot.h"

enum { LEVELS = 1 };
/* Towards the light: above, in front, to the right. */
static const double LIGHT[3] = {0.41, -0.75, 0.52};

/* A triangulated surface: the triangles of control points, each cut in 4^levels on the true
 * surface. The tube gets a fan over each planar rim, so that every surface is closed. */
struct shape {
    ptrdiff_t n, nt;
    double *S;    /* parameters (n x 3) */
    double *x;    /* (n x 3) [mm] */
    int32_t *tri; /* (nt x 3) */
};

struct side {
    int32_t low, high; /* nodes */
    ptrdiff_t corner;  /* 3 t + v: the side from corner v of triangle t to the next one */
};

static void normal(double x[3][3], double n[3])
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = x[1][k] - x[0][k];
        b[k] = x[2][k] - x[0][k];
    }
    for (int k = 0; k < 3; k++)
        n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3 && length > 0; k++)
        n[k] /= length;
}

/* One triangle as a grid of 2 x 2 points with the last corner twice, which gnuplot colours by
 * column (pm3d). */
static void print_facet(double x[3][3], const double value[3], ptrdiff_t surface)
{
    static const int corner[4] = {0, 1, 2, 2};
    double n[3];

    normal(x, n);
    const double light = n[0] * LIGHT[0] + n[1] * LIGHT[1] + n[2] * LIGHT[2];
    for (int k = 0; k < 4; k++) {
        const int v = corner[k];
        printf("%.3f %.3f %.3f %.4g %.3f %td\n%s", x[v][0], x[v][1], x[v][2], value[v], light,
               surface,
               k == 1   ? "\n"
               : k == 3 ? "\n\n"
                        : "");
    }
}

static void shape_release(struct shape *h)
{
    pm_free(h->S);
    pm_free(h->x);
    pm_free(h->tri);
    *h = (struct shape){0};
}

static int compare_sides(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    const ptrdiff_t d = p->low != q->low     ? p->low - q->low
                        : p->high != q->high ? p->high - q->high
                                             : p->corner - q->corner;
    return (d > 0) - (d < 0);
}

/* Cuts every triangle in four; neighbours share the new points. */
static enum pm_status refine(int32_t type, struct shape *h, struct pm_err *err)
{
    enum pm_status status;
    struct side *sides = NULL;
    int32_t *middle = NULL, *tri = NULL;
    double *S = NULL;
    const ptrdiff_t ns = 3 * h->nt;

    PM_TRY(PM_NEW(sides, ns, err));
    PM_TRY(PM_NEW(middle, ns, err));
    PM_TRY(PM_NEW(tri, 4 * ns, err));
    PM_TRY(PM_NEW(S, 3 * (h->n + ns), err));
    memcpy(S, h->S, (size_t)(3 * h->n) * sizeof *S);
    for (ptrdiff_t c = 0; c < ns; c++) {
        const int32_t i = h->tri[c], j = h->tri[c - c % 3 + (c + 1) % 3];
        sides[c] = (struct side){.low = i < j ? i : j, .high = i < j ? j : i, .corner = c};
    }
    qsort(sides, (size_t)ns, sizeof *sides, compare_sides);
    for (ptrdiff_t k = 0; k < ns; k++) {
        const int fresh =
            k == 0 || sides[k].low != sides[k - 1].low || sides[k].high != sides[k - 1].high;
        if (fresh)
            pm_map_middle(type, S + 3 * sides[k].low, S + 3 * sides[k].high, S + 3 * h->n++);
        middle[sides[k].corner] = (int32_t)(h->n - 1);
    }
    for (ptrdiff_t t = 0; t < h->nt; t++) {
        const int32_t *v = h->tri + 3 * t, *m = middle + 3 * t;
        const int32_t parts[12] = {v[0], m[0], m[2], m[0], v[1], m[1],
                                   m[2], m[1], v[2], m[0], m[1], m[2]};
        memcpy(tri + 12 * t, parts, sizeof parts);
    }
    pm_free(h->S);
    pm_free(h->tri);
    h->S = S;
    h->tri = tri;
    h->nt *= 4;
    S = NULL;
    tri = NULL;
done:
    pm_free(sides);
    pm_free(middle);
    pm_free(S);
    pm_free(tri);
    return status;
}

/* Nodes of the planar rims, v = 0 and v = 1, lie on the outer side of one triangle each: the fan
 * takes those. */
static void add_fans(struct shape *h)
{
    const ptrdiff_t nt = h->nt;
    for (int end = 0; end < 2; end++) {
        const ptrdiff_t centre = h->n++;
        double count = 0;
        for (ptrdiff_t c = 0; c < 3 * nt; c++) {
            const int32_t i = h->tri[c], j = h->tri[c - c % 3 + (c + 1) % 3];
            if (h->S[3 * i + 2] != end || h->S[3 * j + 2] != end)
                continue;
            const int32_t fan[3] = {(int32_t)centre, j, i};
            memcpy(h->tri + 3 * h->nt++, fan, sizeof fan);
            for (int k = 0; k < 3; k++)
                h->x[3 * centre + k] += h->x[3 * i + k];
            count++;
        }
        for (int k = 0; k < 3 && count > 0; k++)
            h->x[3 * centre + k] /= count;
    }
}

static enum pm_status make_shape(const struct pm_surface *s, int levels, struct shape *h,
                                 struct pm_err *err)
{
    enum pm_status status;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    int32_t *grown;

    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(h->S, 3 * s->n, err));
    PM_TRY(PM_NEW(h->tri, 3 * s->nt, err));
    h->n = s->n;
    h->nt = s->nt;
    memcpy(h->S, s->Phi, (size_t)(3 * s->n) * sizeof *h->S);
    memcpy(h->tri, s->tri, (size_t)(3 * s->nt) * sizeof *h->tri);
    for (int l = 0; l < levels; l++)
        PM_TRY(refine(s->type, h, err));
    PM_TRY(PM_NEW(h->x, 3 * (h->n + 2), err));
    for (ptrdiff_t m = 0; m < h->n; m++)
        PM_TRY(pm_map_point(map, s->phi, h->S + 3 * m, &work, h->x + 3 * m, NULL, NULL, err));
    if (s->type == PM_SURFACE_BSPLINE) {
        grown = pm_realloc(h->tri, 3 * (h->nt + 2 * (s->nu << levels)), sizeof *grown, err);
        if (grown == NULL) {
            status = PM_SYSTEM;
            goto done;
        }
        h->tri = grown;
        add_fans(h);
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status pmplot_surface(const struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct shape h = {0};

    puts("# x y z [mm] 0 light surface");
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        PM_TRY(make_shape(&s->s[k], LEVELS, &h, err));
        for (ptrdiff_t t = 0; t < h.nt; t++) {
            const double none[3] = {0, 0, 0};
            double x[3][3];
            for (int v = 0; v < 3; v++)
                memcpy(x[v], h.x + 3 * h.tri[3 * t + v], sizeof x[v]);
            print_facet(x, none, k);
        }
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
        PM_TRY(make_shape(&s->s[k], LEVELS, &h, err));
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

/* What is behind symmetry planes is the image of the mesh. */
struct images {
    unsigned planes; /* bit i: across axis i */
    double at[3];    /* [mm] */
};

static struct images find_images(const struct pm_mesh *m)
{
    struct images p = {.planes = 0};
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int axis = PM_FACE_SYM_X - m->tri_tag[f];
        if (axis < 0)
            continue;
        p.planes |= 1u << axis;
        p.at[axis] = m->x[3 * (ptrdiff_t)m->tri[m->npf * f] + axis];
    }
    return p;
}

/* A facet of the mesh in the image that is reflected along the axes in `image`. */
static void print_image(const struct images *p, unsigned image, double x[3][3],
                        const double size[3], int surface)
{
    double y[3][3], s[3];
    int odd = 0;
    for (int i = 0; i < 3; i++)
        odd ^= (int)(image >> i & 1);
    for (int v = 0; v < 3; v++) {
        const int from = odd && v > 0 ? 3 - v : v;
        for (int i = 0; i < 3; i++)
            y[v][i] = image >> i & 1 ? 2 * p->at[i] - x[from][i] : x[from][i];
        s[v] = size[from];
    }
    print_facet(y, s, surface);
}

static void print_faces(const struct pm_state *s, const struct images *images, int chamber)
{
    static const int quadratic[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
                     linear[1][3] = {{0, 1, 2}};
    const struct pm_mesh *m = &s->mesh;
    const int(*part)[3] = m->npf == 6 ? quadratic : linear, parts = m->npf == 6 ? 4 : 1;

    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t tag = m->tri_tag[f];
        if (chamber > 0 ? tag != chamber : tag > 0 || tag <= PM_FACE_SYM_X)
            continue;
        for (int p = 0; p < parts; p++) {
            double x[3][3], size[3];
            for (int v = 0; v < 3; v++) {
                const ptrdiff_t a = m->tri[m->npf * f + part[p][v]];
                const double *u = s->u + 3 * a;
                for (int k = 0; k < 3; k++)
                    x[v][k] = m->x[3 * a + k] + u[k];
                size[v] = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
            }
            for (unsigned image = 0; image < 8; image++)
                if ((image & ~images->planes) == 0)
                    print_image(images, image, x, size, chamber);
        }
    }
}

void pmplot_deformed(const struct pm_state *s)
{
    puts("# x y z |u| [mm] light surface");
    const struct images images = find_images(&s->mesh);
    for (int k = 0; k <= s->mesh.nc; k++)
        print_faces(s, &images, k);
}
