/* P = M Y with M = F^-T and Y = dev sum_s mu_s q_s C^(alpha_s/2), q_s = J^(-alpha_s/3), C = F^T F
 * [model 1.2]. Everything is evaluated in the frame of the singular vectors, F = sum_a l_a u_a
 * n_a^T: there M, Y are diagonal, and the derivatives of C^(alpha/2) are divided differences of
 * powers (Daleckii-Krein). A primed name is a tensor in that frame: G'_ab = u_a . G n_b. */
#include "common/mechanics/ogden.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "common/mechanics/tensor.h"

/* Relative spread of squared stretches below which second divided differences come from their
 * series: there the quotient would lose 1/spread^2 in digits, the series needs 25 terms. */
static const double close_spread = 0.2;
enum { MAX_SWEEPS = 30, MAX_SERIES = 80 };

/* At one F. The moments are Y[m] = sum_s mu_s (-alpha_s/3)^m p_s: one derivative by log J each. */
struct frame {
    ptrdiff_t n;
    double u[3][3], v[3][3];      /* singular vectors, left and right; v is n above */
    double l[3], x[3];            /* stretches, descending, and their squares */
    double e[PM_OGDEN_TERMS][3];  /* p_s(x_a) - 1, p_s(x) = J^(-alpha_s/3) x^(alpha_s/2) */
    double mu[PM_OGDEN_TERMS][3]; /* mu_s (-alpha_s/3)^m [MPa] */
    double beta[PM_OGDEN_TERMS];  /* alpha_s / 2 */
    double Y[3][3], tau[3];       /* moments at x_a; deviator of Y[0] */
    double d[2][3][3];            /* divided differences of Y[0], Y[1]: [x_a, x_b] */
};

/* Plane rotation that makes a[p] and a[q] orthogonal, applied to v too; 0: they are. */
static int rotate(double a[3][3], double v[3][3], int p, int q)
{
    const double pp = pm_dot3(a[p], a[p]), qq = pm_dot3(a[q], a[q]), pq = pm_dot3(a[p], a[q]);
    if (fabs(pq) <= 4 * DBL_EPSILON * sqrt(pp * qq))
        return 0;
    const double z = (qq - pp) / (2 * pq), t = copysign(1 / (fabs(z) + sqrt(1 + z * z)), z);
    const double c = 1 / sqrt(1 + t * t), s = c * t;
    for (int i = 0; i < 3; i++) {
        const double ap = a[p][i], aq = a[q][i], vp = v[p][i], vq = v[q][i];
        a[p][i] = c * ap - s * aq;
        a[q][i] = s * ap + c * aq;
        v[p][i] = c * vp - s * vq;
        v[q][i] = s * vp + c * vq;
    }
    return 1;
}

/* Singular value decomposition by one-sided Jacobi rotations (Hestenes 1958): small stretches keep
 * their relative accuracy, as they would not through the eigenvalues of C. */
static void decompose(const double F[9], struct frame *f)
{
    double a[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, l[3];
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 9; i++)
        a[i % 3][i / 3] = F[i];
    for (int sweep = 0, moved = 1; moved && sweep < MAX_SWEEPS; sweep++) {
        moved = rotate(a, v, 0, 1);
        moved |= rotate(a, v, 0, 2);
        moved |= rotate(a, v, 1, 2);
    }
    for (int k = 0; k < 3; k++)
        l[k] = sqrt(pm_dot3(a[k], a[k]));
    for (int k = 0; k < 3; k++) /* passes (0,1), (1,2), (0,1) sort three */
        if (l[order[k % 2]] < l[order[k % 2 + 1]]) {
            const int swap = order[k % 2];
            order[k % 2] = order[k % 2 + 1];
            order[k % 2 + 1] = swap;
        }
    for (int k = 0; k < 3; k++) {
        const int o = order[k];
        f->l[k] = l[o];
        f->x[k] = l[o] * l[o];
        for (int i = 0; i < 3; i++) {
            f->u[k][i] = a[o][i] / l[o];
            f->v[k][i] = v[o][i];
        }
    }
}

/* Frame, powers and moments; returns W_iso. */
static double set_frame(const struct pm_ogden *o, const double F[9], struct frame *f)
{
    double t[3], W = 0.0;
    decompose(F, f);
    for (int a = 0; a < 3; a++)
        t[a] = log(f->l[a]);
    const double mean = (t[0] + t[1] + t[2]) / 3;
    memset(f->Y, 0, sizeof f->Y);
    memset(f->tau, 0, sizeof f->tau);
    f->n = o->n;
    for (ptrdiff_t s = 0; s < o->n; s++) {
        const double mu = o->c[2 * s], alpha = o->c[2 * s + 1];
        double *e = f->e[s], *m = f->mu[s], sum = 0.0;
        f->beta[s] = alpha / 2;
        m[0] = mu;
        m[1] = -m[0] * alpha / 3;
        m[2] = -m[1] * alpha / 3;
        for (int a = 0; a < 3; a++)
            sum += e[a] = expm1(alpha * (t[a] - mean));
        W += mu / alpha * sum;
        for (int a = 0; a < 3; a++) {
            f->tau[a] += mu * (e[a] - sum / 3);
            for (int k = 0; k < 3; k++)
                f->Y[k][a] += m[k] * (1 + e[a]);
        }
    }
    return W;
}

/* [x_a, x_b] of moments 0 and 1: p_b expm1(beta log(x_a / x_b)) / (x_a - x_b) has no cancellation.
 */
static void first_differences(struct frame *f)
{
    memset(f->d, 0, sizeof f->d);
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            const double gap = f->x[a] - f->x[b], ratio = log1p(gap / f->x[b]);
            for (ptrdiff_t s = 0; s < f->n; s++) {
                const double p = 1 + f->e[s][b];
                const double d =
                    gap > 0 ? p * expm1(f->beta[s] * ratio) / gap : p * f->beta[s] / f->x[b];
                f->d[0][a][b] += f->mu[s][0] * d;
                f->d[1][a][b] += f->mu[s][1] * d;
            }
            f->d[0][b][a] = f->d[0][a][b];
            f->d[1][b][a] = f->d[1][a][b];
        }
}

/* [x_a, x_b, x_c] of moment 0, a <= b <= c, all close to x_b: with x = x_b (1 + eps) it is
 * sum_s mu_s p_s(x_b) / x_b^2 sum_k binom(beta, k + 2) h_k(eps_a, eps_c), h_k the complete
 * homogeneous polynomials. */
static double series(const struct frame *f, int a, int b, int c)
{
    const double ea = (f->x[a] - f->x[b]) / f->x[b], ec = (f->x[c] - f->x[b]) / f->x[b];
    double total = 0.0;
    for (ptrdiff_t s = 0; s < f->n; s++) {
        const double beta = f->beta[s];
        double binomial = beta * (beta - 1) / 2, h = 1.0, power = 1.0, sum = binomial;
        /* Two terms in a row count for nothing, since h may vanish once. */
        for (int k = 1, idle = 0; k < MAX_SERIES && idle < 2; k++) {
            power *= ec;
            h = ea * h + power;
            binomial *= (beta - k - 1) / (k + 2);
            sum += binomial * h;
            idle = fabs(binomial * h) <= 0.1 * DBL_EPSILON * fabs(sum) ? idle + 1 : 0;
        }
        total += f->mu[s][0] * (1 + f->e[s][b]) * sum;
    }
    return total / (f->x[b] * f->x[b]);
}

/* All [x_a, x_b, x_c] of moment 0, in any order of indices. */
static void second_differences(const struct frame *f, double dd[3][3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++)
            for (int c = b; c < 3; c++) {
                const double gap = f->x[a] - f->x[c];
                const double v = gap < close_spread * f->x[b]
                                     ? series(f, a, b, c)
                                     : (f->d[0][a][b] - f->d[0][b][c]) / gap;
                dd[a][b][c] = dd[a][c][b] = dd[b][a][c] = v;
                dd[b][c][a] = dd[c][a][b] = dd[c][b][a] = v;
            }
}

/* G' of G, and back: B = sum_ab B'_ab u_a v_b^T. */
static void to_frame(const struct frame *f, const double G[9], double g[3][3])
{
    double w[3];
    for (int b = 0; b < 3; b++) {
        pm_mul3(G, f->v[b], w);
        for (int a = 0; a < 3; a++)
            g[a][b] = pm_dot3(f->u[a], w);
    }
}

static void from_frame(const struct frame *f, double b[3][3], double B[9])
{
    memset(B, 0, 9 * sizeof *B);
    for (int a = 0; a < 3; a++)
        for (int J = 0; J < 3; J++) {
            const double w = b[a][0] * f->v[0][J] + b[a][1] * f->v[1][J] + b[a][2] * f->v[2][J];
            for (int i = 0; i < 3; i++)
                B[3 * i + J] += f->u[a][i] * w;
        }
}

double pm_ogden_stress(const struct pm_ogden *o, const double F[9], double P[9])
{
    struct frame f;
    const double W = set_frame(o, F, &f);
    if (P != NULL) {
        double p[3][3] = {{0}};
        for (int a = 0; a < 3; a++)
            p[a][a] = f.tau[a] / f.l[a];
        from_frame(&f, p, P);
    }
    return W;
}

/* A += s B B2^T */
static void add_outer(double s, const double B[9], const double B2[9], double A[81])
{
    for (int k = 0; k < 9; k++)
        for (int m = 0; m < 9; m++)
            A[9 * k + m] += s * B[k] * B2[m];
}

/* In the frame A couples the three diagonal entries (second derivatives of W by stretches), and
 * each pair ab with ba: A_abab = [tau_a, tau_b], A_abba = (x_b A_abab - tau_b) / (l_a l_b). */
void pm_ogden_tangent(const struct pm_ogden *o, const double F[9], double A[81])
{
    struct frame f;
    double B[3][3][9]; /* u_a v_b^T */
    set_frame(o, F, &f);
    first_differences(&f);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int k = 0; k < 9; k++)
                B[a][b][k] = f.u[a][k / 3] * f.v[b][k % 3];
    memset(A, 0, 81 * sizeof *A);
    const double *Y = f.Y[1], third = (Y[0] + Y[1] + Y[2]) / 3;
    for (int a = 0; a < 3; a++) {
        double row[9] = {0}, shear[9];
        for (int b = 0; b < 3; b++) {
            double w = Y[a] + Y[b] - third;
            if (a == b)
                w -= 3 * Y[a] + f.tau[a];
            pm_axpy9(w / (f.l[a] * f.l[b]), B[b][b], row);
        }
        add_outer(1.0, B[a][a], row, A);
        for (int b = 0; b < 3; b++) {
            if (a == b)
                continue;
            const double d = f.d[0][a][b], cross = f.x[b] * d - f.tau[b];
            for (int k = 0; k < 9; k++)
                shear[k] = d * B[a][b][k] + cross / (f.l[a] * f.l[b]) * B[b][a][k];
            add_outer(1.0, B[a][b], shear, A);
        }
    }
}

/* First derivatives in direction G, in the frame. */
struct variation {
    double g[3][3]; /* G' */
    double tr;      /* d log J [G] */
    double E[3][3]; /* dC [G] */
    double M[3][3]; /* dM [G] = -M G^T M */
    double Y[3][3]; /* dY [G] */
};

static void deviator(double Y[3][3])
{
    const double mean = (Y[0][0] + Y[1][1] + Y[2][2]) / 3;
    for (int a = 0; a < 3; a++)
        Y[a][a] -= mean;
}

static void vary(const struct frame *f, const double G[9], struct variation *v)
{
    to_frame(f, G, v->g);
    v->tr = v->g[0][0] / f->l[0] + v->g[1][1] / f->l[1] + v->g[2][2] / f->l[2];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            v->E[a][b] = f->l[a] * v->g[a][b] + f->l[b] * v->g[b][a];
            v->M[a][b] = -v->g[b][a] / (f->l[a] * f->l[b]);
            v->Y[a][b] = f->d[0][a][b] * v->E[a][b] + (a == b ? v->tr * f->Y[1][a] : 0.0);
        }
    deviator(v->Y);
}

void pm_ogden_apply(const struct pm_ogden *o, const double F[9], const double G[9], double AG[9])
{
    struct frame f;
    struct variation v;
    double r[3][3];
    set_frame(o, F, &f);
    first_differences(&f);
    vary(&f, G, &v);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            r[a][b] = v.M[a][b] * f.tau[b] + v.Y[a][b] / f.l[a];
    from_frame(&f, r, AG);
}

/* Y'' = d2Y [G, H] = dev( lG lH Y2 + lGH Y1 + lG D1[EH] + lH D1[EG] + D0[EGH] + D00[EG, EH] ), l
 * variations of log J, Dm[E]_ab = Ym[x_a, x_b] E_ab, D00[E, E']_ab = Y0[x_a, x_c, x_b] (E_ac E'_cb
 * + E'_ac E_cb). */
static void second_variation(const struct frame *f, const struct variation *G,
                             const struct variation *H, double Y[3][3])
{
    double dd[3][3][3], tr = 0.0;
    second_differences(f, dd);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            tr += G->M[a][b] * H->g[a][b];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double s = f->d[1][a][b] * (G->tr * H->E[a][b] + H->tr * G->E[a][b]), egh = 0.0;
            for (int c = 0; c < 3; c++) {
                egh += G->g[c][a] * H->g[c][b] + H->g[c][a] * G->g[c][b];
                s += dd[a][c][b] * (G->E[a][c] * H->E[c][b] + H->E[a][c] * G->E[c][b]);
            }
            Y[a][b] = s + f->d[0][a][b] * egh;
            if (a == b)
                Y[a][b] += G->tr * H->tr * f->Y[2][a] + tr * f->Y[1][a];
        }
    deviator(Y);
}

void pm_ogden_third(const struct pm_ogden *o, const double F[9], const double G[9],
                    const double H[9], double T[9])
{
    struct frame f;
    struct variation g, h;
    double Y[3][3], r[3][3];
    set_frame(o, F, &f);
    first_differences(&f);
    vary(&f, G, &g);
    vary(&f, H, &h);
    second_variation(&f, &g, &h, Y);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double M = 0.0, MY = 0.0; /* d2M = M G^T M H^T M + M H^T M G^T M */
            for (int c = 0; c < 3; c++) {
                M -= g.M[a][c] * h.g[b][c] + h.M[a][c] * g.g[b][c];
                MY += g.M[a][c] * h.Y[c][b] + h.M[a][c] * g.Y[c][b];
            }
            r[a][b] = M / f.l[b] * f.tau[b] + MY + Y[a][b] / f.l[a];
        }
    from_frame(&f, r, T);
}
