/* Self-contact: searches against brute force, a groove that closes, a sphere, a symmetry plane. */
#include "common/geometry/closeness.h"
#include "common/geometry/contact.h"

#include "common/geometry/collide.h"
#include "tests/robot.h"
#include "tests/tap.h"

static double noise(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 24);
}

/* Triangles of size about 0.3 in the unit cube without common nodes. */
enum { SOUP = 300 };

static void make_soup(uint32_t seed, double *x, int32_t *tri)
{
    for (int t = 0; t < SOUP; t++) {
        const double c[3] = {noise(&seed), noise(&seed), noise(&seed)};
        for (int k = 0; k < 9; k++)
            x[9 * t + k] = c[k % 3] + 0.3 * noise(&seed);
        for (int k = 0; k < 3; k++)
            tri[3 * t + k] = 3 * t + k;
    }
}

/* Pairs of faces (`parts` triangles each), each pair of triangles tested alone. */
static ptrdiff_t brute_pairs(const double *x, const int32_t *tri, int parts, struct pm_err *err)
{
    ptrdiff_t count = 0;
    for (int f = 0; f < SOUP / parts; f++)
        for (int g = f; g < SOUP / parts; g++) {
            int hit = 0;
            for (int i = parts * f; i < parts * (f + 1) && !hit; i++)
                for (int j = f == g ? i + 1 : parts * g; j < parts * (g + 1) && !hit; j++) {
                    int32_t two[6];
                    struct pm_contact c;
                    memcpy(two, tri + 3 * i, 3 * sizeof *two);
                    memcpy(two + 3, tri + 3 * j, 3 * sizeof *two);
                    hit = pm_collide_pierce(x, 2, two, &c, err) == PM_OK && c.a >= 0;
                }
            count += hit;
        }
    return count;
}

static void check_soup(struct pm_err *err)
{
    static double x[9 * SOUP];
    static int32_t tri[3 * SOUP];
    for (uint32_t seed = 1; seed <= 3; seed++)
        for (int parts = 1; parts <= 4; parts += 3) {
            struct pm_boxes *boxes = NULL;
            struct pm_contact c = {.pairs = -1};
            make_soup(seed, x, tri);
            const ptrdiff_t want = brute_pairs(x, tri, parts, err);
            enum pm_status status = pm_collide_boxes(x, SOUP, tri, NULL, &boxes, err);
            if (status == PM_OK)
                status = pm_collide_faces(boxes, x, tri, parts, &c, err);
            ok(status == PM_OK && c.pairs == want && want > 100,
               "soup %u, faces of %d triangles: %td pairs, brute force %td", seed, parts, c.pairs,
               want);
            pm_boxes_free(boxes);
        }
}

struct nearest {
    const double *x, *p;
    const int32_t *tri;
    int32_t id;
};

static double visit(void *data, int32_t t, double best)
{
    struct nearest *n = data;
    const double *x = n->x + 9 * (ptrdiff_t)t;
    double q[3];
    const double d = pm_collide_closest(n->p, x, x + 3, x + 6, q);
    if (d < best)
        n->id = t;
    return d < best ? d : best;
}

static void check_nearest(struct pm_err *err)
{
    static double x[9 * SOUP];
    static int32_t tri[3 * SOUP];
    struct pm_boxes *boxes = NULL;
    uint32_t seed = 7;
    int good = 0;
    make_soup(4, x, tri);
    if (!ok(pm_collide_boxes(x, SOUP, tri, NULL, &boxes, err) == PM_OK, "boxes"))
        return;
    for (int k = 0; k < 200; k++) {
        const double p[3] = {3 * noise(&seed) - 1, 3 * noise(&seed) - 1, 3 * noise(&seed) - 1};
        struct nearest fast = {.x = x, .p = p, .tri = tri}, slow = fast;
        double a = pm_boxes_nearest(boxes, p, HUGE_VAL, visit, &fast), b = HUGE_VAL;
        for (int32_t t = 0; t < SOUP; t++)
            b = visit(&slow, t, b);
        good += fabs(a - b) <= 0 && fast.id == slow.id;
    }
    ok(good == 200, "the nearest of %d triangles for %d of 200 points", SOUP, good);
    pm_boxes_free(boxes);
}

/* The skin of a block with a groove 2 wide and 5 deep along y, extruded from its profile in x, z;
 * nodes 1 apart. */
enum { ALONG = 4, MOST = 64 };

struct groove {
    double x[3 * MOST * (ALONG + 1)], u[3 * MOST * (ALONG + 1)];
    int32_t tri[6 * MOST * ALONG], tag[2 * MOST * ALONG];
    struct pm_mesh mesh;
};

static void make_groove(struct groove *g)
{
    static const double corner[9][2] = {{4, -2}, {4, 5},  {1, 5},   {1, 0}, {-1, 0},
                                        {-1, 5}, {-4, 5}, {-4, -2}, {4, -2}};
    int n = 0;
    for (int k = 0; k < 8; k++) {
        const double dx = corner[k + 1][0] - corner[k][0], dz = corner[k + 1][1] - corner[k][1];
        const int cuts = (int)lround(fabs(dx) + fabs(dz));
        for (int i = 0; i < cuts; i++, n++)
            for (int j = 0; j <= ALONG; j++) {
                double *p = g->x + 3 * (n * (ALONG + 1) + j);
                p[0] = corner[k][0] + dx * i / cuts;
                p[1] = j;
                p[2] = corner[k][1] + dz * i / cuts;
            }
    }
    g->mesh = (struct pm_mesh){
        .nn = n * (ALONG + 1), .npf = 3, .npe = 4, .x = g->x, .tri = g->tri, .tri_tag = g->tag};
    for (int k = 0; k < n; k++)
        for (int j = 0; j < ALONG; j++) {
            const int32_t a = k * (ALONG + 1) + j, b = (k + 1) % n * (ALONG + 1) + j;
            const int32_t two[6] = {a, b + 1, b, a, a + 1, b + 1};
            memcpy(g->tri + 3 * g->mesh.nf, two, sizeof two);
            g->mesh.nf += 2;
        }
}

/* The edges of the groove come nearer by `close` each. */
static struct pm_self_contact closed(struct groove *g, double close)
{
    struct pm_self_contact c = {.gap = -2};
    struct pm_err err = {.status = PM_OK};
    for (ptrdiff_t a = 0; a < g->mesh.nn; a++)
        if (g->x[3 * a + 2] > 0)
            g->u[3 * a] = -copysign(close * g->x[3 * a + 2] / 5, g->x[3 * a]);
    ok(pm_contact_find(&g->mesh, g->u, &c, &err) == PM_OK, "groove closed by %g each side", close);
    return c;
}

/* Half of it: the plane x = 0 takes the part of the other flank. */
static void halve(struct groove *g)
{
    for (ptrdiff_t f = 0; f < g->mesh.nf; f++) {
        const int32_t *v = g->tri + 3 * f;
        if (fmax(g->x[3 * v[0]], fmax(g->x[3 * v[1]], g->x[3 * v[2]])) < 0.5)
            g->tag[f] = PM_FACE_SYM_X;
    }
    for (ptrdiff_t a = 0; a < g->mesh.nn; a++)
        if (g->x[3 * a] < 0)
            g->x[3 * a] = 0;
}

static void check_groove(void)
{
    static struct groove g;
    make_groove(&g);
    struct pm_self_contact c = closed(&g, 0.8);
    ok(c.intersections == 0 && c.surface[0] == 0 && c.surface[1] == 0, "nothing intersects");
    near_abs("gap", c.gap, 0.4, 1e-14);
    near_abs("at the top", c.at[2], 5, 1e-14);
    c = closed(&g, 1.1);
    ok(c.intersections > 0 && c.gap <= 0, "%lld pairs intersect, gap %g",
       (long long)c.intersections, c.gap);
    ok(fabs(c.at[0]) < 0.1 && c.at[2] > 4, "near the top (%g, %g, %g)", c.at[0], c.at[1], c.at[2]);
    halve(&g);
    c = closed(&g, 0.8);
    near_abs("half of it: gap to the mirror image", c.gap, 0.4, 1e-14);
    ok(c.intersections == 0 && c.surface[0] == 0 && c.surface[1] == PM_FACE_SYM_X,
       "across the plane");
    c = closed(&g, 1.1);
    ok(c.intersections > 0 && c.surface[1] == PM_FACE_SYM_X && c.gap <= 0,
       "half of it: %lld faces reach through the plane", (long long)c.intersections);
}

/* The sum of the parts and its derivative. */
static double close_by(const struct groove *g, double gap_min, double *gradient)
{
    static double parts[PM_CLOSENESS_PARTS * 3 * MOST * (ALONG + 1)];
    struct pm_mesh m = g->mesh;
    struct pm_err err = {.status = PM_OK};
    double G[PM_CLOSENESS_PARTS];
    m.pcase.gap_min = gap_min;
    ok(pm_closeness(&m, g->u, G, parts, &err) == PM_OK, "closeness within %g", gap_min);
    for (ptrdiff_t i = 0; i < 3 * m.nn && gradient != NULL; i++) {
        gradient[i] = 0;
        for (int p = 0; p < PM_CLOSENESS_PARTS; p++)
            gradient[i] += parts[3 * m.nn * p + i];
    }
    return pm_closeness_sum(G);
}

/* Derivatives of the closeness against differences, node by node. */
static void check_closeness_gradient(struct groove *g, double gap_min, const char *text)
{
    static double gradient[3 * MOST * (ALONG + 1)];
    double worst = 0, largest = 0;
    const double h = 1e-5;
    struct pm_mesh m = g->mesh;
    struct pm_err err = {.status = PM_OK};
    m.pcase.gap_min = gap_min;
    close_by(g, gap_min, gradient);
    for (ptrdiff_t i = 0; i < 3 * m.nn; i++) {
        const double kept = g->u[i];
        double G[2][PM_CLOSENESS_PARTS];
        for (int k = 0; k < 2; k++) {
            g->u[i] = kept + (k == 0 ? h : -h);
            if (pm_closeness(&m, g->u, G[k], NULL, &err) != PM_OK)
                ok(0, "%s", err.text);
        }
        g->u[i] = kept;
        const double rise = pm_closeness_sum(G[0]) - pm_closeness_sum(G[1]);
        worst = fmax(worst, fabs(rise / (2 * h) - gradient[i]));
        largest = fmax(largest, fabs(gradient[i]));
    }
    /* truncation h^2 / gap^2 */
    ok(worst < 1e-7 * largest && largest > 0.5, "%s: derivative off by %.1e of %.3g", text, worst,
       largest);
}

static void rough(struct groove *g)
{
    uint32_t seed = 11;
    for (ptrdiff_t a = 0; a < g->mesh.nn; a++)
        for (int i = 0; i < 3; i++)
            g->u[3 * a + i] += 0.1 * (noise(&seed) - 0.5);
}

static void check_closeness(void)
{
    static struct groove g;
    make_groove(&g);
    /* flanks of 5 x 4, 2 apart; the floor sees nothing */
    const double x = 2.0 / 3, b = (1 - x) * (1 - x);
    near_rel("parallel flanks", close_by(&g, 3, NULL), 2 * 20.0 / 9 * b, 1e-12);
    struct pm_mesh m = g.mesh;
    struct pm_err err = {.status = PM_OK};
    double G[PM_CLOSENESS_PARTS];
    m.pcase.gap_min = 3;
    ok(pm_closeness(&m, g.u, G, NULL, &err) == PM_OK && G[0] > 0 && !(pm_closeness_sum(G) > G[0]),
       "of one region");
    near_abs("wide flanks", close_by(&g, 2, NULL), 0, 0);
    near_abs("not asked for", close_by(&g, 0, NULL), 0, 0);
    closed(&g, 0.8);
    rough(&g);
    check_closeness_gradient(&g, 1.5, "rough wedge");
    halve(&g);
    memset(g.u, 0, sizeof g.u);
    near_rel("half of them", close_by(&g, 3, NULL), 2 * 20.0 / 9 * b, 1e-12);
    closed(&g, 0.8);
    rough(&g);
    for (ptrdiff_t a = 0; a < g.mesh.nn; a++)
        if (!(fabs(g.x[3 * a]) > 0))
            g.u[3 * a] = 0;
    check_closeness_gradient(&g, 1.5, "half of a rough wedge");
}

/* A spherical chamber (radius 3) in a sphere, blown up by half. */
static void check_sphere(struct pm_err *err)
{
    struct pm_surface s = {0};
    struct pm_mesh m = {.npf = 3, .npe = 4};
    struct pm_self_contact c;
    double *u = NULL;
    if (robot_icosphere(3, &s, err) != PM_OK || PM_NEW(m.x, 6 * s.n, err) != PM_OK ||
        PM_NEW(m.tri, 6 * s.nt, err) != PM_OK || PM_NEW(m.tri_tag, 2 * s.nt, err) != PM_OK ||
        PM_NEW(u, 6 * s.n, err) != PM_OK) {
        ok(0, "%s", err->text);
        return;
    }
    m.nn = 2 * s.n;
    m.nf = 2 * s.nt;
    for (ptrdiff_t i = 0; i < 3 * s.n; i++) {
        m.x[i] = 3 * s.Phi[i];
        m.x[3 * s.n + i] = 5 * s.Phi[i];
        u[i] = 1.5 * s.Phi[i];
        u[3 * s.n + i] = 0.7 * s.Phi[i];
    }
    for (ptrdiff_t t = 0; t < s.nt; t++) {
        const int32_t *v = s.tri + 3 * t;
        const int32_t in[3] = {v[0], v[2], v[1]};
        memcpy(m.tri + 3 * t, in, sizeof in);
        for (int k = 0; k < 3; k++)
            m.tri[3 * (s.nt + t) + k] = (int32_t)s.n + v[k];
        m.tri_tag[t] = 1;
    }
    ok(pm_contact_find(&m, u, &c, err) == PM_OK && c.intersections == 0, "nothing intersects");
    ok(c.gap < 0, "the chamber is wide");
    for (ptrdiff_t i = 0; i < 3 * s.n; i++)
        u[i] = -2.8 * s.Phi[i];
    ok(pm_contact_find(&m, u, &c, err) == PM_OK && c.surface[0] == 1 && c.surface[1] == 1,
       "shrunk to a radius of 0.2: the chamber faces itself");
    /* chords in the cone of cosine 0.8, less what facets of 0.15 of the radius add to their angles
     */
    near_rel("its width in the cone", c.gap, 1.6 * 0.2, 0.08);
    for (ptrdiff_t i = 0; i < 3 * s.n; i++)
        u[i] = 2.5 * s.Phi[i];
    ok(pm_contact_find(&m, u, &c, err) == PM_OK && c.intersections == 0, "none without a cut");
    for (ptrdiff_t i = 0; i < 3 * s.n; i++)
        u[i] += i % 3 == 0 ? 0.4 : 0;
    ok(pm_contact_find(&m, u, &c, err) == PM_OK && c.intersections > 10, "some with one");
    ok((c.surface[0] == 1) != (c.surface[1] == 1), "of the chamber and the exterior");
    pm_mesh_release(&m);
    pm_free(u);
    pm_free(s.phi);
    pm_free(s.Phi);
    pm_free(s.tri);
}

int main(void)
{
    struct pm_err err = {.status = PM_OK};
    check_soup(&err);
    check_nearest(&err);
    check_groove();
    check_closeness();
    check_sphere(&err);
    return tap_done();
}
