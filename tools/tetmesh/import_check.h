/* What an imported mesh must satisfy. All PM_INPUT, naming nodes by the file's numbers (m->tag). */
#ifndef PM_IMPORT_CHECK_H
#define PM_IMPORT_CHECK_H

#include "common/files/mesh.h"

/* Finite and distinct positions. */
enum pm_status pm_import_check_nodes(const struct pm_mesh *m, struct pm_err *err);
/* det dX/dxi > 0 at vertices, middles of edges, centroid and quadrature points. */
enum pm_status pm_import_check_elements(const struct pm_mesh *m, struct pm_err *err);
/* One part, joined by faces; at most one tetrahedron on either side of a face. vertices (ne x 4).
 */
enum pm_status pm_import_check_parts(const struct pm_mesh *m, const int32_t *vertices,
                                     struct pm_err *err);
/* One middle node on every edge. */
enum pm_status pm_import_check_middles(const struct pm_mesh *m, const int32_t *vertices,
                                       struct pm_err *err);
/* There is a base, or there are three symmetry planes. */
enum pm_status pm_import_check_held(const struct pm_mesh *m, struct pm_err *err);
/* All nodes of a symmetry plane are on one plane across its axis. */
enum pm_status pm_import_check_planes(const struct pm_mesh *m, struct pm_err *err);
/* Chambers are closed up to symmetry planes. */
enum pm_status pm_import_check_closed(const struct pm_mesh *m, struct pm_err *err);

#endif
