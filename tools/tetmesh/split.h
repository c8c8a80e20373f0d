/* Tetrahedra with two faces on one smooth surface: their corner angle tends to 180 degrees on the
 * true surface, so that no mid-side node can make them valid. */
#ifndef PM_SPLIT_H
#define PM_SPLIT_H

#include "tools/tetmesh/shell.h"
#include "tools/tetmesh/volume_gmsh.h"

/* Removes the edge opposite to their common one (best triangulation of the ring around it,
 * Klincsek) or, where that gives no good tetrahedra, puts a node on it. *left: those that stayed.
 */
enum pm_status pm_split_two_faces(const struct pm_shell *shell, struct pm_tetra *t, ptrdiff_t *left,
                                  struct pm_err *err);

#endif
