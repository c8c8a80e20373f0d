/* Hyperelastic laws through invariants [model 1]: W = W_iso(I1, I2, J) + U(J), U = kappa/2 (J -
 * 1)^2, paper (87). All tensors 3x3 row major, [MPa]. */
#ifndef PM_LAW_H
#define PM_LAW_H

#include <stddef.h>

#include "common/base/status.h"
#include "common/mechanics/lanes.h"

enum { PM_LAW_MAX = 12 };

/* In the order of common/files/material.c. */
enum pm_law_kind { PM_LAW_NEO_HOOKEAN, PM_LAW_MOONEY_RIVLIN, PM_LAW_YEOH, PM_LAW_OGDEN };

struct pm_law {
    enum pm_law_kind kind;
    /* neo-Hookean {mu}; Mooney-Rivlin {c10, c01}; Yeoh {c1, c2, c3}; Ogden {mu1, alpha1, mu2,
     * alpha2, ..}: alpha [1], all others [MPa] */
    double c[PM_LAW_MAX];
    ptrdiff_t n;  /* how many of c */
    double mu;    /* small-strain shear modulus [MPa] */
    double kappa; /* bulk modulus               [MPa] */
};

/* By name: neo-hookean, mooney-rivlin, yeoh, ogden; c (n) as above, of yeoh 1 to 3, of ogden 1 to 6
 * pairs. */
enum pm_status pm_law_set(struct pm_law *law, const char *name, ptrdiff_t n, const double *c,
                          double kappa, struct pm_err *err);

/* At a batch of points F (det F > 0), in lanes. Isochoric part: W_iso and P_iso = dW_iso/dF (NULL:
 * not wanted). */
void pm_law_stress(const struct pm_law *law, const pm_lanes F[9], pm_lanes *W, pm_lanes P[9]);
/* A_iso = d2W_iso/dF2 as a symmetric (9 x 9) matrix. */
void pm_law_tangent(const struct pm_law *law, const pm_lanes F[9], pm_lanes A[81]);
/* A_iso : G */
void pm_law_apply(const struct pm_law *law, const pm_lanes F[9], const pm_lanes G[9],
                  pm_lanes AG[9]);
/* T_iso(G, H) = d/dF (G : A_iso : H) */
void pm_law_third(const struct pm_law *law, const pm_lanes F[9], const pm_lanes G[9],
                  const pm_lanes H[9], pm_lanes T[9]);

#endif
