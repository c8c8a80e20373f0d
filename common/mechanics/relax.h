/* A displacement freed of the strain that interpolation leaves in it. */
#ifndef PM_RELAX_H
#define PM_RELAX_H

#include "common/mechanics/model.h"

/* One linear step of c towards equilibrium at p (nc) [MPa], the end-effector held, with the
 * stiffness of the deformed body as if it had no stress: definite however wrong the stresses are
 * that a displacement carried between meshes implies, and stiff where these err most, in the change
 * of volume. One analysis and one factorisation. PM_INPUT where the deformed body has inverted
 * elements. */
enum pm_status pm_relax(const struct pm_model *m, const double *p, struct pm_config *c,
                        struct pm_err *err);

#endif
