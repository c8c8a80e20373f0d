/* Penalties of the trust-region sub-problem on fixed samples of the surfaces [paper 79, 80; model
 * 8]:
 *
 *   curvature  sum_q a_q <Q_q - Cmax^2>^2 / Cmax^4,  Q = c1^2 + c2^2, a_q = share of the area
 *   wall       sum_ij a_i area_j/d^2 <d^2 - |r_i - r_j|^2>^2 / d^4 over pairs of samples,
 *              + sum_q a_q (<c - z_q>^2 + <z_q - H + c>^2) / wall_min^2, the planes of the ends
 *
 * <x> = max(x, 0). The distance d is wall_min, plus a margin for the spacing of samples, where the
 * pair looks at each other through the solid; pairs of one surface that look at each other across a
 * void (the two sides of a thin cavity, of a groove) keep VOID_SHARE of it; neighbours on one
 * surface count from a path length of GEODESIC wall_min on. c = cap_min for chambers, and the
 * exterior stays between the end planes. Samples that no free control point moves do not count. */
#ifndef TRSTEP_PENALTY_H
#define TRSTEP_PENALTY_H

#include "common/geometry/samples.h"

struct penalty_pair {
    int32_t i, j;
    double limit;  /* d [mm] */
    double weight; /* a_i area_j/d^2 [1] */
};

struct penalty {
    const struct pm_case *c; /* borrowed */
    struct pm_samples samples;
    double *share; /* a_q, 0 where nothing is free (n) */
    double margin; /* of the distance between samples over that of the surfaces [mm] */
    double *x;     /* positions, scratch (n x 3) [mm] */
    double *force; /* dC/dr of the samples, scratch (n x 3) */
};

/* What may become active within the reach of a step. */
struct penalty_watch {
    unsigned char *flag; /* what to evaluate, private bits (n) */
    ptrdiff_t npair;
    struct penalty_pair *pair; /* by i, then j (npair) */
};

struct penalty_value {
    double curvature, wall; /* the sums above, without weights rho */
    double worst_curvature,
        worst_wall; /* largest relative excess of curvature and lack of distance, >= 0 */
};

enum pm_status penalty_new(const struct pm_surfaces *s, struct penalty *p, struct pm_err *err);
void penalty_release(struct penalty *p);
/* Adds to *watch (empty: zeros) what can become active if every point moves by at most `reach` mm
 * from phi (N x 3) and curvatures below `calm` times Cmax do not; reach 0, calm 1: the present
 * violations. */
enum pm_status penalty_collect(struct penalty *p, struct penalty_watch *watchatch,
                               const double *phi, double reach, double calm, struct pm_err *err);
void penalty_watch_release(struct penalty_watch *watch);
/* The collected terms at phi; gradient (N x 3) += d(rho_c curvature + rho_t wall)/dphi unless NULL.
 */
void penalty_at(struct penalty *p, const struct penalty_watch *watchatch, const double *phi,
                const double rho[2], double *gradient, struct penalty_value *v);
/* Largest part t in (0, 1] of a step for which no watched pair moves by more than half its distance
 * (walls cannot be crossed) and no area element falls below FOLD_SHARE of its size. */
double penalty_safe_part(struct penalty *p, const struct penalty_watch *watchatch,
                         const double *phi, const double *step);

#endif
