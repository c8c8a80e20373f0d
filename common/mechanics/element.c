#include "common/mechanics/element.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/tensor.h"

enum { NQ = PM_MOST_POINTS, NODES = PM_MOST_NODES };

/* Deformation at the points: F = I + grad u, C = cof F, J - 1 without cancellation, and its
 * projection. */
struct kinematics {
    pm_lanes F[NQ][9], C[NQ][9], Jm1[NQ], bar[NQ];
};

double pm_element_blend(const struct pm_element_type *type, const struct pm_law *law)
{
    return type->stiffness < 0.0 ? 1.0 : fmin(1.0, type->stiffness * law->mu / law->kappa);
}

/* ---- geometry ---- */

void pm_element_modes(const struct pm_element_type *t, int n, const double (*xi)[3],
                      const double *w, double *phi)
{
    for (int k = 0; k < t->modes; k++) {
        double *p = phi + k * n, norm = 0.0;
        for (int q = 0; q < n; q++)
            p[q] = k == 0 ? 1.0 : xi[q][k - 1];
        for (int l = 0; l < k; l++) {
            double s = 0.0;
            for (int q = 0; q < n; q++)
                s += w[q] * p[q] * phi[l * n + q];
            for (int q = 0; q < n; q++)
                p[q] -= s * phi[l * n + q];
        }
        for (int q = 0; q < n; q++)
            norm += w[q] * p[q] * p[q];
        for (int q = 0; q < n; q++)
            p[q] /= sqrt(norm);
    }
}

double pm_element_gradients(const struct pm_element_type *t, const double *X, const double xi[3],
                            double *dN)
{
    double ref[3 * NODES], D[9], C[9];
    pm_element_shape_gradient(t, xi, ref);
    pm_gradient(t->npe, X, ref, D); /* D_iJ = dX_i/dxi_J */
    double det = pm_cofactor(D, C);
    /* dN/dX_i = dN/dxi_J (D^-1)_Ji, (D^-1)_Ji = C_iJ / det */
    for (int a = 0; a < t->npe; a++)
        pm_mul3(C, ref + 3 * a, dN + 3 * a);
    for (int k = 0; k < 3 * t->npe; k++)
        dN[k] /= det;
    return det;
}

double pm_element_geometry(const struct pm_element_type *t, const double *X, int lane, pm_lanes *dN,
                           pm_lanes *w, pm_lanes *phi)
{
    double low = INFINITY, weight[NQ], mode[PM_MOST_MODES * NQ] = {0};
    for (int q = 0; q < t->nq; q++) {
        double at[3 * NODES], det = pm_element_gradients(t, X, t->xi[q], at);
        low = fmin(low, det);
        weight[q] = t->weight[q] * det;
        w[q][lane] = weight[q];
        for (int k = 0; k < 3 * t->npe; k++)
            dN[3 * t->npe * q + k][lane] = at[k];
    }
    if (low > 0.0) {
        pm_element_modes(t, t->nq, t->xi, weight, mode);
        for (int k = 0; k < t->modes * t->nq; k++)
            phi[k][lane] = mode[k];
    }
    return low;
}

/* ---- kinematics ---- */

static const pm_lanes *gradients(const struct pm_element *el, int q)
{
    return el->dN + 3 * el->type->npe * q;
}

/* bar = sum_k phi_k (sum_q w phi_k j): the projection of point values j (nq) on the modes. */
static void project(const struct pm_element *el, const pm_lanes *j, pm_lanes *bar)
{
    int nq = el->type->nq;
    memset(bar, 0, (size_t)nq * sizeof *bar);
    for (int k = 0; k < el->type->modes; k++) {
        const pm_lanes *phi = el->phi + k * nq;
        pm_lanes s = {0};
        for (int q = 0; q < nq; q++)
            s += el->w[q] * phi[q] * j[q];
        for (int q = 0; q < nq; q++)
            bar[q] += s * phi[q];
    }
}

static void deform(const struct pm_element *el, const pm_lanes *u, struct kinematics *k)
{
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes *F = k->F[q];
        pm_lanes_gradient(el->type->npe, u, gradients(el, q), F);
        k->Jm1[q] = pm_lanes_det_minus_one(F);
        F[0] += 1.0;
        F[4] += 1.0;
        F[8] += 1.0;
        pm_lanes_cofactor(F, k->C[q]);
    }
    project(el, k->Jm1, k->bar);
}

/* kappa (b j + (1 - b) bar j): with U = kappa/2 (J - 1)^2 the pressure at J - 1, and its variations
 * at those of J. */
static pm_lanes blend(const struct pm_element *el, pm_lanes j, pm_lanes bar)
{
    return el->law->kappa * (el->blend * j + (1.0 - el->blend) * bar);
}

/* f_a += w S grad N_a */
static void scatter(int npe, pm_lanes w, const pm_lanes S[9], const pm_lanes *dN, pm_lanes *f)
{
    pm_lanes wS[9];
    for (int k = 0; k < 9; k++)
        wS[k] = w * S[k];
    for (int a = 0; a < npe; a++)
        for (int i = 0; i < 3; i++)
            f[3 * a + i] += wS[3 * i] * dN[3 * a] + wS[3 * i + 1] * dN[3 * a + 1] +
                            wS[3 * i + 2] * dN[3 * a + 2];
}

static void clear(const struct pm_element *el, pm_lanes *f)
{
    memset(f, 0, 3 * (size_t)el->type->npe * sizeof *f);
}

void pm_element_energy(const struct pm_element *el, const pm_lanes *u, pm_lanes *f,
                       pm_lanes *energy, pm_lanes *min_det)
{
    struct kinematics k;
    double b = el->blend, kappa = el->law->kappa;
    pm_lanes E = {0}, low;
    deform(el, u, &k);
    low = 1.0 + k.Jm1[0];
    for (int q = 0; q < el->type->nq; q++)
        for (int l = 0; l < PM_LANES; l++)
            low[l] = fmin(low[l], 1.0 + k.Jm1[q][l]);
    if (f != NULL)
        clear(el, f);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes P[9], W;
        pm_law_stress(el->law, k.F[q], &W, f != NULL ? P : NULL);
        E += el->w[q] *
             (W + 0.5 * kappa * (b * k.Jm1[q] * k.Jm1[q] + (1.0 - b) * k.bar[q] * k.bar[q]));
        if (f == NULL)
            continue;
        pm_lanes_axpy9(blend(el, k.Jm1[q], k.bar[q]), k.C[q], P);
        scatter(el->type->npe, el->w[q], P, gradients(el, q), f);
    }
    for (int l = 0; l < PM_LANES; l++)
        (*energy)[l] = low[l] > 0.0 ? E[l] : (double)INFINITY;
    *min_det = low;
}

/* ---- tangent ---- */

/* T_(iI)j = w sum_J A_iIjJ n_J */
static void push(pm_lanes w, const pm_lanes A[81], const pm_lanes n[3], pm_lanes T[27])
{
    const pm_lanes m[3] = {w * n[0], w * n[1], w * n[2]};
    for (int k = 0; k < 9; k++)
        for (int j = 0; j < 3; j++)
            T[3 * k + j] =
                A[9 * k + 3 * j] * m[0] + A[9 * k + 3 * j + 1] * m[1] + A[9 * k + 3 * j + 2] * m[2];
}

/* K_ij += m_I T_(iI)j */
static void pull(const pm_lanes m[3], const pm_lanes T[27], pm_lanes K[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            K[3 * i + j] += m[0] * T[9 * i + j] + m[1] * T[9 * i + 3 + j] + m[2] * T[9 * i + 6 + j];
}

/* Blocks of column b, points first: they stay in registers. */
static void add_column(const struct pm_element *el, pm_lanes A[][81], int b, pm_lanes *K)
{
    pm_lanes T[NQ][27];
    int nq = el->type->nq;
    for (int q = 0; q < nq; q++)
        push(el->w[q], A[q], gradients(el, q) + 3 * b, T[q]);
    for (int a = 0; a <= b; a++) {
        pm_lanes block[9];
        memset(block, 0, sizeof block);
        for (int q = 0; q < nq; q++)
            pull(gradients(el, q) + 3 * a, T[q], block);
        memcpy(K + 9 * (b * (b + 1) / 2 + a), block, sizeof block);
    }
}

/* K += (1 - b) kappa sum_k B_k B_k^T, B_k = sum_q w phi_k C grad N */
static void add_modes(const struct pm_element *el, const struct kinematics *k, pm_lanes *K)
{
    double s = (1.0 - el->blend) * el->law->kappa;
    int npe = el->type->npe, nq = el->type->nq;
    for (int m = 0; m < el->type->modes; m++) {
        pm_lanes B[3 * NODES];
        memset(B, 0, sizeof B);
        for (int q = 0; q < nq; q++)
            scatter(npe, el->w[q] * el->phi[m * nq + q], k->C[q], gradients(el, q), B);
        for (int b = 0; b < npe; b++)
            for (int j = 0; j < 3; j++) {
                pm_lanes t = s * B[3 * b + j];
                for (int a = 0; a <= b; a++)
                    for (int i = 0; i < 3; i++)
                        K[9 * (b * (b + 1) / 2 + a) + 3 * i + j] += t * B[3 * a + i];
            }
    }
}

/* S = F^-1 P, symmetric: 11 22 33 12 23 13. */
static void second_stress(const struct kinematics *k, int q, const pm_lanes P[9], pm_lanes S[6])
{
    pm_lanes j = 1.0 / (1.0 + k->Jm1[q]);
    for (int i = 0; i < 6; i++) {
        int I = i % 3, J = i < 3 ? I : (I + 1) % 3;
        const pm_lanes *C = k->C[q];
        S[i] = j * (C[I] * P[J] + C[3 + I] * P[3 + J] + C[6 + I] * P[6 + J]);
    }
}

/* The geometric part of A, delta_ij S_IJ, with the independent stresses in place of those at F. */
static void replace_stress(const struct pm_element *el, const struct kinematics *k, int q,
                           const pm_lanes mixed[PM_MIXED], pm_lanes A[81])
{
    pm_lanes W, P[9], S[6];
    pm_law_stress(el->law, k->F[q], &W, P);
    pm_lanes_axpy9(mixed[0], k->C[q], P);
    second_stress(k, q, P, S);
    for (int n = 0; n < 6; n++) {
        int I = n % 3, J = n < 3 ? I : (I + 1) % 3;
        pm_lanes d = mixed[1 + n] - S[n];
        for (int i = 0; i < 3; i++) {
            A[9 * (3 * i + I) + 3 * i + J] += d;
            if (I != J)
                A[9 * (3 * i + J) + 3 * i + I] += d;
        }
    }
}

void pm_element_tangent(const struct pm_element *el, const pm_lanes *u, const pm_lanes *mixed,
                        pm_lanes *K)
{
    struct kinematics k;
    pm_lanes A[NQ][81];
    double bk = el->blend * el->law->kappa;
    deform(el, u, &k);
    for (int q = 0; q < el->type->nq; q++) {
        const pm_lanes *s = mixed != NULL ? mixed + PM_MIXED * q : NULL;
        pm_lanes X[81], pi = s != NULL ? s[0] : blend(el, k.Jm1[q], k.bar[q]);
        pm_law_tangent(el->law, k.F[q], A[q]);
        if (s != NULL)
            replace_stress(el, &k, q, s, A[q]);
        pm_lanes_cross_matrix(k.F[q], X);
        for (int m = 0; m < 9; m++) {
            pm_lanes c = bk * k.C[q][m];
            for (int n = 0; n < 9; n++)
                A[q][9 * m + n] += pi * X[9 * m + n] + c * k.C[q][n];
        }
    }
    for (int b = 0; b < el->type->npe; b++)
        add_column(el, A, b, K);
    if (el->blend < 1.0)
        add_modes(el, &k, K);
}

/* dS = F^-1 (A:G + dpi C + pi F x G - G S), S of the stress at F. */
static void stress_increment(const struct pm_element *el, const struct kinematics *k, int q,
                             const pm_lanes G[9], pm_lanes pi, pm_lanes dpi, pm_lanes S[6])
{
    pm_lanes W, P[9], dP[9], FG[9], dS[6];
    pm_law_stress(el->law, k->F[q], &W, P);
    pm_lanes_axpy9(pi, k->C[q], P);
    second_stress(k, q, P, S);
    pm_law_apply(el->law, k->F[q], G, dP);
    pm_lanes_axpy9(dpi, k->C[q], dP);
    pm_lanes_cross9(k->F[q], G, FG);
    pm_lanes_axpy9(pi, FG, dP);
    for (int i = 0; i < 3; i++) {
        dP[3 * i] -= G[3 * i] * S[0] + G[3 * i + 1] * S[3] + G[3 * i + 2] * S[5];
        dP[3 * i + 1] -= G[3 * i] * S[3] + G[3 * i + 1] * S[1] + G[3 * i + 2] * S[4];
        dP[3 * i + 2] -= G[3 * i] * S[5] + G[3 * i + 1] * S[4] + G[3 * i + 2] * S[2];
    }
    second_stress(k, q, dP, dS);
    for (int n = 0; n < 6; n++)
        S[n] += dS[n];
}

void pm_element_mixed(const struct pm_element *el, const pm_lanes *u, const pm_lanes *du,
                      pm_lanes *mixed)
{
    struct kinematics k;
    pm_lanes G[NQ][9], dJ[NQ] = {{0}}, bar[NQ];
    deform(el, u, &k);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes_gradient(el->type->npe, du, gradients(el, q), G[q]);
        dJ[q] = pm_lanes_dot9(k.C[q], G[q]);
    }
    project(el, dJ, bar);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes pi = blend(el, k.Jm1[q], k.bar[q]), dpi = blend(el, dJ[q], bar[q]);
        mixed[PM_MIXED * q] = pi + dpi;
        stress_increment(el, &k, q, G[q], pi, dpi, mixed + PM_MIXED * q + 1);
    }
}

/* ---- contractions ---- */

void pm_element_apply(const struct pm_element *el, const pm_lanes *u, const pm_lanes *v,
                      pm_lanes *f)
{
    struct kinematics k;
    pm_lanes G[NQ][9], j1[NQ], t1[NQ];
    deform(el, u, &k);
    clear(el, f);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes_gradient(el->type->npe, v, gradients(el, q), G[q]);
        j1[q] = pm_lanes_dot9(k.C[q], G[q]);
    }
    project(el, j1, t1);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes S[9], FG[9];
        pm_law_apply(el->law, k.F[q], G[q], S);
        pm_lanes_cross9(k.F[q], G[q], FG);
        pm_lanes_axpy9(blend(el, j1[q], t1[q]), k.C[q], S);
        pm_lanes_axpy9(blend(el, k.Jm1[q], k.bar[q]), FG, S);
        scatter(el->type->npe, el->w[q], S, gradients(el, q), f);
    }
}

/* Gradients G, H of two directions with j1 = C:G and j2 = (F x G):H at the points, and their
 * projections t. */
struct variation {
    pm_lanes G[NQ][9], H[NQ][9], FG[NQ][9], FH[NQ][9], jG[NQ], jH[NQ], j2[NQ], tG[NQ], tH[NQ],
        t2[NQ];
};

static void vary(const struct pm_element *el, const struct kinematics *k, const pm_lanes *v,
                 const pm_lanes *w, struct variation *d)
{
    int npe = el->type->npe;
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes_gradient(npe, v, gradients(el, q), d->G[q]);
        pm_lanes_gradient(npe, w, gradients(el, q), d->H[q]);
        pm_lanes_cross9(k->F[q], d->G[q], d->FG[q]);
        pm_lanes_cross9(k->F[q], d->H[q], d->FH[q]);
        d->jG[q] = pm_lanes_dot9(k->C[q], d->G[q]);
        d->jH[q] = pm_lanes_dot9(k->C[q], d->H[q]);
        d->j2[q] = pm_lanes_dot9(d->FG[q], d->H[q]);
    }
    project(el, d->jG, d->tG);
    project(el, d->jH, d->tH);
    project(el, d->j2, d->t2);
}

/* Pressure and its variations at a point. */
struct volumetric {
    pm_lanes pi, piG, piH, piGH;
};

/* T(G, H) with the volumetric part piGH C + piG F x H + piH F x G + pi G x H. */
static void third_at(const struct pm_element *el, const struct kinematics *k,
                     const struct variation *d, int q, const struct volumetric *s, pm_lanes T[9])
{
    pm_lanes GH[9];
    pm_law_third(el->law, k->F[q], d->G[q], d->H[q], T);
    pm_lanes_cross9(d->G[q], d->H[q], GH);
    pm_lanes_axpy9(s->piGH, k->C[q], T);
    pm_lanes_axpy9(s->piG, d->FH[q], T);
    pm_lanes_axpy9(s->piH, d->FG[q], T);
    pm_lanes_axpy9(s->pi, GH, T);
}

void pm_element_third(const struct pm_element *el, const pm_lanes *u, const pm_lanes *v,
                      const pm_lanes *w, pm_lanes *f)
{
    struct kinematics k;
    struct variation d;
    deform(el, u, &k);
    vary(el, &k, v, w, &d);
    clear(el, f);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes T[9];
        const struct volumetric s = {blend(el, k.Jm1[q], k.bar[q]), blend(el, d.jG[q], d.tG[q]),
                                     blend(el, d.jH[q], d.tH[q]), blend(el, d.j2[q], d.t2[q])};
        third_at(el, &k, &d, q, &s, T);
        scatter(el->type->npe, el->w[q], T, gradients(el, q), f);
    }
}

/* ---- shape derivative ---- */

/* M_IJ += s A_iI B_iJ */
static void add_tprod(double s, const pm_lanes A[9], const pm_lanes B[9], pm_lanes M[9])
{
    for (int i = 0; i < 3; i++)
        for (int I = 0; I < 3; I++)
            for (int J = 0; J < 3; J++)
                M[3 * I + J] += s * A[3 * i + I] * B[3 * i + J];
}

static void add_trace(pm_lanes s, pm_lanes M[9])
{
    M[0] += s;
    M[4] += s;
    M[8] += s;
}

/* S = A:G of the pointwise part W_iso + b U. */
static void apply_pointwise(const struct pm_element *el, const struct kinematics *k, int q,
                            const pm_lanes G[9], const pm_lanes FG[9], pm_lanes jG, pm_lanes S[9])
{
    double bk = el->blend * el->law->kappa;
    pm_law_apply(el->law, k->F[q], G, S);
    pm_lanes_axpy9(bk * jG, k->C[q], S);
    pm_lanes_axpy9(bk * k->Jm1[q], FG, S);
}

/* Second-order part of the Eshelby-type tensor for one pair (v, h). The projected part depends on X
 * through the weights alone (w J is the deformed volume), as -(bar + bar^2/2) in the trace. */
static void shape_second(const struct pm_element *el, const struct kinematics *k, const pm_lanes *v,
                         const pm_lanes *h, pm_lanes M[NQ][9])
{
    struct variation d;
    double bk = el->blend * el->law->kappa, mk = (1.0 - el->blend) * el->law->kappa;
    vary(el, k, v, h, &d);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes AG[9], AH[9], T[9];
        const struct volumetric s = {bk * k->Jm1[q], bk * d.jG[q], bk * d.jH[q], bk * d.j2[q]};
        apply_pointwise(el, k, q, d.G[q], d.FG[q], d.jG[q], AG);
        apply_pointwise(el, k, q, d.H[q], d.FH[q], d.jH[q], AH);
        third_at(el, k, &d, q, &s, T);
        add_trace(pm_lanes_dot9(d.G[q], AH), M[q]);
        add_tprod(-1.0, k->F[q], T, M[q]);
        add_tprod(-1.0, d.G[q], AH, M[q]);
        add_tprod(-1.0, d.H[q], AG, M[q]);
        add_trace(-mk * (d.tG[q] * d.tH[q] + (1.0 + k->bar[q]) * d.t2[q]), M[q]);
    }
}

void pm_element_shape(const struct pm_element *el, const pm_lanes *u, const pm_lanes *g, int n,
                      const pm_lanes *v, const pm_lanes *h, pm_lanes *D)
{
    struct kinematics k;
    pm_lanes M[NQ][9], jG[NQ] = {{0}}, tG[NQ];
    double bk = el->blend * el->law->kappa, mk = (1.0 - el->blend) * el->law->kappa;
    int npe = el->type->npe;
    memset(M, 0, sizeof M);
    deform(el, u, &k);
    for (int q = 0; q < el->type->nq; q++) {
        pm_lanes G[9], FG[9], P[9], AG[9], W;
        pm_lanes_gradient(npe, g, gradients(el, q), G);
        pm_lanes_cross9(k.F[q], G, FG);
        jG[q] = pm_lanes_dot9(k.C[q], G);
        pm_law_stress(el->law, k.F[q], &W, P);
        pm_lanes_axpy9(bk * k.Jm1[q], k.C[q], P);
        apply_pointwise(el, &k, q, G, FG, jG[q], AG);
        add_trace(pm_lanes_dot9(P, G), M[q]);
        add_tprod(-1.0, k.F[q], AG, M[q]);
        add_tprod(-1.0, G, P, M[q]);
    }
    project(el, jG, tG);
    for (int q = 0; q < el->type->nq; q++)
        add_trace(-mk * (1.0 + k.bar[q]) * tG[q], M[q]);
    for (int r = 0; r < n; r++)
        shape_second(el, &k, v + 3 * npe * r, h + 3 * npe * r, M);
    clear(el, D);
    for (int q = 0; q < el->type->nq; q++)
        scatter(npe, el->w[q], M[q], gradients(el, q), D);
}
