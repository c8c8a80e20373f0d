/* Planar faces of a shell: caps at the rims of the exterior, cuts at mirror planes. */
#ifndef PM_FLAT_H
#define PM_FLAT_H

#include "common/geometry/remesh.h"
#include "tools/tetmesh/shell.h"

/* Adds the cap of one rim (1 base, 2 tip) of the exterior, whose patch is the first of the shell,
 * with edges of `size` away from it. PM_INPUT where the rim is not planar. */
enum pm_status pm_flat_cap(struct pm_shell *s, const struct pm_patch *exterior, int rim,
                           double size, double timeout, struct pm_err *err);
/* Adds the faces on all mirror planes, when the rest of the shell stands and is sound: the edge of
 * the body with the chambers that are cut as holes. */
enum pm_status pm_flat_cuts(struct pm_shell *s, double size, double timeout, struct pm_err *err);

#endif
