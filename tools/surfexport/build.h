/* The surfaces of a design as triangles. */
#ifndef PM_SURFEXPORT_BUILD_H
#define PM_SURFEXPORT_BUILD_H

#include "common/files/surfaces.h"
#include "tools/surfexport/skin.h"

/* Every surface closed and outward: the exterior with planar caps, then the chambers. Edges of at
 * most about `size` and short enough for the surface to stay within `tolerance` [mm] of the
 * triangles, which is measured at the middles of edges and triangles; *error is what was found.
 * Nodes lie on the surfaces. PM_NUMERIC where finer triangles do not reach the tolerance. */
enum pm_status skin_build(const struct pm_surfaces *s, double size, double tolerance,
                          struct skin *skin, double *error, struct pm_err *err);
/* wall of every node: distance to the nearest triangle of another surface. About n log n. */
enum pm_status skin_walls(struct skin *s, ptrdiff_t nchambers, struct pm_err *err);
/* PM_INPUT where two surfaces meet or a chamber is outside of the exterior. */
enum pm_status skin_check_nesting(const struct skin *s, ptrdiff_t nchambers, struct pm_err *err);

#endif
