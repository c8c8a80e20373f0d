/* Triangles of a surface made finer where they are off it. */
#ifndef PM_SURFEXPORT_REFINE_H
#define PM_SURFEXPORT_REFINE_H

#include "common/geometry/remesh.h"

/* Splits the longest edge of every triangle that the surface leaves by more than `tolerance` mm,
 * with the triangle beyond it, until there is none or `rounds` are over. The distance is measured
 * at the middles of the edges and near the triangle's own. *error: the largest left [mm]. */
enum pm_status patch_refine(const struct pm_surface *s, const struct pm_map *map, double tolerance,
                            int rounds, struct pm_patch *p, double *error, struct pm_err *err);

#endif
