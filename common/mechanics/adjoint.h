/* Continuum Jacobian, and the second-order adjoints of one load case [model 4.1-4.4]. */
#ifndef PM_ADJOINT_H
#define PM_ADJOINT_H

#include "common/mechanics/model.h"

/* J_r = dq/dp_r for the unit of pressure `scale` [MPa]: q-vectors Jq (nc x nq), and their
 * end-effector rows J (6 x nc). The model holds the factor of the exact tangent at c. */
enum pm_status pm_jacobian(struct pm_model *m, const struct pm_config *c, double scale, double *Jq,
                           double *J, struct pm_err *err);

/* Compliance C_rs = dV_r/dp_s of the chambers, per `scale` of pressure: C (nc x nc) [mm3]. */
enum pm_status pm_compliance(const struct pm_model *m, const struct pm_config *c, const double *Jq,
                             double *C, struct pm_err *err);

/* A function w(U, J, V, C, x) of the pose, its Jacobian, the volumes V_r of the chambers, their
 * compliance C_rs = dV_r/dp_s and the deformed nodes x, by its partial derivatives; derivatives by
 * pressure are per `scale`.
 */
struct pm_objective {
    double U[6];
    double J[6][PM_MAX_CHAMBERS];
    double V[PM_MAX_CHAMBERS];
    double C[PM_MAX_CHAMBERS][PM_MAX_CHAMBERS];
    const double *x; /* by the positions of the nodes (nn x 3), NULL: none; domain form only */
};

/* An equilibrium: p [MPa], f nodal forces at c, Jq as from pm_jacobian; the model holds the factor
 * of its tangent. */
struct pm_adjoint_at {
    struct pm_model *m;
    const struct pm_config *c;
    const double *p, *f, *Jq;
    double scale; /* [MPa] */
};

enum pm_shape_form {
    PM_SHAPE_DOMAIN,  /* exact derivative of the discrete problem by all nodes   [model 4.3] */
    PM_SHAPE_BOUNDARY /* integral over the free boundary, zero rows elsewhere     [model 4.4] */
};

/* D = dw/dX (n x nn x 3) and D_ref = dw/dX_ref (n x 3; 0 in the boundary form) of n functions w at
 * fixed loads. Solves, all functions at once: one right-hand side for each of their columns dw/dJ_r
 * or dw/dC_r that is not 0, then one each. */
enum pm_status pm_adjoint(const struct pm_adjoint_at *at, ptrdiff_t n, const struct pm_objective *w,
                          enum pm_shape_form form, double *D, double *D_ref, struct pm_err *err);

#endif
