/* What an imported mesh must satisfy. All PM_INPUT, naming nodes by the file's numbers (m->tag). */
#ifndef PM_IMPORT_CHECK_H
#define PM_IMPORT_CHECK_H

#include "common/files/mesh.h"

/* Finite and distinct positions. */
enum pm_status pm_import_check_nodes(const struct pm_mesh *m, struct pm_err *err);
/* det dX/dxi > 0 at vertices, middles of edges, centroid and quadrature points. */
enum pm_status pm_import_check_elements(const struct pm_mesh *m, struct pm_err *err);
/* One part. */
enum pm_status pm_import_check_parts(const struct pm_mesh *m, struct pm_err *err);
/* Chambers closed up to symmetry planes, symmetry planes planar, and the body held. */
enum pm_status pm_import_check_faces(const struct pm_mesh *m, struct pm_err *err);

#endif
