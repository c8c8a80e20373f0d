/* A morphed mesh whose curved elements suffer: their mid-side nodes move towards their chords. */
#ifndef PM_REDAMP_H
#define PM_REDAMP_H

#include "common/files/mesh.h"
#include "common/mechanics/extension.h"

/* Until every element of m, morphed to phi, has a scaled Jacobian of `bound`, at most three times:
 * the mid-side surface nodes of the others get 0.7 of their weights and 0.3 of the mean of their
 * edge's two vertices, as the factor t of a new mesh (curve.h) would, and the mesh is morphed
 * again. x stays linear in phi, the connectivity stays. *damped counts such nodes. */
enum pm_status pm_redamp(struct pm_mesh *m, struct pm_extension *ext, const double *phi,
                         double bound, ptrdiff_t *damped, struct pm_err *err);

#endif
