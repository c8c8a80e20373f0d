/* Extension of surface motion to all nodes of a mesh [model 5]: three scalar quadratic Laplace
 * problems, or one of linear elasticity with the shear modulus 1/volume and Poisson's ratio 0.3
 * (key `extension` of the case), on the generated mesh, X_I = X0_I + Ext (X_S - X0_S); every node
 * of surfaces and caps is given. Nodes of symmetry planes stay on them, and are extended to in them
 * as if the body went on behind. */
#ifndef PM_EXTENSION_H
#define PM_EXTENSION_H

#include "common/files/mesh.h"

struct pm_extension;

enum pm_status pm_extension_new(const struct pm_mesh *m, struct pm_extension **e,
                                struct pm_err *err);
/* d (nn x 3): values at nodes of surfaces and caps are given, the others are filled. */
enum pm_status pm_extension_apply(struct pm_extension *e, double *d, struct pm_err *err);
/* Transpose: D (nn x 3) nodal gradient; D_S -= K_SI K_II^-1 D_I on given values, the others
 * cleared. */
enum pm_status pm_extension_transpose(struct pm_extension *e, double *D, struct pm_err *err);
void pm_extension_free(struct pm_extension *e);

/* Moves the surface nodes of m to W phi (N x 3) and the others by the extension, from
 * m->x_generated: m->x. */
enum pm_status pm_mesh_morph(struct pm_mesh *m, struct pm_extension *e, const double *phi,
                             struct pm_err *err);
/* g (N x 3) = W^T D over surface nodes. */
void pm_mesh_pull_back(const struct pm_mesh *m, const double *D, double *g);

#endif
