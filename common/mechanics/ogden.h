/* Isochoric Ogden law of 1 to 6 terms [model 1.2], in principal stretches l_a of F:
 *
 *   W_iso = sum_s mu_s / alpha_s (lb_1^alpha_s + lb_2^alpha_s + lb_3^alpha_s - 3),
 *   lb_a = J^(-1/3) l_a,  small-strain shear modulus mu = 1/2 sum_s mu_s alpha_s.
 *
 * This is the convention of Ogden (1972); constants after Abaqus (W = sum 2 mu_i / alpha_i^2 ..)
 * become mu_s = 2 mu_i / alpha_i, those after FEBio (W = sum c_i / m_i^2 ..) mu_s = c_i / m_i.
 * Exact for repeated and nearly repeated stretches: no difference of close numbers is divided by
 * their distance. All tensors 3x3 row major, [MPa]; det F > 0. */
#ifndef PM_OGDEN_H
#define PM_OGDEN_H

#include <stddef.h>

enum { PM_OGDEN_TERMS = 6 };

struct pm_ogden {
    ptrdiff_t n;     /* terms, 1 to PM_OGDEN_TERMS */
    const double *c; /* {mu, alpha} of each term  (n x 2) [MPa, 1], alpha not 0 */
};

/* Returns W_iso; P = dW_iso/dF (NULL: not wanted). */
double pm_ogden_stress(const struct pm_ogden *o, const double F[9], double P[9]);
/* A = d2W_iso/dF2 as a symmetric (9 x 9) matrix. About 1 us for one term. */
void pm_ogden_tangent(const struct pm_ogden *o, const double F[9], double A[81]);
/* A : G */
void pm_ogden_apply(const struct pm_ogden *o, const double F[9], const double G[9], double AG[9]);
/* T(G, H) = d/dF (G : A : H) */
void pm_ogden_third(const struct pm_ogden *o, const double F[9], const double G[9],
                    const double H[9], double T[9]);

#endif
