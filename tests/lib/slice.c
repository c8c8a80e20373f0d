/* Plane strain as a slice one element thick between two symmetry planes, solved in memory:
 *   slice cylinder N ELEMENT KAPPA P   a quarter of a tube 1 <= r <= 2 under the inner pressure P,
 *                                      N parts through the wall, 2 N along the quarter: prints
 *                                      unknowns, u and du/dp at r = 1 and at r = 2
 *   slice cook N ELEMENT KAPPA         Cook's membrane, N parts a side, E = 240.565 MPa, dead shear
 *                                      traction 6.25 MPa: prints unknowns, u_y at (48, 60)
 *   slice cook-steep N ELEMENT KAPPA   the same, cells cut along the other diagonal
 * KAPPA is kappa/mu. ELEMENT tet4 has straight elements of 4 nodes, all others of 10. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/model.h"
#include "common/mechanics/tet10.h"

enum { I, J, K };
enum { STEPS = 8 }; /* of the load */
static const double on_the_way = 1e-2, at_the_end = 1e-9;

/* Cells of 6 tetrahedra on a lattice; its points of even index are vertices. */
struct slice {
    int cook, steep, cells[3];
    ptrdiff_t side[3]; /* lattice points along i, j, k */
    ptrdiff_t spread;  /* lattice points per node: 1, or 2 for linear elements */
    struct pm_mesh mesh;
    double thickness;
};

/* Loads beyond those of the model: the dead traction, and what a chamber between two planes lacks.
 */
struct loads {
    double p, traction; /* [MPa] */
    double tolerance;   /* of the residual over the first one */
};

static int32_t node(const struct slice *s, const int c[3])
{
    const ptrdiff_t d = s->spread;
    return (int32_t)(c[I] / d + s->side[I] * (c[J] / d + s->side[J] * (c[K] / d)));
}

static void place(const struct slice *s, const int c[3], double x[3])
{
    /* steep: mirrored in j and k */
    const double a = 0.5 * c[I] / s->cells[I], j = 0.5 * c[J] / s->cells[J];
    const double b = s->steep ? 1 - j : j, z = 0.5 * c[K] * s->thickness, t = acos(0.0) * b;
    const double r = 1 + a, top = 44 + 16 * a, low = 44 * a;
    x[0] = s->cook ? 48 * a : r * cos(t);
    x[1] = s->cook ? low + b * (top - low) : r * sin(t);
    x[2] = s->steep ? s->thickness - z : z;
}

/* Faces on the ends of the lattice: i, j, k low and high. The chamber is r = 1. */
static const int32_t cylinder_tag[3][2] = {
    {1, PM_FACE_EXTERIOR}, {PM_FACE_SYM_Y, PM_FACE_SYM_X}, {PM_FACE_SYM_Z, PM_FACE_SYM_Z}};
static const int32_t cook_tag[3][2] = {{PM_FACE_BASE, PM_FACE_EXTERIOR},
                                       {PM_FACE_EXTERIOR, PM_FACE_EXTERIOR},
                                       {PM_FACE_SYM_Z, PM_FACE_SYM_Z}};

/* n corners of a simplex with the middles of its edges, order of gmsh. */
static void put_nodes(const struct slice *s, int corner[][3], int n, int32_t *v)
{
    for (int a = 0; a < n; a++)
        v[a] = node(s, corner[a]);
    for (int k = 0; k < (n == 4 ? 6 : 3) && s->spread == 1; k++) {
        int c[3];
        for (int i = 0; i < 3; i++)
            c[i] = (corner[pm_tet10_edge[k][0]][i] + corner[pm_tet10_edge[k][1]][i]) / 2;
        v[n + k] = node(s, c);
    }
}

static void add_faces(struct slice *s, int corner[4][3])
{
    static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    struct pm_mesh *m = &s->mesh;
    for (int f = 0; f < 4; f++)
        for (int i = 0; i < 3; i++)
            for (int high = 0; high < 2; high++) {
                const int at = high ? 2 * s->cells[i] : 0;
                int v[3][3], on = 1;
                for (int k = 0; k < 3; k++) {
                    memcpy(v[k], corner[face[f][k]], sizeof v[k]);
                    on &= v[k][i] == at;
                }
                if (!on)
                    continue;
                put_nodes(s, v, 3, m->tri + m->npf * m->nf);
                m->tri_tag[m->nf++] = (s->cook ? cook_tag : cylinder_tag)[i][high];
            }
}

/* The cell's corner 0 to the opposite one, by the axes in any order: 6 tetrahedra that fit those of
 * the neighbours. Odd orders turn left. */
static void add_cell(struct slice *s, const int cell[3])
{
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                    {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    struct pm_mesh *m = &s->mesh;
    for (int t = 0; t < 6; t++) {
        int c[4][3];
        for (int i = 0; i < 3; i++)
            c[0][i] = 2 * cell[i];
        for (int k = 0; k < 3; k++) {
            memcpy(c[k + 1], c[k], sizeof c[k]);
            c[k + 1][order[t][k]] += 2;
        }
        if (t >= 3) {
            int swap[3];
            memcpy(swap, c[1], sizeof swap);
            memcpy(c[1], c[2], sizeof swap);
            memcpy(c[2], swap, sizeof swap);
        }
        put_nodes(s, c, 4, m->tet + m->npe * m->ne++);
        add_faces(s, c);
    }
}

static enum pm_status build(struct slice *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = &s->mesh;
    const int ni = s->cells[I], nj = s->cells[J];
    const ptrdiff_t cells = (ptrdiff_t)ni * nj;
    m->npe = s->spread == 1 ? 10 : 4;
    m->npf = s->spread == 1 ? 6 : 3;
    for (int i = 0; i < 3; i++)
        s->side[i] = 2 * s->cells[i] / s->spread + 1;
    m->nn = s->side[I] * s->side[J] * s->side[K];
    m->nc = !s->cook;
    PM_TRY(PM_NEW(m->x, 3 * m->nn, err));
    PM_TRY(PM_NEW(m->tet, m->npe * 6 * cells, err));
    PM_TRY(PM_NEW(m->tri, m->npf * 4 * (cells + ni + nj), err));
    PM_TRY(PM_NEW(m->tri_tag, 4 * (cells + ni + nj), err));
    m->x_generated = m->x;
    for (int k = 0; k <= 2; k += (int)s->spread)
        for (int j = 0; j <= 2 * nj; j += (int)s->spread)
            for (int i = 0; i <= 2 * ni; i += (int)s->spread) {
                const int c[3] = {i, j, k};
                place(s, c, m->x + 3 * (ptrdiff_t)node(s, c));
            }
    for (int j = 0; j < nj; j++)
        for (int i = 0; i < ni; i++)
            add_cell(s, (const int[3]){i, j, 0});
done:
    return status;
}

/* The model's chamber is the cone from a point on one symmetry plane over the chamber's faces; what
 * a chamber between two planes has beyond it is h/3 times its area on the other plane,
 *   A = 1/2 int (x dy - y dx) along the rim,
 * here for one edge (nodes a, b, middle m or a again). f += s dA/dx. */
static void add_rim(const double *X, const double *u, const int32_t *v, int n, double s, double *f)
{
    static const double quadratic[3][3] = {
        {0, -1.0 / 3, 4.0 / 3}, {1.0 / 3, 0, -4.0 / 3}, {-4.0 / 3, 4.0 / 3, 0}};
    static const double linear[3][3] = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 0}};
    const double *P = X + 3 * (ptrdiff_t)v[0], *Q = X + 3 * (ptrdiff_t)v[1];
    const double sign = P[0] * Q[1] > P[1] * Q[0] ? 1 : -1;
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            const double D = (n == 3 ? quadratic : linear)[a][b];
            const ptrdiff_t j = 3 * (ptrdiff_t)v[b];
            f[3 * v[a]] += sign * s / 2 * D * (X[j + 1] + u[j + 1]);
            f[3 * v[a] + 1] -= sign * s / 2 * D * (X[j] + u[j]);
        }
}

static void add_rims(const struct slice *s, const struct pm_model *m, const struct pm_config *c,
                     double p, double *f)
{
    const struct pm_mesh *mesh = &s->mesh;
    for (ptrdiff_t k = 0; k < mesh->nf; k++)
        for (int e = 0; e < 3 && mesh->tri_tag[k] == 1; e++) {
            const int32_t *t = mesh->tri + mesh->npf * k;
            const int32_t v[3] = {t[e], t[(e + 1) % 3], mesh->npf == 6 ? t[3 + e] : 0};
            const double h = fabs(mesh->x[3 * v[0] + 2] - m->origin[2]);
            if (h > 0 && mesh->x[3 * v[0] + 2] == mesh->x[3 * v[1] + 2])
                add_rim(mesh->x, c->u, v, mesh->npf == 6 ? 3 : 2, -p * h / 3, f);
        }
}

/* Uniform traction along y on the edge x = 48, by the rule and the nodes of the model's faces. */
static void add_traction(const struct slice *s, const struct pm_model *m, double traction,
                         double *f)
{
    const struct pm_mesh *mesh = &s->mesh;
    const struct pm_cavity *face = &m->cavity;
    const double area = 0.5 * 16 / s->cells[J] * s->thickness;
    for (ptrdiff_t k = 0; k < mesh->nf; k++) {
        const int32_t *t = mesh->tri + mesh->npf * k, *v = m->space.tri + face->n * k;
        const int on =
            mesh->x[3 * t[0]] == 48 && mesh->x[3 * t[1]] == 48 && mesh->x[3 * t[2]] == 48;
        for (int q = 0; q < face->nq && on; q++)
            for (int a = 0; a < face->n; a++)
                f[3 * v[a] + 1] -= traction * 2 * area * face->weight[q] * face->N[q][a];
    }
}

/* Newton at one load, from c. The rim's part of the tangent is left out: the rate is that of p/mu.
 */
static enum pm_status balance(const struct slice *s, struct pm_model *m, const struct loads *l,
                              struct pm_config *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *f = NULL, *g = NULL, low, volume, first = 0;
    int definite = 1;
    PM_TRY(PM_NEW(f, 3 * m->nn, err));
    PM_TRY(PM_NEW(g, m->nq, err));
    for (int k = 0; k < 60; k++) {
        double norm = 0;
        const double Pi = pm_model_potential(m, c, &l->p, f, &volume, &low);
        if (!isfinite(Pi) || !definite)
            break;
        add_rims(s, m, c, l->p, f);
        add_traction(s, m, s->cook ? l->traction : 0, f);
        pm_model_reduce(m, c, f, g);
        for (ptrdiff_t i = 0; i < m->nq; i++) {
            norm = fmax(norm, fabs(g[i]));
            g[i] = -g[i];
        }
        first = k == 0 ? norm : first;
        if (norm <= l->tolerance * first || norm == 0)
            goto done;
        PM_TRY(pm_model_factor(m, c, &l->p, f, NULL, &definite, err));
        PM_TRY(pm_model_solve(m, g, 1, 1e-12, err));
        pm_model_move(m, c, g, 1.0, c);
    }
    status = pm_fail(err, PM_NUMERIC, "no convergence at p = %g, traction = %g", l->p, l->traction);
done:
    pm_free(f);
    pm_free(g);
    return status;
}

/* Mean radial displacement of the nodes at r = R. */
static double radial(const struct pm_mesh *m, const struct pm_config *c, double R)
{
    double sum = 0;
    int n = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const double *x = m->x + 3 * a, r = hypot(x[0], x[1]);
        if (fabs(r - R) > 1e-9)
            continue;
        sum += (x[0] * c->u[3 * a] + x[1] * c->u[3 * a + 1]) / r;
        n++;
    }
    return sum / n;
}

static enum pm_status cylinder(const struct slice *s, struct pm_model *m, double p,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_config c = {0};
    const double step = 1e-3; /* of the central differences: error about step^2 */
    double u[3][2];
    PM_TRY(pm_config_new(m, &c, err));
    for (int k = 1; k < STEPS; k++)
        PM_TRY(balance(s, m, &(struct loads){p * k / STEPS, 0, on_the_way}, &c, err));
    for (int k = 0; k < 3; k++) {
        const struct loads l = {p + step * (k == 0 ? 0 : 2 * k - 3), 0, at_the_end};
        PM_TRY(balance(s, m, &l, &c, err));
        u[k][0] = radial(&s->mesh, &c, 1);
        u[k][1] = radial(&s->mesh, &c, 2);
    }
    printf("%td\t%.9f\t%.9f\t%.9f\t%.9f\n", m->nq, u[0][0], u[0][1],
           (u[2][0] - u[1][0]) / (2 * step), (u[2][1] - u[1][1]) / (2 * step));
done:
    pm_config_release(&c);
    return status;
}

static enum pm_status cook(const struct slice *s, struct pm_model *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_config c = {0};
    double sum = 0;
    int n = 0;
    PM_TRY(pm_config_new(m, &c, err));
    for (int k = 1; k <= STEPS; k++)
        PM_TRY(balance(s, m,
                       &(struct loads){0, 6.25 * k / STEPS, k < STEPS ? on_the_way : at_the_end},
                       &c, err));
    for (ptrdiff_t a = 0; a < s->mesh.nn; a++)
        if (s->mesh.x[3 * a] == 48 && fabs(s->mesh.x[3 * a + 1] - 60) < 1e-9) {
            sum += c.u[3 * a + 1];
            n++;
        }
    printf("%td\t%.6f\n", m->nq, sum / n);
done:
    pm_config_release(&c);
    return status;
}

static enum pm_status run(struct slice *s, const char *element, double kappa, double p,
                          struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_model *m = NULL;
    char text[256];
    /* kappa/mu = 2 (1 + nu) / (3 (1 - 2 nu)) at E = 9 kappa mu / (3 kappa + mu) */
    const double mu = s->cook ? 240.565 * (3 * kappa + 1) / (9 * kappa) : 1;
    snprintf(text, sizeof text, "[case]\nname = slice\n[material]\nmu = %.17g\nkappa = %.17g\n", mu,
             kappa * mu);
    PM_TRY(pm_case_parse(text, "slice", &s->mesh.pcase, err));
    PM_TRY(build(s, err));
    PM_TRY(pm_model_new(&s->mesh, element, &m, err));
    status = s->cook ? cook(s, m, err) : cylinder(s, m, p, err);
done:
    pm_model_free(m);
    s->mesh.x_generated = NULL;
    pm_mesh_release(&s->mesh);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct slice s = {.steep = argc == 5 && strcmp(argv[1], "cook-steep") == 0};
    s.cook = s.steep || (argc == 5 && strcmp(argv[1], "cook") == 0);
    const int n = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 0;
    if (n < 1 || (!s.cook && (argc != 6 || strcmp(argv[1], "cylinder") != 0))) {
        fprintf(stderr, "usage: slice cylinder N ELEMENT KAPPA P | cook[-steep] N ELEMENT KAPPA\n");
        return 2;
    }
    const double kappa = strtod(argv[4], NULL), p = s.cook ? 0 : strtod(argv[5], NULL);
    s.cells[I] = n;
    s.cells[J] = s.cook ? n : 2 * n;
    s.cells[K] = 1;
    s.thickness = s.cook ? 48.0 / n : 1.0 / n;
    s.spread = strcmp(argv[3], "tet4") == 0 ? 2 : 1;
    if (run(&s, argv[3], kappa, p, &err) != PM_OK)
        fprintf(stderr, "slice: %s\n", err.text);
    return (int)err.status;
}
