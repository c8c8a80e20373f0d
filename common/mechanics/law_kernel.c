/* Stress, tangent and third derivative of the isochoric laws, a batch of lanes at a time [model
 * 1.1]. */
#include <math.h>
#include <string.h>

#include "common/mechanics/law.h"
#include "common/mechanics/ogden.h"
#include "common/mechanics/tensor.h"

enum { I1, JJ, I2, NI }; /* the invariants; laws without I2 use the first two */

/* Derivatives of w(I1, J, I2); symmetric arrays filled for all index orders. */
struct derivatives {
    pm_lanes w, d1[NI], d2[NI][NI], d3[NI][NI][NI];
};

/* n invariants at F with first derivatives g; r = J^(-1/3). */
struct invariants {
    int n;
    pm_lanes i[NI], r, g[NI][9];
};

static void invariants_at(const struct pm_law *law, const pm_lanes F[9], struct invariants *v)
{
    pm_lanes C[9];
    v->n = law->kind == PM_LAW_MOONEY_RIVLIN ? 3 : 2;
    v->i[JJ] = pm_lanes_cofactor(F, C);
    memcpy(v->g[JJ], C, sizeof C);
    v->i[I1] = pm_lanes_dot9(F, F);
    for (int l = 0; l < PM_LANES; l++)
        v->r[l] = 1.0 / cbrt(v->i[JJ][l]);
    for (int k = 0; k < 9; k++)
        v->g[I1][k] = 2.0 * F[k];
    if (v->n < 3)
        return;
    v->i[I2] = pm_lanes_dot9(C, C);
    pm_lanes_cross9(F, C, v->g[I2]);
    for (int k = 0; k < 9; k++)
        v->g[I2][k] *= 2.0;
}

static void set2(struct derivatives *d, int a, int b, pm_lanes value)
{
    d->d2[a][b] += value;
    if (a != b)
        d->d2[b][a] += value;
}

/* d3 for {a, b, J} type triples: all distinct permutations of (a, b, c). */
static void set3(struct derivatives *d, int a, int b, int c, pm_lanes value)
{
    const int p[6][3] = {{a, b, c}, {a, c, b}, {b, a, c}, {b, c, a}, {c, a, b}, {c, b, a}};
    for (int k = 0; k < 6; k++)
        d->d3[p[k][0]][p[k][1]][p[k][2]] = value;
}

/* w += s (J^-e I_a - 3) and its derivatives up to the given order; e = 2/3 for I1, 4/3 for I2. */
static void power_term(struct derivatives *d, int a, double s, const struct invariants *v,
                       int order)
{
    double e = a == I1 ? 2.0 / 3 : 4.0 / 3;
    pm_lanes q = a == I1 ? v->r * v->r : v->r * v->r * v->r * v->r, I = v->i[a], j = 1.0 / v->i[JJ];
    d->w += s * (q * I - 3.0);
    d->d1[a] += s * q;
    d->d1[JJ] -= s * e * q * I * j;
    if (order < 2)
        return;
    set2(d, a, JJ, -s * e * q * j);
    set2(d, JJ, JJ, s * e * (e + 1) * q * I * j * j);
    if (order < 3)
        return;
    set3(d, a, JJ, JJ, s * e * (e + 1) * q * j * j);
    set3(d, JJ, JJ, JJ, d->d3[JJ][JJ][JJ] - s * e * (e + 1) * (e + 2) * q * I * j * j * j);
}

/* f(y) = c1 y + c2 y^2 + c3 y^3, y = J^(-2/3) I1 - 3 [model 1.2]: chain rule. */
static void yeoh_term(struct derivatives *d, const double *c, const struct invariants *v, int order)
{
    struct derivatives y;
    memset(&y, 0, sizeof y);
    power_term(&y, I1, 1.0, v, order);
    pm_lanes f1 = c[0] + 2 * c[1] * y.w + 3 * c[2] * y.w * y.w, f2 = 2 * c[1] + 6 * c[2] * y.w;
    double f3 = 6 * c[2];
    d->w = y.w * (c[0] + y.w * (c[1] + y.w * c[2]));
    for (int a = 0; a < 2; a++) {
        d->d1[a] = f1 * y.d1[a];
        for (int b = 0; b < 2 && order > 1; b++) {
            d->d2[a][b] = f2 * y.d1[a] * y.d1[b] + f1 * y.d2[a][b];
            for (int k = 0; k < 2 && order > 2; k++)
                d->d3[a][b][k] =
                    f3 * y.d1[a] * y.d1[b] * y.d1[k] + f1 * y.d3[a][b][k] +
                    f2 * (y.d2[a][b] * y.d1[k] + y.d2[a][k] * y.d1[b] + y.d2[b][k] * y.d1[a]);
        }
    }
}

static void derivatives_at(const struct pm_law *law, const struct invariants *v,
                           struct derivatives *d, int order)
{
    memset(d, 0, sizeof *d);
    if (law->kind == PM_LAW_YEOH) {
        yeoh_term(d, law->c, v, order);
    } else if (law->kind == PM_LAW_MOONEY_RIVLIN) {
        power_term(d, I1, law->c[0], v, order);
        power_term(d, I2, law->c[1], v, order);
    } else {
        power_term(d, I1, 0.5 * law->c[0], v, order);
    }
}

/* ---- Ogden works in principal stretches, point by point ---- */

static struct pm_ogden terms(const struct pm_law *law)
{
    return (struct pm_ogden){law->n / 2, law->c};
}

static void pick(int n, const pm_lanes *from, int lane, double *to)
{
    for (int k = 0; k < n; k++)
        to[k] = from[k][lane];
}

static void place(int n, const double *from, int lane, pm_lanes *to)
{
    for (int k = 0; k < n; k++)
        to[k][lane] = from[k];
}

void pm_law_stress(const struct pm_law *law, const pm_lanes F[9], pm_lanes *W, pm_lanes P[9])
{
    struct invariants v;
    struct derivatives d;
    if (law->kind == PM_LAW_OGDEN) {
        const struct pm_ogden ogden = terms(law);
        for (int l = 0; l < PM_LANES; l++) {
            double f[9], p[9];
            pick(9, F, l, f);
            (*W)[l] = pm_ogden_stress(&ogden, f, P != NULL ? p : NULL);
            if (P != NULL)
                place(9, p, l, P);
        }
        return;
    }
    invariants_at(law, F, &v);
    derivatives_at(law, &v, &d, 1);
    *W = d.w;
    if (P == NULL)
        return;
    memset(P, 0, 9 * sizeof *P);
    for (int a = 0; a < v.n; a++)
        pm_lanes_axpy9(d.d1[a], v.g[a], P);
}

/* A += 2 s (G x C + F x (F x G)) as a matrix; X: the matrix of F x G */
static void add_tangent_I2(pm_lanes s, const pm_lanes C[9], const pm_lanes X[81], pm_lanes A[81])
{
    pm_lanes XC[81];
    pm_lanes_cross_matrix(C, XC);
    for (int k = 0; k < 9; k++)
        for (int l = 0; l < 9; l++) {
            pm_lanes sum = XC[9 * k + l];
            for (int m = 0; m < 9; m++)
                sum += X[9 * k + m] * X[9 * m + l];
            A[9 * k + l] += 2.0 * s * sum;
        }
}

void pm_law_tangent(const struct pm_law *law, const pm_lanes F[9], pm_lanes A[81])
{
    struct invariants v;
    struct derivatives d;
    pm_lanes X[81];
    if (law->kind == PM_LAW_OGDEN) {
        const struct pm_ogden ogden = terms(law);
        for (int l = 0; l < PM_LANES; l++) {
            double f[9], a[81];
            pick(9, F, l, f);
            pm_ogden_tangent(&ogden, f, a);
            place(81, a, l, A);
        }
        return;
    }
    invariants_at(law, F, &v);
    derivatives_at(law, &v, &d, 2);
    pm_lanes_cross_matrix(F, X);
    for (int k = 0; k < 81; k++)
        A[k] = d.d1[JJ] * X[k];
    for (int k = 0; k < 9; k++)
        A[10 * k] += 2.0 * d.d1[I1];
    for (int b = 0; b < v.n; b++) {
        pm_lanes g[9];
        memset(g, 0, sizeof g);
        for (int a = 0; a < v.n; a++)
            pm_lanes_axpy9(d.d2[a][b], v.g[a], g);
        for (int k = 0; k < 9; k++)
            pm_lanes_axpy9(g[k], v.g[b], A + 9 * k);
    }
    if (v.n > 2)
        add_tangent_I2(d.d1[I2], v.g[JJ], X, A);
}

/* h_a(G): first variation of g_a. */
static void variations(const pm_lanes F[9], const struct invariants *v, const pm_lanes G[9],
                       pm_lanes h[NI][9])
{
    pm_lanes GC[9], FFG[9];
    pm_lanes_cross9(F, G, h[JJ]);
    for (int k = 0; k < 9; k++)
        h[I1][k] = 2.0 * G[k];
    if (v->n < 3)
        return;
    pm_lanes_cross9(G, v->g[JJ], GC);
    pm_lanes_cross9(F, h[JJ], FFG);
    for (int k = 0; k < 9; k++)
        h[I2][k] = 2.0 * GC[k] + 2.0 * FFG[k];
}

void pm_law_apply(const struct pm_law *law, const pm_lanes F[9], const pm_lanes G[9],
                  pm_lanes AG[9])
{
    struct invariants v;
    struct derivatives d;
    pm_lanes h[NI][9];
    if (law->kind == PM_LAW_OGDEN) {
        const struct pm_ogden ogden = terms(law);
        for (int l = 0; l < PM_LANES; l++) {
            double f[9], g[9], a[9];
            pick(9, F, l, f);
            pick(9, G, l, g);
            pm_ogden_apply(&ogden, f, g, a);
            place(9, a, l, AG);
        }
        return;
    }
    invariants_at(law, F, &v);
    derivatives_at(law, &v, &d, 2);
    variations(F, &v, G, h);
    memset(AG, 0, 9 * sizeof *AG);
    for (int b = 0; b < v.n; b++) {
        pm_lanes s = {0};
        for (int a = 0; a < v.n; a++)
            s += d.d2[a][b] * pm_lanes_dot9(v.g[a], G);
        pm_lanes_axpy9(s, v.g[b], AG);
        pm_lanes_axpy9(d.d1[b], h[b], AG);
    }
}

/* t_I2(G, H) = 2 G x (F x H) + 2 H x (F x G) + 2 F x (G x H), scaled and added to T; FG = F x G, FH
 * = F x H. */
static void add_third_I2(pm_lanes s, const pm_lanes F[9], const pm_lanes G[9], const pm_lanes H[9],
                         const pm_lanes FG[9], const pm_lanes FH[9], pm_lanes T[9])
{
    pm_lanes a[9], GH[9];
    pm_lanes_cross9(G, FH, a);
    pm_lanes_axpy9(2.0 * s, a, T);
    pm_lanes_cross9(H, FG, a);
    pm_lanes_axpy9(2.0 * s, a, T);
    pm_lanes_cross9(G, H, GH);
    pm_lanes_cross9(F, GH, a);
    pm_lanes_axpy9(2.0 * s, a, T);
}

static void third_ogden(const struct pm_law *law, const pm_lanes F[9], const pm_lanes G[9],
                        const pm_lanes H[9], pm_lanes T[9])
{
    const struct pm_ogden ogden = terms(law);
    for (int l = 0; l < PM_LANES; l++) {
        double f[9], g[9], h[9], t[9];
        pick(9, F, l, f);
        pick(9, G, l, g);
        pick(9, H, l, h);
        pm_ogden_third(&ogden, f, g, h, t);
        place(9, t, l, T);
    }
}

void pm_law_third(const struct pm_law *law, const pm_lanes F[9], const pm_lanes G[9],
                  const pm_lanes H[9], pm_lanes T[9])
{
    struct invariants v;
    struct derivatives d;
    pm_lanes hG[NI][9], hH[NI][9], alpha[NI], beta[NI], gamma[NI], GH[9];
    if (law->kind == PM_LAW_OGDEN) {
        third_ogden(law, F, G, H, T);
        return;
    }
    invariants_at(law, F, &v);
    derivatives_at(law, &v, &d, 3);
    variations(F, &v, G, hG);
    variations(F, &v, H, hH);
    for (int a = 0; a < v.n; a++) {
        alpha[a] = pm_lanes_dot9(v.g[a], G);
        beta[a] = pm_lanes_dot9(v.g[a], H);
        gamma[a] = pm_lanes_dot9(hG[a], H);
    }
    memset(T, 0, 9 * sizeof *T);
    for (int c = 0; c < v.n; c++) {
        pm_lanes s = {0}, sb = {0}, sa = {0};
        for (int a = 0; a < v.n; a++) {
            for (int b = 0; b < v.n; b++)
                s += d.d3[a][b][c] * alpha[a] * beta[b];
            s += d.d2[a][c] * gamma[a];
            sb += d.d2[c][a] * beta[a];
            sa += d.d2[c][a] * alpha[a];
        }
        pm_lanes_axpy9(s, v.g[c], T);
        pm_lanes_axpy9(sb, hG[c], T);
        pm_lanes_axpy9(sa, hH[c], T);
    }
    pm_lanes_cross9(G, H, GH);
    pm_lanes_axpy9(d.d1[JJ], GH, T);
    if (v.n > 2)
        add_third_I2(d.d1[I2], F, G, H, hG[JJ], hH[JJ], T);
}
