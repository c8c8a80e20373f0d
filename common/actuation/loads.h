/* Gauss sets of the actuation box [pmin, pmax]^n, reduced by the symmetry of the case
 * [model 7.3, 7.4].
 *
 * Boundary form: m Gauss-Legendre points per axis on each of the 2n faces, faces in the order p_1 =
 * pmin, p_1 = pmax, p_2 = pmin, ..; on a face the last pressure varies fastest. Measure 2R: m
 * points on each of the six edges that bound the image of the cube, (M,0,0) > (M,M,0) > (0,M,0) >
 * .. [model 7.2]. Volume form: m^n points. Of every orbit of points under the usable symmetry
 * operations the first one stays, with the size of the orbit as multiplicity.
 *
 * A symmetry operation of the design is usable if the loaded robot keeps it (it maps the clamped
 * base z = 0 onto itself) and the integrand is even under it: det(Qh restricted to the measure's
 * DoFs) det(Pi) = +1, Qh = diag(Q, det(Q) Q), Pi its chamber permutation. An odd operation makes
 * the whole measure vanish on symmetric designs; it is left out, the remaining ones are used. The
 * manifold measure is even under all. A weight must be kept, too. c->full_set: none is used.
 *
 * The form of the case ends with guards, points without weight that no other one sees. Where
 * gap_min is set: the corners of the box, every chamber at pmin or pmax, where a robot comes
 * closest to itself (one of every orbit; of more than three chambers each one alone). Where that or
 * amplification_max is set, last: all pressures at pmax, where a robot loses its stability first.
 */
#ifndef PM_LOADS_H
#define PM_LOADS_H

#include "common/files/case.h"

struct pm_load {
    double p[PM_MAX_CHAMBERS]; /* [p/mu] */
    int face; /* boundary form: r of the face p_r = const (2R: the pressure that varies along the
                 edge); -1 in the volume form */
    int sign; /* boundary form: +1 on p_r = pmax, -1 on p_r = pmin (2R: +1 where the path runs with
                 rising pressure); volume form: +1 */
    double weight; /* tau = multiplicity * quadrature weight [(p/mu)^(n-1) or (p/mu)^n, 2R: p/mu];
                      0: a guard */
    int multiplicity; /* points of the full set that this one stands for */
};

/* The points of one form, in a fixed order; *loads is new memory (pm_free). PM_INPUT if the form is
 * not defined for the measure or the set is larger than 100000 points. */
enum pm_status pm_load_set(const struct pm_case *c, enum pm_form form, struct pm_load **loads,
                           ptrdiff_t *n, struct pm_err *err);
/* 1 if operation g of the case may be used to drop points of its measure. */
int pm_load_symmetry(const struct pm_case *c, ptrdiff_t g);
/* Edge 0..5 of the path of 2R: the pressure that varies, +1 where it rises, the one at pmax. */
struct pm_edge {
    int varying, sign, high;
};
struct pm_edge pm_load_edge(int e);
/* "boundary" or "volume". */
const char *pm_form_name(enum pm_form form);
enum pm_status pm_form_parse(const char *text, enum pm_form *form, struct pm_err *err);

#endif
