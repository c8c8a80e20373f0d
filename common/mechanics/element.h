/* Elements with blended dilatation, a potential each, a batch of lanes at a time:
 *   Pi_e = sum_q w_q [ W_iso(F_q) + b U(J_q) + (1 - b) U(Jbar_q) ],
 * Jbar = the projection of J on the modes (constant, or linear) in the reference element. b = 1 is
 * the plain displacement element, b = 0 with one mode mean dilatation, b = 2 mu/kappa the default
 * (pneumorph-model(7)). Nodal arrays are (npe x 3), u displacements, v, w directions at deformed
 * nodes. */
#ifndef PM_ELEMENT_H
#define PM_ELEMENT_H

#include "common/mechanics/law.h"
#include "common/mechanics/space.h"

struct pm_element {
    const struct pm_element_type *type;
    const struct pm_law *law;
    double blend;        /* b */
    const pm_lanes *dN;  /* dN_a/dX at the points (nq x npe x 3) [1/mm] */
    const pm_lanes *w;   /* quadrature weight times det dX/dxi (nq) [mm3] */
    const pm_lanes *phi; /* modes at the points, sum_q w phi_k phi_l = delta_kl (modes x nq)
                            [mm^-3/2] */
};

double pm_element_blend(const struct pm_element_type *type, const struct pm_law *law);

/* Gradients dN_a/dX (npe x 3) [1/mm] at the reference point xi of an element X (npe x 3); returns
 * det dX/dxi. */
double pm_element_gradients(const struct pm_element_type *type, const double *X, const double xi[3],
                            double *dN);
/* Modes of the dilatation at n points: 1, xi_1, xi_2, xi_3 made orthonormal in the sum over w
 * (modified Gram-Schmidt); phi (modes x n). Points of weight 0 are only evaluated. */
void pm_element_modes(const struct pm_element_type *type, int n, const double (*xi)[3],
                      const double *w, double *phi);
/* Geometry of one element X (npe x 3) in lane l: dN, w, phi. Returns the smallest det dX/dxi at the
 * points; where that is not positive nothing is of use. */
double pm_element_geometry(const struct pm_element_type *type, const double *X, int lane,
                           pm_lanes *dN, pm_lanes *w, pm_lanes *phi);

/* Energy [mJ], nodal forces f (NULL: not wanted) and the smallest det F; where that is not positive
 * the energy is infinite and f of no use. */
void pm_element_energy(const struct pm_element *el, const pm_lanes *u, pm_lanes *f,
                       pm_lanes *energy, pm_lanes *min_det);
/* Blocks a <= b of K: K[9 (b (b + 1)/2 + a) + 3 i + j] = d2Pi/dx_ai dx_bj. mixed (nq x
 * PM_MIXED): independent pressures and stresses of the geometric part; NULL: the exact ones. */
void pm_element_tangent(const struct pm_element *el, const pm_lanes *u, const pm_lanes *mixed,
                        pm_lanes *K);
/* Mixed integration points (Magisano, Leonetti, Garcea 2017): at each point the pressure and the
 * second Piola-Kirchhoff stress 11 22 33 12 23 13 at u, linearised along du. They are free of the
 * strain that a straight step of rotating parts leaves. */
enum { PM_MIXED = 7 };
void pm_element_mixed(const struct pm_element *el, const pm_lanes *u, const pm_lanes *du,
                      pm_lanes *mixed);
/* f = K v */
void pm_element_apply(const struct pm_element *el, const pm_lanes *u, const pm_lanes *v,
                      pm_lanes *f);
/* f = D3 Pi_e [v, w, .] */
void pm_element_third(const struct pm_element *el, const pm_lanes *u, const pm_lanes *v,
                      const pm_lanes *w, pm_lanes *f);
/* Explicit shape derivative at fixed deformed positions [model 4.3]: D (npe x 3) = d/dX of
 *   dPi_e[g] + sum_r d2Pi_e[v_r, h_r],  v, h (n x npe x 3). */
void pm_element_shape(const struct pm_element *el, const pm_lanes *u, const pm_lanes *g, int n,
                      const pm_lanes *v, const pm_lanes *h, pm_lanes *D);

#endif
