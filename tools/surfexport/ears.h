/* Triangles of a polygon with holes in the plane. */
#ifndef PM_SURFEXPORT_EARS_H
#define PM_SURFEXPORT_EARS_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct ears_loop {
    ptrdiff_t n;
    const int32_t *node; /* (n) ids into uv */
};

/* loop[0] counter-clockwise, loop[1..] holes clockwise; uv (. x 2). Holes are joined to the outside
 * by bridges between nodes that see each other; then the ear of the best shape is clipped, again
 * and again. Adds `*nt` triangles of node ids to tri, which has room for (total nodes + 2 (nloops -
 * 1) - 2) of them. PM_NUMERIC where the polygon is not simple. */
enum pm_status ears_clip(const struct ears_loop *loop, ptrdiff_t nloops, const double *uv,
                         int32_t *tri, ptrdiff_t *nt, struct pm_err *err);

#endif
