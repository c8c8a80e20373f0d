#include "common/mechanics/law.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/tensor.h"

enum { I1, I2, JJ, NI }; /* the invariants */

/* Derivatives of w(I1, I2, J); symmetric arrays filled for all index orders. */
struct derivatives {
    double w, d1[NI], d2[NI][NI], d3[NI][NI][NI];
};

/* Invariants at F with first derivatives g. */
struct invariants {
    double i[NI], C[9], g[NI][9];
};

enum pm_status pm_law_set(struct pm_law *law, const char *name, ptrdiff_t n, const double *c,
                          double kappa, struct pm_err *err)
{
    static const struct {
        const char *name;
        enum pm_law_kind kind;
        int least, most; /* parameters */
    } known[] = {{"neo-hookean", PM_LAW_NEO_HOOKEAN, 1, 1},
                 {"mooney-rivlin", PM_LAW_MOONEY_RIVLIN, 2, 2},
                 {"yeoh", PM_LAW_YEOH, 1, 3}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(name, known[k].name) == 0) {
            if (n < known[k].least || n > known[k].most)
                return pm_fail(err, PM_INPUT, "material law '%s': found %td parameters", name, n);
            *law = (struct pm_law){.kind = known[k].kind, .n = n, .kappa = kappa};
            for (ptrdiff_t i = 0; i < n; i++)
                law->c[i] = c[i];
            law->mu = law->kind == PM_LAW_NEO_HOOKEAN ? c[0] : 2 * c[0];
            if (law->kind == PM_LAW_MOONEY_RIVLIN)
                law->mu += 2 * c[1];
            if (!(law->mu > 0) || !(kappa > 0))
                return pm_fail(err, PM_INPUT,
                               "material: found mu = %g, kappa = %g MPa, expected both > 0",
                               law->mu, kappa);
            return PM_OK;
        }
    return pm_fail(err, PM_INPUT,
                   "unknown material law '%s', expected neo-hookean, mooney-rivlin or yeoh", name);
}

static void invariants_at(const double F[9], struct invariants *v)
{
    v->i[JJ] = pm_cofactor(F, v->C);
    v->i[I1] = pm_dot9(F, F);
    v->i[I2] = pm_dot9(v->C, v->C);
    pm_cross9(F, v->C, v->g[I2]);
    for (int k = 0; k < 9; k++) {
        v->g[I1][k] = 2 * F[k];
        v->g[I2][k] *= 2;
        v->g[JJ][k] = v->C[k];
    }
}

static void set2(struct derivatives *d, int a, int b, double value)
{
    d->d2[a][b] += value;
    if (a != b)
        d->d2[b][a] += value;
}

/* d3 for {a, b, J} type triples: all distinct permutations of (a, b, c). */
static void set3(struct derivatives *d, int a, int b, int c, double value)
{
    const int p[6][3] = {{a, b, c}, {a, c, b}, {b, a, c}, {b, c, a}, {c, a, b}, {c, b, a}};
    for (int k = 0; k < 6; k++)
        d->d3[p[k][0]][p[k][1]][p[k][2]] = value;
}

/* w += s (J^-e I_a - 3) and its derivatives. */
static void power_term(struct derivatives *d, int a, double s, double e, const double *i)
{
    double J = i[JJ], q = pow(J, -e), I = i[a];
    d->w += s * (q * I - 3);
    d->d1[a] += s * q;
    d->d1[JJ] -= s * e * q * I / J;
    set2(d, a, JJ, -s * e * q / J);
    set2(d, JJ, JJ, s * e * (e + 1) * q * I / (J * J));
    set3(d, a, JJ, JJ, s * e * (e + 1) * q / (J * J));
    set3(d, JJ, JJ, JJ, d->d3[JJ][JJ][JJ] - s * e * (e + 1) * (e + 2) * q * I / (J * J * J));
}

/* f(y) = c1 y + c2 y^2 + c3 y^3, y = J^(-2/3) I1 - 3 [model 1.2]: chain rule. */
static void yeoh_term(struct derivatives *d, const double *c, const double *i)
{
    struct derivatives y = {0};
    power_term(&y, I1, 1.0, 2.0 / 3, i);
    double f1 = c[0] + 2 * c[1] * y.w + 3 * c[2] * y.w * y.w, f2 = 2 * c[1] + 6 * c[2] * y.w,
           f3 = 6 * c[2];
    d->w = y.w * (c[0] + y.w * (c[1] + y.w * c[2]));
    for (int a = 0; a < NI; a++) {
        d->d1[a] = f1 * y.d1[a];
        for (int b = 0; b < NI; b++) {
            d->d2[a][b] = f2 * y.d1[a] * y.d1[b] + f1 * y.d2[a][b];
            for (int k = 0; k < NI; k++)
                d->d3[a][b][k] =
                    f3 * y.d1[a] * y.d1[b] * y.d1[k] + f1 * y.d3[a][b][k] +
                    f2 * (y.d2[a][b] * y.d1[k] + y.d2[a][k] * y.d1[b] + y.d2[b][k] * y.d1[a]);
        }
    }
}

static void derivatives_at(const struct pm_law *law, const double *i, struct derivatives *d)
{
    memset(d, 0, sizeof *d);
    switch (law->kind) {
    case PM_LAW_NEO_HOOKEAN:
        power_term(d, I1, 0.5 * law->c[0], 2.0 / 3, i);
        break;
    case PM_LAW_MOONEY_RIVLIN:
        power_term(d, I1, law->c[0], 2.0 / 3, i);
        power_term(d, I2, law->c[1], 4.0 / 3, i);
        break;
    case PM_LAW_YEOH:
        yeoh_term(d, law->c, i);
        break;
    case PM_LAW_OGDEN:
        break;
    }
}

double pm_law_stress(const struct pm_law *law, const double F[9], double P[9])
{
    struct invariants v;
    struct derivatives d;
    invariants_at(F, &v);
    derivatives_at(law, v.i, &d);
    if (P != NULL) {
        memset(P, 0, 9 * sizeof *P);
        for (int a = 0; a < NI; a++)
            pm_axpy9(d.d1[a], v.g[a], P);
    }
    return d.w;
}

void pm_law_tangent(const struct pm_law *law, const double F[9], double A[81])
{
    struct invariants v;
    struct derivatives d;
    double X[81], XC[81];
    invariants_at(F, &v);
    derivatives_at(law, v.i, &d);
    pm_cross_matrix(F, X);
    for (int k = 0; k < 81; k++)
        A[k] = d.d1[JJ] * X[k];
    for (int k = 0; k < 9; k++)
        A[10 * k] += 2 * d.d1[I1];
    for (int b = 0; b < NI; b++) {
        double g[9] = {0};
        for (int a = 0; a < NI; a++)
            pm_axpy9(d.d2[a][b], v.g[a], g);
        for (int k = 0; k < 9; k++)
            pm_axpy9(g[k], v.g[b], A + 9 * k);
    }
    if (d.d1[I2] == 0.0)
        return;
    pm_cross_matrix(v.C, XC); /* h(G) = 2 G x C + 2 F x (F x G) */
    for (int k = 0; k < 9; k++)
        for (int l = 0; l < 9; l++) {
            double s = XC[9 * k + l];
            for (int m = 0; m < 9; m++)
                s += X[9 * k + m] * X[9 * m + l];
            A[9 * k + l] += 2 * d.d1[I2] * s;
        }
}

/* h_a(G): first variation of g_a. */
static void variations(const double F[9], const double C[9], const double G[9], double h[NI][9])
{
    double GC[9], FFG[9];
    pm_cross9(F, G, h[JJ]);
    pm_cross9(G, C, GC);
    pm_cross9(F, h[JJ], FFG);
    for (int k = 0; k < 9; k++) {
        h[I1][k] = 2 * G[k];
        h[I2][k] = 2 * GC[k] + 2 * FFG[k];
    }
}

void pm_law_apply(const struct pm_law *law, const double F[9], const double G[9], double AG[9])
{
    struct invariants v;
    struct derivatives d;
    double h[NI][9];
    invariants_at(F, &v);
    derivatives_at(law, v.i, &d);
    variations(F, v.C, G, h);
    memset(AG, 0, 9 * sizeof *AG);
    for (int b = 0; b < NI; b++) {
        double s = 0.0;
        for (int a = 0; a < NI; a++)
            s += d.d2[a][b] * pm_dot9(v.g[a], G);
        pm_axpy9(s, v.g[b], AG);
        pm_axpy9(d.d1[b], h[b], AG);
    }
}

/* t_I2(G, H) = 2 G x (F x H) + 2 H x (F x G) + 2 F x (G x H), scaled and added to T; FG = F x G, FH
 * = F x H. */
static void add_third_I2(double s, const double F[9], const double G[9], const double H[9],
                         const double FG[9], const double FH[9], double T[9])
{
    double a[9], GH[9];
    pm_cross9(G, FH, a);
    pm_axpy9(2 * s, a, T);
    pm_cross9(H, FG, a);
    pm_axpy9(2 * s, a, T);
    pm_cross9(G, H, GH);
    pm_cross9(F, GH, a);
    pm_axpy9(2 * s, a, T);
}

void pm_law_third(const struct pm_law *law, const double F[9], const double G[9], const double H[9],
                  double T[9])
{
    struct invariants v;
    struct derivatives d;
    double hG[NI][9], hH[NI][9], alpha[NI], beta[NI], gamma[NI], GH[9];
    invariants_at(F, &v);
    derivatives_at(law, v.i, &d);
    variations(F, v.C, G, hG);
    variations(F, v.C, H, hH);
    for (int a = 0; a < NI; a++) {
        alpha[a] = pm_dot9(v.g[a], G);
        beta[a] = pm_dot9(v.g[a], H);
        gamma[a] = pm_dot9(hG[a], H);
    }
    memset(T, 0, 9 * sizeof *T);
    for (int c = 0; c < NI; c++) {
        double s = 0.0, sb = 0.0, sa = 0.0;
        for (int a = 0; a < NI; a++) {
            for (int b = 0; b < NI; b++)
                s += d.d3[a][b][c] * alpha[a] * beta[b];
            s += d.d2[a][c] * gamma[a];
            sb += d.d2[c][a] * beta[a];
            sa += d.d2[c][a] * alpha[a];
        }
        pm_axpy9(s, v.g[c], T);
        pm_axpy9(sb, hG[c], T);
        pm_axpy9(sa, hH[c], T);
    }
    pm_cross9(G, H, GH);
    pm_axpy9(d.d1[JJ], GH, T);
    if (d.d1[I2] != 0.0)
        add_third_I2(d.d1[I2], F, G, H, hG[JJ], hH[JJ], T);
}
