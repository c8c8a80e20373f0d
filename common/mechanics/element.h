/* The 10-node tetrahedron, 4 points, with blended dilatation: a potential per element,
 *   Pi_e = sum_q w_q [ W_iso(F_q) + b U(J_q) ] + (1 - b) V_e U(Jbar_e),  Jbar_e = sum_q w_q J_q /
 * V_e. b = 1 is the plain displacement element, b = 0 mean dilatation, b = 2 mu/kappa the default
 * (pneumorph-model(7)). Nodal arrays are (10 x 3), u displacements, v, w directions at deformed
 * nodes. */
#ifndef PM_ELEMENT_H
#define PM_ELEMENT_H

#include "common/mechanics/law.h"
#include "common/mechanics/tet10.h"

struct pm_element {
    const struct pm_law *law;
    double blend;     /* b */
    const double *dN; /* dN_a/dX at the points (4 x 10 x 3) [1/mm] */
    const double *w;  /* quadrature weight times det dX/dxi (4) [mm3] */
};

/* b by element name: tet10-blend, tet10, tet10-mean. */
enum pm_status pm_element_blend(const char *name, const struct pm_law *law, double *blend,
                                struct pm_err *err);

/* Energy [mJ] and nodal forces f (added; NULL: not wanted); *min_det is lowered to the smallest det
 * F; where that is not positive the energy is infinite and f untouched. */
double pm_element_energy(const struct pm_element *el, const double *u, double *f, double *min_det);
/* K (30 x 30). pressure (4): pressures of the geometric part, as in mixed Newton (MIP); NULL: the
 * exact ones. */
void pm_element_tangent(const struct pm_element *el, const double *u, const double *pressure,
                        double *K);
/* MIP update: pressure (4) at u, linearised along du. */
void pm_element_pressure(const struct pm_element *el, const double *u, const double *du,
                         double *pressure);
/* f += K v */
void pm_element_apply(const struct pm_element *el, const double *u, const double *v, double *f);
/* f += D3 Pi_e [v, w, .] */
void pm_element_third(const struct pm_element *el, const double *u, const double *v,
                      const double *w, double *f);
/* Explicit shape derivative at fixed deformed positions [model 4.3]: D (10 x 3) += d/dX of
 *   dPi_e[g] + sum_r d2Pi_e[v_r, h_r],  v, h (n x 10 x 3). */
void pm_element_shape(const struct pm_element *el, const double *u, const double *g, int n,
                      const double *v, const double *h, double *D);

#endif
