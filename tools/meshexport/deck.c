#include "tools/meshexport/deck.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

/* Fields of a deck are read from 20 characters. */
#define NUMBER "%.13e"

/* [kPa / MPa]: the deck is in mm, kPa and mN. CalculiX takes a residual below 1e-6 for zero and a
 * D1 below 1e-10 for a wish to be given one, whatever the unit. */
static const double KILOPASCAL = 1e3;

/* The second step holds the load until the result stands in the digits that are printed (seven):
 * CalculiX stops at corrections of 1 %, and its convergence is linear, with a factor of 0.3 to 0.8.
 * FIELD: residual over mean force, and correction over the displacement of this step, itself about
 * 1 % of the whole; as many iterations as that takes. */
static const char hold[] = "** Hold the load until the digits stand.\n"
                           "*STEP, NLGEOM, INC=1\n"
                           "*STATIC\n"
                           "1.,1.\n"
                           "*CONTROLS, PARAMETERS=FIELD\n"
                           "1.e-6,1.e-5,,,1.e-6,1.e-9,1.e-5,1.e-9\n"
                           "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n"
                           "200,400,400,400,400,4,,5,,\n"
                           "0.25,0.5,0.75,0.85,,,1.5\n";

enum pm_status deck_node_sets(const struct pm_mesh *mesh, unsigned char **sets, struct pm_err *err)
{
    unsigned char *s = pm_calloc(mesh->nn, sizeof *s, err);
    if (s == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t f = 0; f < mesh->nf; f++) {
        const int32_t tag = mesh->tri_tag[f];
        const unsigned bit = tag == PM_FACE_BASE  ? DECK_BASE
                             : tag == PM_FACE_TIP ? DECK_TIP
                             : tag < PM_FACE_TIP  ? (unsigned)DECK_SYM << (PM_FACE_SYM_X - tag)
                                                  : 0;
        for (ptrdiff_t a = 0; a < mesh->npf; a++)
            s[mesh->tri[mesh->npf * f + a]] |= (unsigned char)bit;
    }
    for (ptrdiff_t a = 0; a < mesh->nn; a++)
        if ((s[a] & DECK_BASE) != 0)
            s[a] = DECK_BASE;
        else if ((s[a] & DECK_TIP) != 0)
            s[a] = DECK_TIP;
    *sets = s;
    return PM_OK;
}

/* ---- nodes and elements ---- */

static void write_nodes(const struct pm_mesh *m, int tip, FILE *out)
{
    fprintf(out, "*NODE, NSET=NALL\n");
    for (ptrdiff_t a = 0; a < m->nn; a++)
        fprintf(out, "%td," NUMBER "," NUMBER "," NUMBER "\n", a + 1, m->x[3 * a], m->x[3 * a + 1],
                m->x[3 * a + 2]);
    const double *r = m->reference_point;
    for (int i = 1; tip && i <= 2; i++)
        fprintf(out, "%td," NUMBER "," NUMBER "," NUMBER "\n", m->nn + i, r[0], r[1], r[2]);
}

/* Edges there (01)(12)(20)(03)(13)(23): the last two change places. */
static void write_elements(const struct pm_mesh *m, FILE *out)
{
    static const int order[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
    fprintf(out, "*ELEMENT, TYPE=%s, ELSET=BODY\n", m->npe == 10 ? "C3D10" : "C3D4");
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        fprintf(out, "%td", e + 1);
        for (ptrdiff_t a = 0; a < m->npe; a++)
            fprintf(out, ",%d", m->tet[m->npe * e + order[a]] + 1);
        fputc('\n', out);
    }
}

static void write_set(const char *name, const unsigned char *sets, unsigned bit, ptrdiff_t nn,
                      FILE *out)
{
    fprintf(out, "*NSET, NSET=%s\n", name);
    for (ptrdiff_t a = 0; a < nn; a++)
        if ((sets[a] & bit) != 0)
            fprintf(out, "%td,\n", a + 1);
}

/* ---- chamber surfaces: faces of elements ---- */

struct face {
    int32_t v[3]; /* vertices, ascending */
    int32_t element, number;
};

static void set_face(struct face *f, int32_t a, int32_t b, int32_t c)
{
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    f->v[0] = c < low ? c : low;
    f->v[2] = c > high ? c : high;
    f->v[1] = c < low ? low : c > high ? high : c;
}

static int compare_faces(const void *a, const void *b)
{
    const struct face *f = a, *g = b;
    for (int i = 0; i < 3; i++)
        if (f->v[i] != g->v[i])
            return f->v[i] < g->v[i] ? -1 : 1;
    return 0;
}

static enum pm_status sorted_faces(const struct pm_mesh *m, struct face **faces, struct pm_err *err)
{
    static const int vertex[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}; /* S1 to S4 */
    struct face *f = pm_calloc(4 * m->ne, sizeof *f, err);
    if (f == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t e = 0; e < m->ne; e++)
        for (int k = 0; k < 4; k++) {
            const int32_t *t = m->tet + m->npe * e;
            set_face(&f[4 * e + k], t[vertex[k][0]], t[vertex[k][1]], t[vertex[k][2]]);
            f[4 * e + k].element = (int32_t)e;
            f[4 * e + k].number = k + 1;
        }
    qsort(f, 4 * (size_t)m->ne, sizeof *f, compare_faces);
    *faces = f;
    return PM_OK;
}

static enum pm_status write_chambers(const struct pm_mesh *m, FILE *out, struct pm_err *err)
{
    enum pm_status status;
    struct face *faces = NULL;
    PM_TRY(sorted_faces(m, &faces, err));
    for (ptrdiff_t r = 1; r <= m->nc; r++) {
        fprintf(out, "*SURFACE, NAME=CHAMBER%td, TYPE=ELEMENT\n", r);
        for (ptrdiff_t k = 0; k < m->nf; k++) {
            const int32_t *t = m->tri + m->npf * k;
            struct face key = {.element = 0}, *found;
            if (m->tri_tag[k] != r)
                continue;
            set_face(&key, t[0], t[1], t[2]);
            found = bsearch(&key, faces, 4 * (size_t)m->ne, sizeof *faces, compare_faces);
            if (found == NULL)
                PM_TRY(pm_fail(err, PM_INPUT,
                               "boundary face %td of chamber %td belongs to no element", k, r));
            fprintf(out, "%d,S%d\n", found->element + 1, found->number);
        }
    }
done:
    pm_free(faces);
    return status;
}

/* ---- material ---- */

enum { MOST_OGDEN_TERMS = 3 };

enum pm_status deck_check(const struct pm_mesh *mesh, const char *path, struct pm_err *err)
{
    const struct pm_case *c = &mesh->pcase;
    const int ogden = strcmp(c->law, "ogden") == 0;
    if (!ogden && strcmp(c->law, "neo-hookean") != 0 && strcmp(c->law, "mooney-rivlin") != 0 &&
        strcmp(c->law, "yeoh") != 0)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': law '%s', expected one that CalculiX has: neo-hookean, "
                       "mooney-rivlin, yeoh or ogden",
                       path, c->law);
    if (ogden && c->nlaw_parameter > 2 * MOST_OGDEN_TERMS)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': law 'ogden' of %td terms, CalculiX takes at most %d", path,
                       c->nlaw_parameter / 2, (int)MOST_OGDEN_TERMS);
    if (mesh->nc == 0)
        return pm_fail(err, PM_INPUT, "cannot use '%s': no chambers, expected at least one", path);
    return PM_OK;
}

/* Volumetric energy sum_i (J - 1)^(2 i) / D_i there, kappa/2 (J - 1)^2 here: D2 and D3 are very
 * large, zero would be replaced. Ogden: 2 mu_i/alpha_i^2 there, mu_i/alpha_i here. */
static void write_material(const struct pm_case *c, FILE *out)
{
    const double *k = c->law_parameter, s = KILOPASCAL, D1 = 2 / (s * c->kappa);
    fprintf(out, "*MATERIAL, NAME=RUBBER\n");
    if (strcmp(c->law, "neo-hookean") == 0) {
        fprintf(out, "*HYPERELASTIC, NEO HOOKE\n" NUMBER "," NUMBER "\n", s * k[0] / 2, D1);
    } else if (strcmp(c->law, "mooney-rivlin") == 0) {
        fprintf(out, "*HYPERELASTIC, MOONEY-RIVLIN\n" NUMBER "," NUMBER "," NUMBER "\n", s * k[0],
                s * k[1], D1);
    } else if (strcmp(c->law, "yeoh") == 0) {
        fprintf(out,
                "*HYPERELASTIC, YEOH\n" NUMBER "," NUMBER "," NUMBER "," NUMBER ",1.e30,1.e30\n",
                s * k[0], s * k[1], s * k[2], D1);
    } else {
        const ptrdiff_t n = c->nlaw_parameter / 2;
        fprintf(out, "*HYPERELASTIC, OGDEN, N=%td\n", n);
        for (ptrdiff_t i = 0; i < n; i++)
            fprintf(out, NUMBER "," NUMBER ",", s * k[2 * i] * k[2 * i + 1] / 2, k[2 * i + 1]);
        fprintf(out, NUMBER "%s\n", D1, n == 1 ? "" : n == 2 ? ",1.e30" : ",1.e30\n1.e30");
    }
    fprintf(out, "*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n");
}

/* ---- supports ---- */

static void write_supports(const struct pm_mesh *m, const unsigned char *sets, int tip, FILE *out)
{
    const ptrdiff_t ref = m->nn + 1, rot = m->nn + 2;
    unsigned planes = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        if (m->tri_tag[f] <= PM_FACE_SYM_X)
            planes |= 1u << (PM_FACE_SYM_X - m->tri_tag[f]);
    write_set("BASE", sets, DECK_BASE, m->nn, out);
    fprintf(out, "*BOUNDARY\nBASE,1,3\n");
    if (tip) {
        write_set("TIP", sets, DECK_TIP, m->nn, out);
        fprintf(out, "*RIGID BODY, NSET=TIP, REF NODE=%td, ROT NODE=%td\n", ref, rot);
    }
    for (int axis = 0; axis < 3; axis++) {
        const char name[] = {'S', 'Y', 'M', (char)('X' + axis), '\0'};
        if ((planes >> axis & 1u) == 0)
            continue;
        write_set(name, sets, (unsigned)DECK_SYM << axis, m->nn, out);
        fprintf(out, "*BOUNDARY\n%s,%d,%d\n", name, axis + 1, axis + 1);
        for (int i = 0; tip && i < 3; i++)
            fprintf(out, "%td,%d,%d\n", i == axis ? ref : rot, i + 1, i + 1);
    }
}

static const char print[] = "*NODE PRINT, NSET=NALL, FREQUENCY=100000\nU\n*END STEP\n";

enum pm_status deck_write(const struct deck *d, FILE *out, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = d->mesh;
    unsigned char *sets = NULL;
    int tip = 0;
    PM_TRY(deck_node_sets(m, &sets, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        tip |= sets[a] == DECK_TIP;
    fprintf(out, "*HEADING\n%s\n", d->title);
    write_nodes(m, tip, out);
    write_elements(m, out);
    PM_TRY(write_chambers(m, out, err));
    write_material(&m->pcase, out);
    write_supports(m, sets, tip, out);
    fprintf(out, "*STEP, NLGEOM, INC=100000\n*STATIC\n" NUMBER ",1.,1.e-6," NUMBER "\n*DSLOAD\n",
            1.0 / (double)d->steps, 1.0 / (double)d->steps);
    for (ptrdiff_t r = 0; r < m->nc; r++)
        fprintf(out, "CHAMBER%td,P," NUMBER "\n", r + 1, d->pressure[r] * m->pcase.mu * KILOPASCAL);
    fprintf(out, "%s%s%s", print, hold, print);
done:
    pm_free(sets);
    return status;
}
