/* Kernels of tetmesh: Bernstein bound, mean ratio, edges and faces, two-face tetrahedra,
 * distances of walls, better places. */
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/mechanics/tet10.h"
#include "tests/tap.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/quality.h"
#include "tools/tetmesh/relocate.h"
#include "tools/tetmesh/split.h"
#include "tools/tetmesh/walls.h"

static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static double noise(int i)
{
    return (double)((37 * i + 11) % 101) / 101 - 0.5;
}

static void element(double amount, double X[30])
{
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++)
            X[3 * a + i] =
                (a < 4 ? corner[a][i]
                       : (corner[pm_tet10_edge[a - 4][0]][i] + corner[pm_tet10_edge[a - 4][1]][i]) /
                             2) +
                amount * noise(3 * a + i);
}

/* det of the polynomial sum_k b_k B_k at barycentric L: the order of quality.h. */
static double evaluate(const double b[20], const double L[4])
{
    double sum = 0;
    int n = 0;
    for (int u = 0; u < 4; u++)
        for (int v = u; v < 4; v++)
            for (int w = v; w < 4; w++) {
                const int permutations = u == w ? 1 : u == v || v == w ? 3 : 6;
                sum += b[n++] * permutations * L[u] * L[v] * L[w];
            }
    return sum;
}

static void check_bernstein(double amount)
{
    double X[30], b[20], dN[30], worst = 0, low = INFINITY, volume = 0, mean = 0, least = INFINITY;
    element(amount, X);
    pm_quality_bernstein(X, b);
    for (int k = 0; k < 20; k++) {
        least = fmin(least, b[k]);
        mean += b[k] / 20;
    }
    for (int i = 0; i <= 12; i++)
        for (int j = 0; i + j <= 12; j++)
            for (int k = 0; i + j + k <= 12; k++) {
                const double xi[3] = {i / 12.0, j / 12.0, k / 12.0},
                             L[4] = {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
                const double det = pm_tet10_gradient(X, xi, dN);
                worst = fmax(worst, fabs(det - evaluate(b, L)));
                low = fmin(low, det);
            }
    near_abs("det dX/dxi = sum b B at 455 points", worst, 0, 1e-13);
    ok(least <= low + 1e-14, "bound %.4f <= smallest sample %.4f (nodes moved by %g)", least, low,
       amount);
    ok(low - least < 2 * amount * fabs(mean), "and near to it");
    for (int q = 0; q < PM_TET_POINTS; q++)
        volume += pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN);
    /* the 4-point rule is exact to degree 2 only: the cubic part is small */
    near_rel("mean of b = 6 V", mean, 6 * volume, 0.05);
}

static void check_quality(void)
{
    const double s = 1 / sqrt(2.0), regular[12] = {1, 0, -s, -1, 0, -s, 0, -1, s, 0, 1, s};
    double X[30], flat[12];
    near_rel("mean ratio of the regular tetrahedron", fabs(pm_quality_mean_ratio(regular)), 1,
             1e-14);
    memcpy(flat, regular, sizeof flat);
    memcpy(flat + 9, regular, 3 * sizeof *flat);
    near_abs("of a flat one", pm_quality_mean_ratio(flat), 0, 1e-14);
    element(0, X);
    near_rel("scaled Jacobian of a straight element", pm_quality_scaled(X), 1, 1e-14);
    for (int i = 0; i < 3; i++) { /* inside out */
        const double x = X[i];
        X[i] = X[3 + i];
        X[3 + i] = x;
    }
    near_abs("of an inverted one", pm_quality_scaled(X), -1, 0);
}

/* Two tetrahedra on one face. */
static void check_edges(struct pm_err *err)
{
    static const int32_t tet[8] = {0, 1, 2, 3, 1, 2, 3, 4},
                         three[12] = {0, 1, 2, 3, 1, 2, 3, 4, 1, 2, 3, 5};
    struct pm_edges e = {0};
    int32_t *face = NULL, *of = NULL;
    ptrdiff_t n = 0;
    struct pm_err refused = {.status = PM_OK};
    ok(pm_edges_new(5, 2, tet, &e, err) == PM_OK && e.n == 9, "edges: %td, expected 9", e.n);
    ok(pm_edges_find(&e, 4, 2) >= 0 && pm_edges_find(&e, 0, 4) < 0,
       "one that is and one that is not");
    pm_edges_release(&e);
    ok(pm_boundary_faces(2, tet, &n, &face, &of, err) == PM_OK && n == 6,
       "free faces: %td, expected 6", n);
    pm_free(face);
    pm_free(of);
    ok(pm_boundary_faces(3, three, &n, &face, &of, &refused) == PM_NUMERIC, "%s", refused.text);
}

/* n tetrahedra around the edge C D; the faces of the first at A B belong to chamber 1. */
static void check_split(int n, struct pm_err *err)
{
    double *x = pm_calloc(3 * (n + 2), sizeof *x, err);
    int32_t *tet = pm_calloc(4 * n, sizeof *tet, err), skin[6], tag[2] = {1, 1};
    const double turn = 2 * acos(-1.0) / n;
    double before = 0, after = 0;
    ptrdiff_t left = -1;
    if (x == NULL || tet == NULL)
        return;
    x[2] = -1; /* C is node 0, D is node 1 */
    x[5] = 1;
    for (int k = 0; k < n; k++) {
        const int32_t v[4] = {0, 1, 2 + k, 2 + (k + 1) % n};
        x[6 + 3 * k] = cos(turn * k);
        x[7 + 3 * k] = sin(turn * k);
        memcpy(tet + 4 * k, v, sizeof v);
    }
    const int32_t faces[6] = {0, 3, 2, 1, 2, 3};
    memcpy(skin, faces, sizeof skin);
    const struct pm_shell shell = {.nn = n + 2, .nt = 2, .tri = skin, .tag = tag};
    struct pm_tetra t = {.nn = n + 2, .ne = n, .x = x, .tet = tet};
    for (int pass = 0; pass < 2; pass++) {
        for (ptrdiff_t e = 0; e < t.ne; e++) {
            double X[12], u[3][3];
            for (int k = 0; k < 4; k++)
                memcpy(X + 3 * k, t.x + 3 * t.tet[4 * e + k], 3 * sizeof *X);
            for (int k = 0; k < 9; k++)
                u[k / 3][k % 3] = X[3 + k] - X[k % 3];
            const double det = u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
                               u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
                               u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
            *(pass ? &after : &before) += det / 6;
            if (pass)
                ok(pm_quality_mean_ratio(X) > 0.15,
                   "ring of %d: new tetrahedron %td has mean ratio %.2f", n, e,
                   pm_quality_mean_ratio(X));
        }
        if (pass == 0)
            ok(pm_split_two_faces(&shell, &t, &left, err) == PM_OK && left == 0,
               "ring of %d: taken apart", n);
    }
    near_rel("the volume stays", after, before, 1e-14);
    ok(t.ne >= 2 * (n - 2), "ring of %d: %td tetrahedra", n, t.ne);
    pm_free(t.x);
    pm_free(t.tet);
}

/* A cube from `low` to `high` on every axis, outward; returns the next triangle. */
static ptrdiff_t cube(double low, double high, int32_t tag, struct pm_shell *s)
{
    static const int32_t face[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    for (int a = 0; a < 8; a++)
        for (int i = 0; i < 3; i++)
            s->x[3 * (s->nn + a) + i] = a >> i & 1 ? high : low;
    for (int i = 0; i < 36; i++)
        s->tri[3 * s->nt + i] = (int32_t)s->nn + face[i];
    for (int t = 0; t < 12; t++)
        s->tag[s->nt + t] = tag;
    s->nn += 8;
    return s->nt += 12;
}

/* A chamber from 3 to 5 mm in a body from 0 to 10 mm. */
static void check_walls(struct pm_err *err)
{
    double x[48];
    int32_t tri[72], tag[24];
    struct pm_shell s = {.x = x, .tri = tri, .tag = tag};
    struct pm_walls w;
    const double outer[3] = {0, 4.1, 4.2}, inner[3] = {3, 4.1, 4.2};
    const double left[3] = {-1, 0, 0}, right[3] = {1, 0, 0};
    cube(0, 10, 0, &s);
    cube(3, 5, 1, &s);
    if (!ok(pm_walls_init(&w, &s, 2, 1, 20, err) == PM_OK, "distances"))
        return;
    near_rel("from the outside to the chamber", pm_walls_facing(&w, outer, right, 1, 20), 3, 1e-14);
    near_rel("and back", pm_walls_facing(&w, inner, left, 1, 20), 3, 1e-14);
    near_rel("across the chamber", pm_walls_facing(&w, inner, right, 0, 20), 2, 1e-14);
    near_rel("nothing outside", pm_walls_facing(&w, outer, left, 0, 20), 20, 1e-14);
    const struct pm_wall_side in = {&w, 1};
    /* two edges over 3 mm; sqrt(2 d / k) over the 2 mm of air; 5 d is longer */
    near_rel("flat: layers", pm_walls_bound(&in, inner, left, 0), 1.5, 1e-14);
    near_rel("curved: the rise", pm_walls_bound(&in, inner, left, 4), 1, 1e-14);
    pm_walls_release(&w);
    s.nn = s.nt = 0;
    s.planes = 1;
    cube(3, 5, 1, &s);
    ok(pm_walls_init(&w, &s, 0, 0, 20, err) == PM_OK, "with a mirror");
    near_rel("to its own image", pm_walls_facing(&w, inner, left, 1, 20), 6, 1e-14);
    ok(isinf(pm_walls_bound(&in, inner, left, 4)), "no layers asked, no bound");
    pm_walls_release(&w);
}

/* Eight tetrahedra around the middle of an octahedron, which begins outside of it. */
static void check_relocate(struct pm_err *err)
{
    enum { VERTICES = 7, NODES = 25, ELEMENTS = 8 };
    double x[3 * NODES] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0.2, 0.1, 1.3};
    int32_t tet[10 * ELEMENTS], flat[4 * ELEMENTS], tri[6 * ELEMENTS], tag[ELEMENTS] = {0};
    int32_t image[NODES];
    struct pm_edges e = {0};
    for (int k = 0; k < ELEMENTS; k++) {
        const int32_t turned = (k & 1) ^ (k >> 1 & 1) ^ (k >> 2 & 1);
        const int32_t a = k & 1, b = 2 + (k >> 1 & 1), c = 4 + (k >> 2 & 1);
        const int32_t v[4] = {6, a, turned ? c : b, turned ? b : c};
        memcpy(flat + 4 * k, v, sizeof v);
    }
    if (!ok(pm_edges_new(VERTICES, ELEMENTS, flat, &e, err) == PM_OK && e.n == NODES - VERTICES,
            "an octahedron"))
        return;
    for (int k = 0; k < ELEMENTS; k++) {
        const int32_t *v = flat + 4 * k;
        memcpy(tet + 10 * k, v, 4 * sizeof *v);
        for (int j = 0; j < 6; j++) {
            const int32_t a = v[pm_tet10_edge[j][0]], b = v[pm_tet10_edge[j][1]];
            const ptrdiff_t n = VERTICES + pm_edges_find(&e, a, b);
            tet[10 * k + 4 + j] = (int32_t)n;
            for (int i = 0; i < 3; i++)
                x[3 * n + i] = (x[3 * a + i] + x[3 * b + i]) / 2;
        }
        const int32_t *t = tet + 10 * k, face[6] = {t[1], t[2], t[3], t[5], t[8], t[9]};
        memcpy(tri + 6 * k, face, sizeof face);
    }
    for (int32_t a = 0; a < NODES; a++)
        image[a] = a;
    struct pm_mesh m = {.nn = NODES,
                        .ne = ELEMENTS,
                        .nf = ELEMENTS,
                        .npe = 10,
                        .npf = 6,
                        .x = x,
                        .tet = tet,
                        .tri = tri,
                        .tri_tag = tag};
    const struct pm_relocate_opts o = {0.5, 0.5, {image, NULL}};
    ptrdiff_t left = 1;
    ok(pm_relocate(&o, &m, &left, err) == PM_OK && left == 0, "all are good");
    ok(x[18] == 0.2, "a node on a mirror plane stays on it");
    ok(fabs(x[19]) < 0.3 && fabs(x[20]) < 0.3, "and goes to the middle (%.2f, %.2f)", x[19], x[20]);
    ok(x[0] == 1 && x[4] == 0 && x[14] == 1, "the outside stays");
    pm_edges_release(&e);
}

int main(void)
{
    struct pm_err err = {.status = PM_OK};
    check_bernstein(0.1);
    check_bernstein(0.4); /* inverted somewhere */
    check_quality();
    check_edges(&err);
    check_split(3, &err);
    check_split(4, &err);
    check_split(6, &err);
    check_walls(&err);
    check_relocate(&err);
    return tap_done();
}
