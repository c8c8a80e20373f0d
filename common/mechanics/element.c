#include "common/mechanics/element.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/tensor.h"

enum { NQ = PM_TET_POINTS };

/* Deformation at the points: F = I + grad u, C = cof F, J - 1 without cancellation; the element
 * mean of J - 1. */
struct kinematics {
    double F[NQ][9], C[NQ][9], Jm1[NQ], mean, V;
};

enum pm_status pm_element_blend(const char *name, const struct pm_law *law, double *blend,
                                struct pm_err *err)
{
    double b = 2.0 * law->mu / law->kappa;
    if (strcmp(name, "tet10-blend") == 0)
        *blend = b < 1.0 ? b : 1.0;
    else if (strcmp(name, "tet10") == 0)
        *blend = 1.0;
    else if (strcmp(name, "tet10-mean") == 0)
        *blend = 0.0;
    else
        return pm_fail(err, PM_USAGE,
                       "unknown element '%s', expected tet10-blend, tet10 or tet10-mean", name);
    return PM_OK;
}

static void deform(const struct pm_element *el, const double *u, struct kinematics *k)
{
    k->mean = k->V = 0.0;
    for (int q = 0; q < NQ; q++) {
        double *F = k->F[q];
        pm_gradient(u, el->dN + 30 * q, F);
        k->Jm1[q] = pm_det_minus_one(F);
        F[0] += 1.0;
        F[4] += 1.0;
        F[8] += 1.0;
        pm_cofactor(F, k->C[q]);
        k->mean += el->w[q] * k->Jm1[q];
        k->V += el->w[q];
    }
    k->mean /= k->V;
}

/* U = kappa/2 (J - 1)^2: the pressure b U'(J_q) + (1 - b) U'(Jbar). */
static double pressure_at(const struct pm_element *el, const struct kinematics *k, int q)
{
    return el->law->kappa * (el->blend * k->Jm1[q] + (1.0 - el->blend) * k->mean);
}

/* f_a += w S grad N_a */
static void scatter(double w, const double S[9], const double *dN, double *f)
{
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++)
            f[3 * a + i] += w * (S[3 * i] * dN[3 * a] + S[3 * i + 1] * dN[3 * a + 1] +
                                 S[3 * i + 2] * dN[3 * a + 2]);
}

double pm_element_energy(const struct pm_element *el, const double *u, double *f, double *min_det)
{
    struct kinematics k;
    double b = el->blend, kappa = el->law->kappa, low = INFINITY, E;
    deform(el, u, &k);
    for (int q = 0; q < NQ; q++)
        low = fmin(low, 1.0 + k.Jm1[q]);
    *min_det = fmin(*min_det, low);
    if (!(low > 0.0))
        return INFINITY;
    E = 0.5 * (1.0 - b) * kappa * k.V * k.mean * k.mean;
    for (int q = 0; q < NQ; q++) {
        double P[9];
        E += el->w[q] * (pm_law_stress(el->law, k.F[q], f != NULL ? P : NULL) +
                         0.5 * b * kappa * k.Jm1[q] * k.Jm1[q]);
        if (f == NULL)
            continue;
        pm_axpy9(pressure_at(el, &k, q), k.C[q], P);
        scatter(el->w[q], P, el->dN + 30 * q, f);
    }
    return E;
}

/* K += w dN A dN for one point: blocks a <= b. */
static void add_point(double w, const double A[81], const double *dN, double *K)
{
    for (int b = 0; b < 10; b++) {
        double T[27]; /* T_(iI)j = sum_J A_iIjJ dN_bJ */
        const double *n = dN + 3 * b;
        for (int k = 0; k < 9; k++)
            for (int j = 0; j < 3; j++)
                T[3 * k + j] = w * (A[9 * k + 3 * j] * n[0] + A[9 * k + 3 * j + 1] * n[1] +
                                    A[9 * k + 3 * j + 2] * n[2]);
        for (int a = 0; a <= b; a++) {
            const double *m = dN + 3 * a;
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    K[30 * (3 * a + i) + 3 * b + j] +=
                        m[0] * T[9 * i + j] + m[1] * T[9 * i + 3 + j] + m[2] * T[9 * i + 6 + j];
        }
    }
}

void pm_element_tangent(const struct pm_element *el, const double *u, const double *pressure,
                        double *K)
{
    struct kinematics k;
    double kappa = el->law->kappa, B[30] = {0};
    deform(el, u, &k);
    memset(K, 0, 900 * sizeof *K);
    for (int q = 0; q < NQ; q++) {
        double A[81], X[81], pi = pressure != NULL ? pressure[q] : pressure_at(el, &k, q);
        pm_law_tangent(el->law, k.F[q], A);
        pm_cross_matrix(k.F[q], X);
        for (int m = 0; m < 81; m++)
            A[m] += pi * X[m] + el->blend * kappa * k.C[q][m / 9] * k.C[q][m % 9];
        add_point(el->w[q], A, el->dN + 30 * q, K);
        scatter(el->w[q], k.C[q], el->dN + 30 * q, B);
    }
    double s = (1.0 - el->blend) * kappa / k.V;
    for (int m = 0; m < 30; m++)
        for (int n = 3 * (m / 3); n < 30; n++)
            K[30 * m + n] += s * B[m] * B[n];
    for (int m = 0; m < 30; m++)
        for (int n = 0; n < m; n++)
            K[30 * m + n] = K[30 * n + m];
}

void pm_element_pressure(const struct pm_element *el, const double *u, const double *du,
                         double *pressure)
{
    struct kinematics k;
    double dJ[NQ], mean = 0.0;
    deform(el, u, &k);
    for (int q = 0; q < NQ; q++) {
        double G[9];
        pm_gradient(du, el->dN + 30 * q, G);
        dJ[q] = k.Jm1[q] + pm_dot9(k.C[q], G);
        mean += el->w[q] * dJ[q];
    }
    for (int q = 0; q < NQ; q++)
        pressure[q] = el->law->kappa * (el->blend * dJ[q] + (1.0 - el->blend) * mean / k.V);
}

void pm_element_apply(const struct pm_element *el, const double *u, const double *v, double *f)
{
    struct kinematics k;
    double G[NQ][9], j1[NQ], t1 = 0.0, b = el->blend, kappa = el->law->kappa;
    deform(el, u, &k);
    for (int q = 0; q < NQ; q++) {
        pm_gradient(v, el->dN + 30 * q, G[q]);
        j1[q] = pm_dot9(k.C[q], G[q]);
        t1 += el->w[q] * j1[q] / k.V;
    }
    for (int q = 0; q < NQ; q++) {
        double S[9], FG[9];
        pm_law_apply(el->law, k.F[q], G[q], S);
        pm_cross9(k.F[q], G[q], FG);
        pm_axpy9(kappa * (b * j1[q] + (1.0 - b) * t1), k.C[q], S);
        pm_axpy9(pressure_at(el, &k, q), FG, S);
        scatter(el->w[q], S, el->dN + 30 * q, f);
    }
}

/* Gradients G, H of two directions with j1 = C:G and j2 = (F x G):H at the points, and their
 * element means. */
struct variation {
    double G[NQ][9], H[NQ][9], FG[NQ][9], FH[NQ][9], jG[NQ], jH[NQ], j2[NQ], tG, tH, t2;
};

static void vary(const struct pm_element *el, const struct kinematics *k, const double *v,
                 const double *w, struct variation *d)
{
    d->tG = d->tH = d->t2 = 0.0;
    for (int q = 0; q < NQ; q++) {
        double s = el->w[q] / k->V;
        pm_gradient(v, el->dN + 30 * q, d->G[q]);
        pm_gradient(w, el->dN + 30 * q, d->H[q]);
        pm_cross9(k->F[q], d->G[q], d->FG[q]);
        pm_cross9(k->F[q], d->H[q], d->FH[q]);
        d->jG[q] = pm_dot9(k->C[q], d->G[q]);
        d->jH[q] = pm_dot9(k->C[q], d->H[q]);
        d->j2[q] = pm_dot9(d->FG[q], d->H[q]);
        d->tG += s * d->jG[q];
        d->tH += s * d->jH[q];
        d->t2 += s * d->j2[q];
    }
}

/* T(G, H) with the volumetric part kappa (piGH C + piG F x H + piH F x G + pi G x H). */
static void third_at(const struct pm_element *el, const struct kinematics *k,
                     const struct variation *d, int q, double piG, double piH, double piGH,
                     double pi, double T[9])
{
    double GH[9];
    pm_law_third(el->law, k->F[q], d->G[q], d->H[q], T);
    pm_cross9(d->G[q], d->H[q], GH);
    pm_axpy9(piGH, k->C[q], T);
    pm_axpy9(piG, d->FH[q], T);
    pm_axpy9(piH, d->FG[q], T);
    pm_axpy9(pi, GH, T);
}

void pm_element_third(const struct pm_element *el, const double *u, const double *v,
                      const double *w, double *f)
{
    struct kinematics k;
    struct variation d;
    double b = el->blend, kappa = el->law->kappa;
    deform(el, u, &k);
    vary(el, &k, v, w, &d);
    for (int q = 0; q < NQ; q++) {
        double T[9];
        third_at(el, &k, &d, q, kappa * (b * d.jG[q] + (1 - b) * d.tG),
                 kappa * (b * d.jH[q] + (1 - b) * d.tH), kappa * (b * d.j2[q] + (1 - b) * d.t2),
                 pressure_at(el, &k, q), T);
        scatter(el->w[q], T, el->dN + 30 * q, f);
    }
}

/* M_IJ += s A_iI B_iJ */
static void add_tprod(double s, const double A[9], const double B[9], double M[9])
{
    for (int i = 0; i < 3; i++)
        for (int I = 0; I < 3; I++)
            for (int J = 0; J < 3; J++)
                M[3 * I + J] += s * A[3 * i + I] * B[3 * i + J];
}

static void add_trace(double s, double M[9])
{
    M[0] += s;
    M[4] += s;
    M[8] += s;
}

/* S = A:G of the pointwise part W_iso + b U. */
static void apply_pointwise(const struct pm_element *el, const struct kinematics *k, int q,
                            const double G[9], const double FG[9], double jG, double S[9])
{
    double bk = el->blend * el->law->kappa;
    pm_law_apply(el->law, k->F[q], G, S);
    pm_axpy9(bk * jG, k->C[q], S);
    pm_axpy9(bk * k->Jm1[q], FG, S);
}

/* Second-order part of the Eshelby-type tensor for one pair (v, h). */
static void shape_second(const struct pm_element *el, const struct kinematics *k, const double *v,
                         const double *h, double M[NQ][9])
{
    struct variation d;
    double bk = el->blend * el->law->kappa, mk = (1.0 - el->blend) * el->law->kappa;
    vary(el, k, v, h, &d);
    for (int q = 0; q < NQ; q++) {
        double AG[9], AH[9], T[9];
        apply_pointwise(el, k, q, d.G[q], d.FG[q], d.jG[q], AG);
        apply_pointwise(el, k, q, d.H[q], d.FH[q], d.jH[q], AH);
        third_at(el, k, &d, q, bk * d.jG[q], bk * d.jH[q], bk * d.j2[q], bk * k->Jm1[q], T);
        add_trace(pm_dot9(d.G[q], AH), M[q]);
        add_tprod(-1.0, k->F[q], T, M[q]);
        add_tprod(-1.0, d.G[q], AH, M[q]);
        add_tprod(-1.0, d.H[q], AG, M[q]);
        add_trace(-mk * (d.tG * d.tH + (1.0 + k->mean) * d.t2), M[q]);
    }
}

void pm_element_shape(const struct pm_element *el, const double *u, const double *g, int n,
                      const double *v, const double *h, double *D)
{
    struct kinematics k;
    double M[NQ][9], jG[NQ], tG = 0.0, bk = el->blend * el->law->kappa,
                             mk = (1.0 - el->blend) * el->law->kappa;
    memset(M, 0, sizeof M);
    deform(el, u, &k);
    for (int q = 0; q < NQ; q++) {
        double G[9], FG[9], P[9], AG[9];
        pm_gradient(g, el->dN + 30 * q, G);
        pm_cross9(k.F[q], G, FG);
        jG[q] = pm_dot9(k.C[q], G);
        tG += el->w[q] * jG[q] / k.V;
        pm_law_stress(el->law, k.F[q], P);
        pm_axpy9(bk * k.Jm1[q], k.C[q], P);
        apply_pointwise(el, &k, q, G, FG, jG[q], AG);
        add_trace(pm_dot9(P, G), M[q]);
        add_tprod(-1.0, k.F[q], AG, M[q]);
        add_tprod(-1.0, G, P, M[q]);
    }
    for (int q = 0; q < NQ; q++)
        add_trace(-mk * (1.0 + k.mean) * tG, M[q]);
    for (int r = 0; r < n; r++)
        shape_second(el, &k, v + 30 * r, h + 30 * r, M);
    for (int q = 0; q < NQ; q++)
        scatter(el->w[q], M[q], el->dN + 30 * q, D);
}
