/* Boundary form of the shape derivative [model 4.4; paper 36-50]. */
#ifndef PM_HADAMARD_H
#define PM_HADAMARD_H

#include "common/mechanics/model.h"

struct pm_objective;

/* One chamber s of an adjoint: nodal fields of v1_s and J_s (nn x 3). */
struct pm_hadamard_column {
    ptrdiff_t s;
    const double *v, *h;
};

struct pm_hadamard {
    const double *p; /* [MPa] (nc) */
    double scale;    /* unit of pressure of J [MPa] */
    const double *g; /* nodal field of v2, second maps added (nn x 3) */
    ptrdiff_t n;
    struct pm_hadamard_column column[PM_MAX_CHAMBERS];
};

/* Where the free boundary moves by L along its normal m out of the solid, dw = int L_w L dA,
 *   L_w = (P + p_q cof F) : G2 - w_V,q det F
 *       + sum_s [ H_s : A : G1_s + p_q (F x H_s) : G1_s + d_qs scale cof F : G1_s - w_C,qs cof F :
 * H_s ],
 * q the chamber there (no such terms on the exterior), G2, G1_s, H_s the gradients of g, v_s, h_s.
 * Its values at points of the faces, times the shape functions and m, make D (nn x 3, overwritten).
 * The surface is taken to be smooth; base, tip and symmetry planes do not move. */
enum pm_status pm_hadamard(const struct pm_model *m, const struct pm_config *c,
                           const struct pm_hadamard *h, const struct pm_objective *w, double *D,
                           struct pm_err *err);

#endif
