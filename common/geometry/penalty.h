/* Constraints of a design on fixed samples q of its surfaces, each g <= 0 [paper 79, 80; model 8]:
 *
 *   curvature  g = Q/Cmax^2 - 1,  Q = c1^2 + c2^2
 *   wall       g = 1 - m.(r_q - r*)/d
 *   bounds     g = depth/wall_min beyond the planes of the ends and the sides of the domain
 *
 * r* is the foot of the sample on what it faces, m the unit vector from there into the solid: at a
 * foot the derivative of the distance with r* and m held is the exact one, and where surfaces have
 * crossed m pulls them back.
 * d = wall_min through the solid, void_min through a void (a thin cavity, a groove), to other
 * surfaces and to parts of the same one that are further along it than the fold of least diameter
 * D = min(wall_min, 2/Cmax), 1.6 D; of these d is at most D + (distance along - 1.6 D)/4.
 * Chambers keep cap_min from the end planes, the exterior ends there. What no free control point
 * moves does not count. Every constraint has the weight a_q, the sample's share of the area, and a
 * multiplier lambda of the augmented Lagrangian
 *
 *   L = sum a_q (<lambda + rho g>^2 - lambda^2)/(2 rho),  <x> = max(x, 0);
 *
 * the penalties of the merit are C_c and C_t = sum a_q <g>^2. The symmetry of the surfaces is used:
 * phi must be symmetric, only samples of one fundamental domain are evaluated. */
#ifndef PM_PENALTY_H
#define PM_PENALTY_H

#include "common/geometry/samples.h"

/* A sample and its foot on what it faces. */
struct pm_penalty_wall {
    int32_t i, other; /* as in struct pm_near; sorted by i, then other */
    double S[3];      /* parameter of the foot */
    double m[3];
    double limit; /* d [mm] */
    double multiplier;
    ptrdiff_t first; /* its weights end where those of the next wall begin */
};

struct pm_penalty {
    const struct pm_surfaces *s; /* borrowed */
    const struct pm_case *c;
    struct pm_samples samples;
    struct pm_map *map[PM_MAX_CHAMBERS + 1];
    struct pm_basis work;
    unsigned char *from, *flag; /* evaluated at all; what to evaluate, private bits (n) */
    double *share;              /* a_q, times the operations of the symmetry (n) */
    double *x, *normal;         /* scratch (n x 3) [mm] */
    double *bend;               /* multipliers of the curvature (n) */
    double *bound;              /* multipliers of the bounds x or radius, y, z (n x 3) */
    ptrdiff_t nwall, nw, capacity;
    struct pm_penalty_wall *wall; /* (nwall + 1): an end behind the last */
    int32_t *col;                 /* weights of the feet: global control point, weight (nw) */
    double *weight;
    double *places, *pull; /* scratch: control points, gradient (N x 4) */
    double cover;          /* samples lie closer than this to every point of a surface [mm] */
};

struct pm_penalty_value {
    double lagrangian;
    double sum[2];   /* C_c, C_t */
    double worst[2]; /* largest relative excess of curvature and lack of distance, >= 0 */
};

enum pm_status pm_penalty_new(const struct pm_surfaces *s, struct pm_penalty *p,
                              struct pm_err *err);
void pm_penalty_release(struct pm_penalty *p);
/* Finds the feet at phi (N x 3) of everything closer than `reach` mm to its limit and the samples
 * with more than `calm` times Cmax; multipliers of what was known are kept. */
enum pm_status pm_penalty_collect(struct pm_penalty *p, const double *phi, double reach,
                                  double calm, struct pm_err *err);
/* The collected constraints at phi with rho of curvature and walls; gradient (N x 3) += dL/dphi
 * unless NULL. */
void pm_penalty_at(const struct pm_penalty *p, const double *phi, const double rho[2],
                   double *gradient, struct pm_penalty_value *v);
/* By surface: the largest relative excess of curvature (ns), and the largest lack of distance
 * between surfaces a <= b (ns x ns): a = b between parts of one, or beyond the bounds; >= 0. */
void pm_penalty_worst(const struct pm_penalty *p, const double *phi, double *curvature,
                      double *wall);
/* The same of surfaces by themselves, with samples of their own. */
enum pm_status pm_penalty_survey(const struct pm_surfaces *s, double *curvature, double *wall,
                                 struct pm_err *err);
/* lambda <- <lambda + rho g> at phi. */
void pm_penalty_raise(struct pm_penalty *p, const double *phi, const double rho[2]);
/* lambda <- 0 */
void pm_penalty_relax(struct pm_penalty *p);
/* Lumped mass M_m of the control points over the area, averaged over symmetry orbits (N): sum M_m
 * |step_m|^2 is the mean square displacement of the surfaces. */
void pm_penalty_mass(const struct pm_penalty *p, double *mass);
/* Largest part 1, 1/2, 1/4 .. of a step for which no area element falls below a fifth of its size.
 */
double pm_penalty_safe_part(const struct pm_penalty *p, const double *phi, const double *step);

#endif
