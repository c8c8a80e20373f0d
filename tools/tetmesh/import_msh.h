/* A mesh of a gmsh file as a mesh record. */
#ifndef PM_IMPORT_MSH_H
#define PM_IMPORT_MSH_H

#include "common/files/mesh.h"

/* Takes the physical groups body (tetrahedra), base, tip, chamber1.., exterior, symmetry-x|y|z
 * (triangles; faces in no group are exterior unless that group is given). Tetrahedra keep
 * their 4 or 10 nodes; with `promote` those of 4 get mid-side nodes in the middle of their straight
 * edges, with node number 0 in m->tag. Fills m but the case; the reference point becomes the
 * centroid of the whole body's tip, or the origin if there is none. PM_INPUT naming the item for:
 * no body; no base and not three symmetry planes; a tetrahedron that is inverted or flat;
 * coinciding or infinite nodes; parts that are not joined by faces; triangles that are not free
 * faces; chambers that are neither closed nor end at symmetry planes; symmetry planes that are not
 * planar. PM_USAGE: `promote` for 10-node tetrahedra. */
enum pm_status pm_import_msh(const char *path, int promote, struct pm_mesh *m, struct pm_err *err);

#endif
