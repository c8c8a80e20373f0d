/* The Ogden law: reference digits, special cases, closed forms, derivatives at repeated and nearly
 * repeated stretches. */
#include "common/mechanics/ogden.h"

#include <string.h>

#include "common/mechanics/tensor.h"
#include "tests/reference.h"
#include "tests/tap.h"

static const double two_terms[] = {0.4, 1.3, 0.01, 5.0, -0.02, -2.0};
static const double stiffening[] = {0.05, 12.0, -0.03, -7.5};
static const double six_terms[] = {0.2,  1.5,  0.02, 4.0,  -0.05, -2.5,
                                   0.03, -0.5, 1e-3, 11.0, -4e-3, -9.0};
static const struct pm_ogden laws[] = {{3, two_terms}, {2, stiffening}, {6, six_terms}};
enum { LAWS = sizeof laws / sizeof laws[0] };

static const double G[9] = {0.3, -0.2, 0.1, 0.5, 0.4, -0.6, -0.1, 0.2, 0.7};
static const double H[9] = {-0.4, 0.1, 0.25, 0.35, -0.15, 0.05, 0.6, -0.3, 0.2};

/* P, A:G, T(G, H) of the whole law of tests/data/material_point.json. Its digits of W, P, AG agree
 * with differences to 2e-14, of T of Ogden to 5e-13, as measured when they were made. */
static void reference(const cJSON *root, const char *item, ptrdiff_t n, const double *c,
                      double kappa)
{
    const cJSON *law = cJSON_GetObjectItem(cJSON_GetObjectItem(root, "laws"), item);
    const struct pm_ogden o = {n, c};
    double F[9], g[9], h[9], C[9], FG[9], FH[9], GH[9], P[9], AG[9], T[9], want[9];
    reference_numbers(root, "F", F, 9);
    reference_numbers(root, "G", g, 9);
    reference_numbers(root, "H", h, 9);
    const double J = pm_cofactor(F, C), U1 = kappa * (J - 1);
    const double W = pm_ogden_stress(&o, F, P) + 0.5 * U1 * (J - 1);
    pm_cross9(F, g, FG);
    pm_cross9(F, h, FH);
    pm_cross9(g, h, GH);
    pm_ogden_apply(&o, F, g, AG);
    pm_ogden_third(&o, F, g, h, T);
    pm_axpy9(U1, C, P);
    pm_axpy9(U1, FG, AG);
    pm_axpy9(kappa * pm_dot9(C, g), C, AG);
    pm_axpy9(kappa * pm_dot9(FG, h), C, T);
    pm_axpy9(kappa * pm_dot9(C, g), FH, T);
    pm_axpy9(kappa * pm_dot9(C, h), FG, T);
    pm_axpy9(U1, GH, T);
    printf("# %s\n", item);
    reference_numbers(law, "W", want, 1);
    near_rel("W", W, want[0], 5e-14);
    reference_numbers(law, "P", want, 9);
    near_array("P", P, want, 9, 5e-14);
    reference_numbers(law, "AG", want, 9);
    near_array("A:G", AG, want, 9, 5e-14);
    reference_numbers(law, "T_GH", want, 9);
    near_array("T(G, H)", T, want, 9, 5e-13);
}

/* F = R diag(l) S with two fixed rotations. */
static void state(const double l[3], double F[9])
{
    const double c = cos(0.7), s = sin(0.7), d = cos(-1.1), e = sin(-1.1);
    const double R[9] = {c, -s, 0, s * d, c * d, -e, s * e, c * e, d};
    const double S[9] = {d, 0, e, s * e, c, -s * d, -c * e, s, c * d};
    for (int i = 0; i < 3; i++)
        for (int J = 0; J < 3; J++) {
            F[3 * i + J] = 0.0;
            for (int a = 0; a < 3; a++)
                F[3 * i + J] += R[3 * i + a] * l[a] * S[3 * a + J];
        }
}

/* Nominal stress along e1 of the incompressible solid with stress-free direction e3: P_11 - P_33
 * l3 / l1 of the isochoric stress. */
static double nominal(const struct pm_ogden *o, double l1, double l2)
{
    const double l3 = 1 / (l1 * l2), F[9] = {l1, 0, 0, 0, l2, 0, 0, 0, l3};
    double P[9];
    pm_ogden_stress(o, F, P);
    return P[0] - P[8] * l3 / l1;
}

/* sum mu (l^(alpha-1) - l^(-m alpha - 1)): m = 1/2 uniaxial, 2 equibiaxial, 1 pure shear; rounding
 * of powers to 11. */
static void closed_forms(const struct pm_ogden *o)
{
    static const double stretch[] = {0.6, 1.2, 2.5};
    for (int k = 0; k < 3; k++) {
        const double l = stretch[k];
        double uni = 0, bi = 0, shear = 0;
        for (ptrdiff_t s = 0; s < o->n; s++) {
            const double mu = o->c[2 * s], a = o->c[2 * s + 1];
            uni += mu * (pow(l, a - 1) - pow(l, -0.5 * a - 1));
            bi += mu * (pow(l, a - 1) - pow(l, -2 * a - 1));
            shear += mu * (pow(l, a - 1) - pow(l, -a - 1));
        }
        near_rel("uniaxial", nominal(o, l, 1 / sqrt(l)), uni, 1e-13);
        near_rel("equibiaxial", nominal(o, l, l), bi, 1e-13);
        near_rel("pure shear", nominal(o, l, 1), shear, 1e-13);
    }
}

enum quantity { STRESS, TANGENT };

static void evaluate(const struct pm_ogden *o, enum quantity q, const double F[9], double out[9])
{
    if (q == STRESS)
        pm_ogden_stress(o, F, out);
    else
        pm_ogden_apply(o, F, G, out);
}

/* Derivative of `q` along D at F: central differences with steps h, h/2, h/4, h/8, extrapolated
 * (Richardson). */
static void difference(const struct pm_ogden *o, enum quantity q, const double F[9],
                       const double D[9], double out[9])
{
    double level[4][9], h = 0.02;
    for (int k = 0; k < 4; k++, h /= 2) {
        double plus[9], minus[9], a[9], b[9];
        memcpy(plus, F, sizeof plus);
        memcpy(minus, F, sizeof minus);
        pm_axpy9(h, D, plus);
        pm_axpy9(-h, D, minus);
        evaluate(o, q, plus, a);
        evaluate(o, q, minus, b);
        for (int i = 0; i < 9; i++)
            level[k][i] = (a[i] - b[i]) / (2 * h);
        double factor = 1;
        for (int m = k; m > 0; m--) {
            factor *= 4;
            for (int i = 0; i < 9; i++)
                level[m - 1][i] = level[m][i] + (level[m][i] - level[m - 1][i]) / (factor - 1);
        }
    }
    memcpy(out, level[0], 9 * sizeof *out);
}

/* At stretches l: A:G and T(G, H) against differences (their own error: rounding 1e-16 / 0.0025 and
 * eighth derivatives of powers to 12, seen up to 1e-12), A as a matrix against A:G and symmetries
 * to rounding (seen up to 1.4e-15). */
static void derivatives(const struct pm_ogden *o, const double l[3])
{
    double F[9], A[81], AG[9], AH[9], T[9], T2[9], want[9], asymmetry = 0, scale = 0;
    printf("# stretches %.15g %.15g %.15g, %td terms\n", l[0], l[1], l[2], o->n);
    state(l, F);
    pm_ogden_apply(o, F, G, AG);
    difference(o, STRESS, F, G, want);
    near_array("A:G against differences of P", AG, want, 9, 1e-11);
    pm_ogden_tangent(o, F, A);
    for (int k = 0; k < 9; k++) {
        want[k] = pm_dot9(A + 9 * k, G);
        for (int m = 0; m < 9; m++) {
            asymmetry = fmax(asymmetry, fabs(A[9 * k + m] - A[9 * m + k]));
            scale = fmax(scale, fabs(A[9 * k + m]));
        }
    }
    near_array("A times G is A:G", AG, want, 9, 1e-14);
    near_abs("A is symmetric", asymmetry / scale, 0, 1e-14);
    pm_ogden_third(o, F, G, H, T);
    difference(o, TANGENT, F, H, want);
    near_array("T(G, H) against differences of A:G", T, want, 9, 1e-11);
    pm_ogden_third(o, F, H, G, T2);
    near_array("T(G, H) = T(H, G)", T2, T, 9, 1e-14);
    pm_ogden_apply(o, F, H, AH);
    pm_ogden_third(o, F, G, G, T2); /* total symmetry: T(G, H):G = T(G, G):H */
    near_abs("T is totally symmetric", (pm_dot9(T, G) - pm_dot9(T2, H)) / sqrt(pm_dot9(T2, T2)), 0,
             1e-14);
}

static void turned(const struct pm_ogden *o)
{
    static const double l[3] = {1.7, 0.9, 0.6}, one[3] = {1, 1, 1};
    double R[9], F[9], RF[9] = {0}, P[9], P2[9], RP[9] = {0};
    state(one, R);
    state(l, F);
    const double W = pm_ogden_stress(o, F, P);
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++) {
            RF[i] += R[i / 3 * 3 + k] * F[3 * k + i % 3];
            RP[i] += R[i / 3 * 3 + k] * P[3 * k + i % 3];
        }
    near_rel("W(R F) = W(F)", pm_ogden_stress(o, RF, P2), W, 2e-14);
    near_array("P(R F) = R P(F)", P2, RP, 9, 2e-14);
}

static void undeformed(const struct pm_ogden *o)
{
    static const double I[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double A[81], P[9], mu = 0, worst = 0, T[9], W = pm_ogden_stress(o, I, P);
    for (ptrdiff_t s = 0; s < o->n; s++)
        mu += 0.5 * o->c[2 * s] * o->c[2 * s + 1];
    ok(W == 0 && pm_dot9(P, P) == 0, "no energy and no stress at rest");
    pm_ogden_tangent(o, I, A);
    for (int k = 0; k < 9; k++)
        for (int m = 0; m < 9; m++) {
            const int t = m % 3 * 3 + m / 3; /* G -> mu (G + G^T - 2/3 tr G I) */
            const double want = (k == m) + (k == t) - (k % 4 == 0 && m % 4 == 0) * 2.0 / 3;
            worst = fmax(worst, fabs(A[9 * k + m] / mu - want));
        }
    near_abs("linear elasticity at rest", worst, 0, 2e-15);
    static const double W2[9] = {0, -1, 0, 1, 0, 0, 0, 0, 0};
    pm_ogden_third(o, I, W2, W2, T); /* d2/de2 P(exp(e w)) = 0 = T(w, w) + A:w^2 */
    double AG[9];
    static const double ww[9] = {-1, 0, 0, 0, -1, 0, 0, 0, 0};
    pm_ogden_apply(o, I, ww, AG);
    pm_axpy9(1, AG, T);
    near_abs("a rotation of second order has no stress", sqrt(pm_dot9(T, T)) / mu, 0, 1e-14);
}

int main(void)
{
    cJSON *root = reference_load("tests/data/material_point.json");
    if (root == NULL)
        return tap_bail("no reference");
    reference(root, "NeoHooke", 1, (const double[]){0.465, 2}, 46.5);
    reference(root, "MooneyRivlin", 2, (const double[]){0.4, 2, -0.1, -2}, 30.0);
    reference(root, "Ogden", 3, (const double[]){0.4, 1.3, 0.01, 5, -0.02, -2}, 30.0);
    cJSON_Delete(root);
    static const double gap[] = {0, 1e-12, 1e-9, 1e-6, 1e-3, 0.05, 0.1, 0.2};
    for (int k = 0; k < LAWS; k++) {
        closed_forms(&laws[k]);
        undeformed(&laws[k]);
        turned(&laws[k]);
        derivatives(&laws[k], (const double[]){1.7, 0.9, 0.6});
        for (size_t i = 0; i < sizeof gap / sizeof gap[0]; i++) {
            derivatives(&laws[k], (const double[]){1.3 + gap[i], 1.3, 0.7});
            derivatives(&laws[k], (const double[]){0.8, 1.4, 0.8 - gap[i]});
            derivatives(&laws[k], (const double[]){1.1 - gap[i], 1.1, 1.1 + 0.7 * gap[i]});
        }
    }
    return tap_done();
}
