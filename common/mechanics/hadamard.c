#include "common/mechanics/hadamard.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/tensor.h"
#include "common/mechanics/tet10.h"

enum { NODES = PM_MOST_NODES, NQ = PM_MOST_POINTS, NF = PM_TRI_POINTS, ALL = NQ + NF };

/* The element at a face: its points, those of the quadrature first, then those of the face (one
 * lane each). */
struct side {
    ptrdiff_t e;
    int nq; /* points of the quadrature */
    double xi[ALL][3], w[ALL], dN[ALL][3 * NODES], phi[PM_MOST_MODES * ALL];
    double F[ALL][9], C[ALL][9], pressure[ALL]; /* cof F; kappa (b (J - 1) + (1 - b) bar) [MPa] */
};

/* Boundary faces by their smallest vertex, and the element at each. */
static enum pm_status find_elements(const struct pm_model *m, ptrdiff_t *element,
                                    struct pm_err *err)
{
    enum pm_status status;
    const struct pm_space *s = &m->space;
    ptrdiff_t npf = m->cavity.n, npe = s->type->npe, *first = NULL, *next = NULL;
    PM_TRY(PM_NEW(first, s->nn, err));
    PM_TRY(PM_NEW(next, s->nf, err));
    for (ptrdiff_t a = 0; a < s->nn; a++)
        first[a] = -1;
    for (ptrdiff_t f = 0; f < s->nf; f++) {
        const int32_t *t = s->tri + npf * f;
        int32_t low = t[0] < t[1] ? t[0] : t[1];
        low = t[2] < low ? t[2] : low;
        next[f] = first[low];
        first[low] = f;
    }
    for (ptrdiff_t e = 0; e < s->ne; e++)
        for (int a = 0; a < 4; a++) {
            const int32_t *v = s->tet + npe * e;
            for (ptrdiff_t f = first[v[a]]; f >= 0; f = next[f]) {
                int shared = 0;
                for (int i = 0; i < 12; i++)
                    shared += s->tri[npf * f + i / 4] == v[i % 4];
                if (shared == 3)
                    element[f] = e;
            }
        }
done:
    pm_free(first);
    pm_free(next);
    return status;
}

/* Reference points of the face's rule in the element. */
static void face_points(const struct pm_model *m, ptrdiff_t f, struct side *s)
{
    const int32_t *v = m->space.tet + m->space.type->npe * s->e,
                  *t = m->space.tri + m->cavity.n * f;
    memset(s->xi + s->nq, 0, NF * sizeof s->xi[0]);
    for (int q = 0; q < NF; q++) {
        const double L[3] = {1 - pm_tri_xi[q][0] - pm_tri_xi[q][1], pm_tri_xi[q][0],
                             pm_tri_xi[q][1]};
        for (int k = 0; k < 3; k++)
            for (int a = 1; a < 4; a++)
                if (v[a] == t[k])
                    s->xi[s->nq + q][a - 1] = L[k];
    }
}

/* kappa (b j + (1 - b) bar j) at all points. */
static void blend(const struct pm_model *m, const struct side *s, const double *j, double *out)
{
    int n = s->nq + NF;
    double bar[ALL] = {0};
    for (int k = 0; k < m->space.type->modes; k++) {
        const double *phi = s->phi + k * n;
        double sum = 0.0;
        for (int q = 0; q < s->nq; q++)
            sum += s->w[q] * phi[q] * j[q];
        for (int q = 0; q < n; q++)
            bar[q] += sum * phi[q];
    }
    for (int q = 0; q < n; q++)
        out[q] = m->law.kappa * (m->blend * j[q] + (1.0 - m->blend) * bar[q]);
}

static void deform(const struct pm_model *m, const struct pm_config *c, ptrdiff_t f, struct side *s)
{
    const struct pm_element_type *t = m->space.type;
    const int32_t *v = m->space.tet + t->npe * s->e;
    double X[3 * NODES], u[3 * NODES], j[ALL];
    s->nq = t->nq;
    memcpy(s->xi, t->xi, (size_t)t->nq * sizeof s->xi[0]);
    face_points(m, f, s);
    pm_gather(v, t->npe, m->space.x, X);
    pm_gather(v, t->npe, c->u, u);
    for (int q = 0; q < s->nq + NF; q++) {
        double det = pm_element_gradients(t, X, s->xi[q], s->dN[q]);
        s->w[q] = q < s->nq ? t->weight[q] * det : 0.0;
        pm_gradient(t->npe, u, s->dN[q], s->F[q]);
        j[q] = pm_det_minus_one(s->F[q]);
        for (int i = 0; i < 9; i += 4)
            s->F[q][i] += 1.0;
        pm_cofactor(s->F[q], s->C[q]);
    }
    pm_element_modes(t, s->nq + NF, (const double(*)[3])s->xi, s->w, s->phi);
    blend(m, s, j, s->pressure);
}

static void gradients(const struct pm_model *m, const struct side *s, const double *nodal,
                      double G[ALL][9])
{
    double local[3 * NODES];
    ptrdiff_t npe = m->space.type->npe;
    pm_gather(m->space.tet + npe * s->e, npe, nodal, local);
    for (int q = 0; q < s->nq + NF; q++)
        pm_gradient((int)npe, local, s->dN[q], G[q]);
}

/* Values at the points of the face as lanes. */
static void to_lanes(const struct side *s, double T[ALL][9], pm_lanes out[9])
{
    for (int i = 0; i < 9; i++)
        for (int l = 0; l < PM_LANES; l++)
            out[i][l] = T[s->nq + (l < NF ? l : 0)][i];
}

/* H : A_iso : G at the points of the face. */
static void isochoric(const struct pm_model *m, struct side *s, double H[ALL][9], double G[ALL][9],
                      double out[NF])
{
    pm_lanes F[9], h[9], g[9], Ah[9];
    to_lanes(s, s->F, F);
    to_lanes(s, H, h);
    to_lanes(s, G, g);
    pm_law_apply(&m->law, F, h, Ah);
    pm_lanes sum = pm_lanes_dot9(Ah, g);
    for (int q = 0; q < NF; q++)
        out[q] = sum[q];
}

/* The first line of L_w at the points of the face; r: chamber there or -1. */
static void first_line(const struct pm_model *m, const struct pm_hadamard *h,
                       const struct pm_objective *w, ptrdiff_t r, struct side *s, double L[NF])
{
    pm_lanes F[9], P[9], W;
    double G[ALL][9];
    to_lanes(s, s->F, F);
    pm_law_stress(&m->law, F, &W, P);
    gradients(m, s, h->g, G);
    for (int q = 0; q < NF; q++) {
        const double *C = s->C[s->nq + q], *g = G[s->nq + q];
        L[q] = (s->pressure[s->nq + q] + (r >= 0 ? h->p[r] : 0.0)) * pm_dot9(C, g);
        for (int i = 0; i < 9; i++)
            L[q] += P[i][q] * g[i];
        if (r >= 0 && w->V[r] != 0.0)
            L[q] -= w->V[r] * pm_dot9(C, s->F[s->nq + q]) / 3.0;
    }
}

/* What chamber col->s adds. */
static void second_line(const struct pm_model *m, const struct pm_hadamard *h,
                        const struct pm_objective *w, const struct pm_hadamard_column *col,
                        ptrdiff_t r, struct side *s, double L[NF])
{
    double G[ALL][9], H[ALL][9], j[ALL], p[ALL], iso[NF];
    gradients(m, s, col->v, G);
    gradients(m, s, col->h, H);
    for (int q = 0; q < s->nq + NF; q++)
        j[q] = pm_dot9(s->C[q], H[q]);
    blend(m, s, j, p);
    isochoric(m, s, H, G, iso);
    for (int q = 0; q < NF; q++) {
        int k = s->nq + q;
        double FH[9], CG = pm_dot9(s->C[k], G[k]);
        pm_cross9(s->F[k], H[k], FH);
        L[q] +=
            iso[q] + p[k] * CG + (s->pressure[k] + (r >= 0 ? h->p[r] : 0.0)) * pm_dot9(FH, G[k]);
        if (r == col->s)
            L[q] += h->scale * CG;
        if (r >= 0)
            L[q] -= w->C[r][col->s] * j[k];
    }
}

/* D_a += sum_q w N_a L (X_,1 x X_,2). */
static void integrate(const struct pm_model *m, ptrdiff_t f, const double L[NF], double *D)
{
    const int n = m->cavity.n < 7 ? m->cavity.n : 6; /* bubbles do not shape the face */
    const int32_t *t = m->space.tri + m->cavity.n * f;
    double X[3 * PM_MOST_FACE_NODES];
    struct pm_cavity rule;
    pm_cavity_set(&rule, n);
    pm_gather(t, n, m->space.x, X);
    for (int q = 0; q < NF; q++) {
        double X1[3] = {0}, X2[3] = {0}, area[3];
        for (int a = 0; a < n; a++)
            for (int i = 0; i < 3; i++) {
                X1[i] += rule.dN[q][2 * a] * X[3 * a + i];
                X2[i] += rule.dN[q][2 * a + 1] * X[3 * a + i];
            }
        pm_vcross(X1, X2, area);
        for (int a = 0; a < n; a++)
            for (int i = 0; i < 3; i++)
                D[3 * (ptrdiff_t)t[a] + i] += rule.weight[q] * rule.N[q][a] * L[q] * area[i];
    }
}

enum pm_status pm_hadamard(const struct pm_model *m, const struct pm_config *c,
                           const struct pm_hadamard *h, const struct pm_objective *w, double *D,
                           struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t *element = NULL;
    memset(D, 0, 3 * (size_t)m->nn * sizeof *D);
    PM_TRY(PM_NEW(element, m->space.nf, err));
    PM_TRY(find_elements(m, element, err));
    for (ptrdiff_t f = 0; f < m->space.nf; f++) {
        ptrdiff_t r = pm_model_chamber(m, f);
        struct side s = {.e = element[f]};
        double L[NF];
        if (m->mesh->tri_tag[f] < 0)
            continue;
        deform(m, c, f, &s);
        first_line(m, h, w, r, &s, L);
        for (ptrdiff_t k = 0; k < h->n; k++)
            second_line(m, h, w, &h->column[k], r, &s, L);
        integrate(m, f, L, D);
    }
done:
    pm_free(element);
    return status;
}
