#include "common/mechanics/space.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"

/* Walkington's rule, 14 points, exact to degree 5. */
#define A1 0.31088591926330060980
#define A2 0.092735250310891226402
#define A3 0.045503704125649649492
#define B1 (1 - 3 * A1)
#define B2 (1 - 3 * A2)
#define B3 (0.5 - A3)
#define W1 (0.11268792571801585080 / 6)
#define W2 (0.073493043116361949544 / 6)
#define W3 (0.042546020777081466438 / 6)
static const double xi14[14][3] = {{A1, A1, A1}, {B1, A1, A1}, {A1, B1, A1}, {A1, A1, B1},
                                   {A2, A2, A2}, {B2, A2, A2}, {A2, B2, A2}, {A2, A2, B2},
                                   {A3, A3, B3}, {A3, B3, A3}, {B3, A3, A3}, {B3, B3, A3},
                                   {B3, A3, B3}, {A3, B3, B3}};
static const double weight14[14] = {W1, W1, W1, W1, W2, W2, W2, W2, W3, W3, W3, W3, W3, W3};
static const double xi1[1][3] = {{0.25, 0.25, 0.25}};
static const double weight1[1] = {1.0 / 6};

/* b = 2 mu/kappa: locking-free at thin walls and still quiet (measured on pleated walls, Cook's
 * membrane; pneumorph-model(7)). */
static const struct pm_element_type types[] = {
    {"tet10-blend", 10, 6, 4, 1, 2.0, pm_tet_xi, pm_tet_weight},
    {"tet10", 10, 6, 4, 0, -1.0, pm_tet_xi, pm_tet_weight},
    {"tet10-mean", 10, 6, 4, 1, 0.0, pm_tet_xi, pm_tet_weight},
    {"tet4", 4, 3, 1, 0, -1.0, xi1, weight1},
    {"tet15", 15, 7, 14, 4, 0.0, xi14, weight14},
};

enum pm_status pm_element_type(const char *name, const struct pm_mesh *mesh,
                               const struct pm_element_type **type, struct pm_err *err)
{
    if (name == NULL)
        name = mesh->npe == 4 ? "tet4" : "tet10-blend";
    for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
        if (strcmp(name, types[k].name) != 0)
            continue;
        if (types[k].npe > 4 && mesh->npe == 4)
            return pm_fail(err, PM_INPUT,
                           "element %s needs a quadratic mesh: this one is linear, expected "
                           "element tet4 or a mesh raised by tetmesh --promote",
                           name);
        *type = &types[k];
        return PM_OK;
    }
    return pm_fail(err, PM_USAGE,
                   "unknown element '%s', expected tet10-blend, tet10, tet10-mean, tet4 or tet15",
                   name);
}

static const double dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* Product of the barycentric coordinates but `without` (-1: all four), times s: its gradient. */
static void bubble_gradient(const double L[4], int without, double s, double dN[3])
{
    memset(dN, 0, 3 * sizeof *dN);
    for (int d = 0; d < 4; d++) {
        double product = s;
        for (int a = 0; a < 4; a++)
            if (a != d && a != without)
                product *= L[a];
        for (int j = 0; j < 3 && d != without; j++)
            dN[j] += product * dL[d][j];
    }
}

void pm_element_shape_gradient(const struct pm_element_type *t, const double xi[3], double *dN)
{
    const double L[4] = {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
    if (t->npe == 4) {
        memcpy(dN, dL, sizeof dL);
        return;
    }
    pm_tet10_shape_gradient(xi, dN);
    for (int k = 10; k < t->npe; k++)
        bubble_gradient(L, k < 14 ? k - 10 : -1, k < 14 ? 27.0 : 256.0, dN + 3 * k);
}

/* ---- bubbles: one node for each face of the mesh, one for each cell ---- */

struct face {
    int32_t v[3];    /* vertices, ascending */
    ptrdiff_t place; /* 15 e + 10 + face of an element, or -1 - f of a boundary face */
};

static int compare(const void *a, const void *b)
{
    const struct face *f = a, *g = b;
    for (int i = 0; i < 3; i++)
        if (f->v[i] != g->v[i])
            return f->v[i] < g->v[i] ? -1 : 1;
    return (f->place > g->place) - (f->place < g->place);
}

static struct face face_of(int32_t a, int32_t b, int32_t c, ptrdiff_t place)
{
    struct face f = {{a, b, c}, place};
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < 2; i++)
            if (f.v[i] > f.v[i + 1]) {
                int32_t t = f.v[i];
                f.v[i] = f.v[i + 1];
                f.v[i + 1] = t;
            }
    return f;
}

static enum pm_status number_bubbles(struct pm_space *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t n = 4 * s->ne + s->nf;
    struct face *face = NULL;
    PM_TRY(PM_NEW(face, n, err));
    for (ptrdiff_t e = 0; e < s->ne; e++)
        for (int k = 0; k < 4; k++) {
            const int32_t *t = s->tet + 15 * e;
            face[4 * e + k] =
                face_of(t[(k + 1) % 4], t[(k + 2) % 4], t[(k + 3) % 4], 15 * e + 10 + k);
        }
    for (ptrdiff_t f = 0; f < s->nf; f++) {
        const int32_t *t = s->tri + 7 * f;
        face[4 * s->ne + f] = face_of(t[0], t[1], t[2], -1 - f);
    }
    qsort(face, (size_t)n, sizeof *face, compare);
    for (ptrdiff_t k = 0; k < n; k++) {
        if (k == 0 || memcmp(face[k].v, face[k - 1].v, sizeof face[k].v) != 0)
            s->nn++;
        if (face[k].place >= 0)
            s->tet[face[k].place] = (int32_t)(s->nn - 1);
        else
            s->tri[7 * (-1 - face[k].place) + 6] = (int32_t)(s->nn - 1);
    }
    for (ptrdiff_t e = 0; e < s->ne; e++)
        s->tet[15 * e + 14] = (int32_t)s->nn++;
done:
    pm_free(face);
    return status;
}

enum pm_status pm_space_new(const struct pm_mesh *mesh, const struct pm_element_type *type,
                            struct pm_space *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t npe = type->npe, npf = type->npf;
    *s = (struct pm_space){.type = type, .nn = mesh->nn, .ne = mesh->ne, .nf = mesh->nf};
    PM_TRY(PM_NEW(s->tet, npe * s->ne, err));
    PM_TRY(PM_NEW(s->tri, npf * s->nf, err));
    for (ptrdiff_t e = 0; e < s->ne; e++)
        for (ptrdiff_t a = 0; a < npe && a < mesh->npe; a++)
            s->tet[npe * e + a] = mesh->tet[mesh->npe * e + a];
    for (ptrdiff_t f = 0; f < s->nf; f++)
        for (ptrdiff_t a = 0; a < npf && a < mesh->npf; a++)
            s->tri[npf * f + a] = mesh->tri[mesh->npf * f + a];
    if (npe > 10)
        PM_TRY(number_bubbles(s, err));
    PM_TRY(PM_NEW(s->x, 3 * s->nn, err));
    memcpy(s->x, mesh->x, 3 * (size_t)mesh->nn * sizeof *s->x);
done:
    if (status != PM_OK)
        pm_space_release(s);
    return status;
}

void pm_space_release(struct pm_space *s)
{
    pm_free(s->tet);
    pm_free(s->tri);
    pm_free(s->x);
    *s = (struct pm_space){0};
}
