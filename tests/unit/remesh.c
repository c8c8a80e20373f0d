/* The remesher: topology, orientation, edge lengths, quality, rims; intersections, nesting,
 * distances. */
#include <stdlib.h>
#include <string.h>

#include "common/geometry/collide.h"
#include "common/geometry/remesh.h"
#include "tests/robot.h"
#include "tests/tap.h"

static const double PI = 3.14159265358979323846;

struct figures {
    ptrdiff_t open, folded; /* edges of one triangle; triangles folded in the parameter */
    double qmin, short_,
        long_;     /* worst triangle (1: equilateral); edges in parts of the wanted length */
    double inside; /* share of edges in [0.7, 1.4] of the wanted length */
    double off;    /* largest distance of a node from r(S) */
};

struct edge {
    int32_t a, b;
};

static int by_edge(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    const int32_t pl = p->a < p->b ? p->a : p->b, ph = p->a < p->b ? p->b : p->a;
    const int32_t ql = q->a < q->b ? q->a : q->b, qh = q->a < q->b ? q->b : q->a;
    return pl != ql ? (pl > ql) - (pl < ql) : (ph > qh) - (ph < qh);
}

static double length(const double *p, const double *q)
{
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static enum pm_status measure(const struct pm_surface *s, const struct pm_patch *p,
                              struct figures *f, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct edge *e = NULL;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    ptrdiff_t good = 0;
    *f = (struct figures){.qmin = 1, .short_ = 10};
    PM_TRY(PM_NEW(e, 3 * p->nt, err));
    for (ptrdiff_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->tri + 3 * t;
        double l[3];
        f->folded += !(pm_parameter_orientation(s->type, p->S + 3 * v[0], p->S + 3 * v[1],
                                                p->S + 3 * v[2]) > 0);
        for (int k = 0; k < 3; k++) {
            const int32_t a = v[k], b = v[(k + 1) % 3];
            e[3 * t + k] = (struct edge){a, b};
            l[k] = length(p->x + 3 * a, p->x + 3 * b);
            const double ratio = l[k] / (0.5 * (p->size[a] + p->size[b]));
            f->short_ = fmin(f->short_, ratio);
            f->long_ = fmax(f->long_, ratio);
            good += ratio >= 0.7 && ratio <= 1.4;
        }
        const double h = (l[0] + l[1] + l[2]) / 2,
                     area = sqrt(h * (h - l[0]) * (h - l[1]) * (h - l[2]));
        f->qmin = fmin(f->qmin, 4 * sqrt(3.0) * area / (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]));
    }
    f->inside = (double)good / (double)(3 * p->nt);
    qsort(e, (size_t)(3 * p->nt), sizeof *e, by_edge);
    for (ptrdiff_t k = 0; k < 3 * p->nt; k++) {
        const int next = k + 1 < 3 * p->nt && by_edge(&e[k], &e[k + 1]) == 0;
        if (next && e[k].a == e[k + 1].b) /* once each way */
            k++;
        else
            f->open++;
    }
    PM_TRY(pm_map_new(s, &map, err));
    for (ptrdiff_t a = 0; a < p->nn; a++) {
        double r[3];
        PM_TRY(pm_map_point(map, s->phi, p->S + 3 * a, &work, r, NULL, NULL, err));
        f->off = fmax(f->off, length(r, p->x + 3 * a));
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(e);
    return status;
}

static void check_sphere(const struct pm_surface *s, double size, struct pm_err *err)
{
    const struct pm_remesh_opts o = {
        .size = size, .size_min = size / 3, .crest = 1.2, .growth = 0.35, .sweeps = 8};
    struct pm_patch p = {0};
    struct figures f = {0};
    struct pm_contact c;
    if (!ok(pm_remesh(s, 1, &o, &p, err) == PM_OK && measure(s, &p, &f, err) == PM_OK,
            "size %g: remeshed", size))
        return;
    ok(p.nn - p.nt / 2 == 2 && p.nt % 2 == 0, "size %g: Euler number 2 (%td nodes, %td triangles)",
       size, p.nn, p.nt);
    ok(f.open == 0, "size %g: closed and oriented (%td open edges)", size, f.open);
    ok(f.folded == 0, "size %g: no triangle folded in the parameter (%td)", size, f.folded);
    ok(f.off < 1e-12, "size %g: nodes are r(S) to rounding (%g)", size, f.off);
    /* facts of earlier measurements: worst triangle 0.71 to 0.85 */
    ok(f.qmin > 0.5, "size %g: worst triangle %.3f > 0.5", size, f.qmin);
    ok(f.inside > 0.97, "size %g: %.1f %% of the edges within 0.7 to 1.4 of the wanted length",
       size, 100 * f.inside);
    ok(f.short_ > 0.4 && f.long_ < 1.6, "size %g: edges from %.2f to %.2f", size, f.short_,
       f.long_);
    ok(pm_collide_pierce(p.x, p.nt, p.tri, &c, err) == PM_OK && c.a < 0,
       "size %g: does not cut itself", size);
    ok(pm_collide_volume(p.x, p.nt, p.tri) > 0, "size %g: outward", size);
    pm_patch_release(&p);
}

static void check_tube(const struct pm_surface *s, double R, double H, struct pm_err *err)
{
    const struct pm_remesh_opts o = {
        .size = 4, .size_min = 2, .crest = 1.2, .growth = 0.35, .sweeps = 8};
    struct pm_patch p = {0};
    struct figures f = {0};
    ptrdiff_t rim[2] = {0}, wrong = 0;
    double off = 0;
    if (!ok(pm_remesh(s, 0, &o, &p, err) == PM_OK && measure(s, &p, &f, err) == PM_OK,
            "tube: remeshed"))
        return;
    for (ptrdiff_t a = 0; a < p.nn; a++) {
        if (p.rim[a] == 1 || p.rim[a] == 2) {
            rim[p.rim[a] - 1]++;
            off = fmax(off, fabs(p.x[3 * a + 2] - (p.rim[a] == 2 ? H : 0)));
        }
        wrong +=
            (p.rim[a] == 1) != (p.S[3 * a + 2] == 0) || (p.rim[a] == 2) != (p.S[3 * a + 2] == 1);
    }
    /* an annulus: V - E + F = 0, 2 E = 3 F + rim */
    ok(2 * p.nn == p.nt + rim[0] + rim[1], "tube: Euler number 0");
    ok(f.open == rim[0] + rim[1], "tube: open at its rims only (%td edges, %td rim nodes)", f.open,
       rim[0] + rim[1]);
    ok(f.folded == 0 && wrong == 0, "tube: no fold, rim nodes are those at v = 0 and 1");
    near_abs("tube: rims are planar", off, 0, 1e-12 * H);
    /* edges between 4/5 and 4/3 of the wanted length */
    const double around = 2 * PI * R / o.size;
    ok((double)rim[0] > 0.74 * around && (double)rim[0] < 1.26 * around,
       "tube: %td nodes around a rim", rim[0]);
    ok(f.qmin > 0.6 && f.inside > 0.97, "tube: worst triangle %.3f, %.1f %% of the edges as wanted",
       f.qmin, 100 * f.inside);
    pm_patch_release(&p);
}

/* Largest height of the surface over the middle of an edge, in parts of the edge. */
static enum pm_status arch(const struct pm_surface *s, const struct pm_patch *p, double *worst,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    *worst = 0;
    PM_TRY(pm_map_new(s, &map, err));
    for (ptrdiff_t i = 0; i < 3 * p->nt; i++) {
        const ptrdiff_t a = p->tri[i], b = p->tri[i % 3 == 2 ? i - 2 : i + 1];
        double S[3], r[3], middle[3];
        pm_map_middle(s->type, p->S + 3 * a, p->S + 3 * b, S);
        PM_TRY(pm_map_point(map, s->phi, S, &work, r, NULL, NULL, err));
        for (int j = 0; j < 3; j++)
            middle[j] = (p->x[3 * a + j] + p->x[3 * b + j]) / 2;
        *worst = fmax(*worst, length(r, middle) / length(p->x + 3 * a, p->x + 3 * b));
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

/* A ridge around the tube that edges of the wanted length would span unseen. */
static void check_ridge(struct pm_surface *s, struct pm_err *err)
{
    const struct pm_remesh_opts o = {
        .size = 8, .size_min = 0.8, .crest = 1.2, .growth = 0.35, .sweeps = 8};
    struct pm_patch p = {0};
    double worst = 1;
    const double middle = s->phi[3 * (s->n / 2) + 2];
    for (ptrdiff_t m = 0; m < s->n; m++) { /* one row out, its neighbours close to it */
        double *x = s->phi + 3 * m, z = x[2] - middle;
        x[0] *= fabs(z) < 1 ? 1.2 : 1;
        x[1] *= fabs(z) < 1 ? 1.2 : 1;
        x[2] = middle + (fabs(z) < 8 ? 0.3 : 1) * z;
    }
    /* over the arc of a circle of radius R an edge l <= 4/3 crest R rises l^2/(8 R) <= 0.2 l */
    const int found = pm_remesh(s, 0, &o, &p, err) == PM_OK && arch(s, &p, &worst, err) == PM_OK;
    ok(found && worst < 0.2, "a ridge is followed within %.3f edges", worst);
    pm_patch_release(&p);
}

/* The number of triangles follows the size, however the start lies to it: 1.16 of that of
 * equilateral ones, 20 % around it allowed. */
static void check_counts(const struct pm_surface *s, const char *name, struct pm_err *err)
{
    double low = 10, high = 0;
    for (int k = 0; k < 16; k++) {
        const double size = 6 * pow(0.92, k);
        const struct pm_remesh_opts o = {
            .size = size, .size_min = size, .crest = 1, .growth = 1, .sweeps = 8};
        struct pm_patch p = {0};
        if (pm_remesh(s, 0, &o, &p, err) != PM_OK) {
            ok(0, "%s: size %g: %s", name, size, err->text);
            return;
        }
        double area = 0;
        for (ptrdiff_t t = 0; t < p.nt; t++) {
            const double *x[3];
            for (int i = 0; i < 3; i++)
                x[i] = p.x + 3 * (ptrdiff_t)p.tri[3 * t + i];
            const double a = length(x[0], x[1]), b = length(x[1], x[2]), c = length(x[2], x[0]),
                         h = (a + b + c) / 2;
            area += sqrt(h * (h - a) * (h - b) * (h - c));
        }
        const double count = (double)p.nt * sqrt(3.0) / 4 * size * size / area;
        low = fmin(low, count);
        high = fmax(high, count);
        pm_patch_release(&p);
    }
    ok(low > 1.16 / 1.2 && high < 1.16 * 1.2,
       "%s: triangles per equilateral one of the size: %.2f to %.2f", name, low, high);
}

/* Two tetrahedra as closed surfaces, the second shifted along x. */
static void tetrahedra(double shift, double x[24], int32_t tri[24])
{
    static const double corner[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t face[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    for (int i = 0; i < 12; i++) {
        x[i] = corner[i];
        x[12 + i] = 0.5 * corner[i] + (i % 3 == 0 ? shift : 0.1);
        tri[i] = face[i];
        tri[12 + i] = face[i] + 4;
    }
}

static void check_contacts(struct pm_err *err)
{
    double x[24], limit[8];
    int32_t tri[24];
    struct pm_contact c;
    tetrahedra(0.1, x, tri);
    ok(pm_collide_pierce(x, 8, tri, &c, err) == PM_OK && c.a < 0,
       "nested tetrahedra do not cut each other");
    near_abs("one is inside the other", pm_collide_winding(x + 12, x, 4, tri), 1, 1e-14);
    near_abs("and not the other way round", pm_collide_winding(x, x, 4, tri + 12), 0, 1e-14);
    near_rel("volume", pm_collide_volume(x, 4, tri), 1.0 / 6, 1e-14);
    tetrahedra(0.4, x, tri);
    ok(pm_collide_pierce(x, 8, tri, &c, err) == PM_OK && c.a >= 0 && (c.a < 4) != (c.b < 4),
       "these do");
    near_abs("on the slanted face", c.at[0] + c.at[1] + c.at[2], 1, 1e-14);
    tetrahedra(1.03, x, tri);
    for (int a = 0; a < 8; a++)
        limit[a] = 0.2;
    ok(pm_collide_pierce(x, 8, tri, &c, err) == PM_OK && c.a < 0, "apart");
    ok(pm_collide_near(8, x, limit, 8, tri, &c, err) == PM_OK && c.a == 4 && c.b == 2,
       "near: node %td, triangle %td", c.a, c.b);
    /* (1.03, 0.1, 0.1) to the plane x + y + z = 1 */
    near_rel("distance", c.distance, 0.23 / sqrt(3.0), 1e-12);
    for (int a = 0; a < 8; a++)
        limit[a] = 0.1;
    ok(pm_collide_near(8, x, limit, 8, tri, &c, err) == PM_OK && c.a < 0,
       "not within a smaller limit");
}

int main(void)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces r = {0};
    struct pm_patch p = {0};
    const struct robot_chamber chamber = {{5, 0, 50}, {8, 11, 40}, 0.3};
    if (robot_init(&r, 20, 100, 1, &chamber, &err) != PM_OK)
        return tap_bail("%s", err.text);
    /* coarser than the control points, about as fine, and much finer (splits must not cascade into
     * folds) */
    check_sphere(&r.s[1], 6, &err);
    check_sphere(&r.s[1], 3, &err);
    check_sphere(&r.s[1], 0.8, &err);
    check_tube(&r.s[0], 20, 100, &err);
    check_counts(&r.s[0], "tube", &err);
    check_counts(&r.s[1], "sphere", &err);
    check_contacts(&err);
    check_ridge(&r.s[0], &err);
    const struct pm_remesh_opts tiny = {
        .size = 1e-3, .size_min = 1e-3, .crest = 1, .growth = 1, .sweeps = 1};
    ok(pm_remesh(&r.s[1], 1, &tiny, &p, &err) == PM_INPUT && strstr(err.text, "nodes on") != NULL,
       "%s", err.text);
    const struct pm_remesh_opts sharp = {
        .size = 1, .size_min = 1e-3, .crest = 0.01, .growth = 10, .sweeps = 1};
    err = (struct pm_err){.status = PM_OK};
    ok(pm_remesh(&r.s[1], 1, &sharp, &p, &err) == PM_INPUT && strstr(err.text, "curvature") != NULL,
       "%s", err.text);
    pm_surfaces_release(&r);
    return tap_done();
}
