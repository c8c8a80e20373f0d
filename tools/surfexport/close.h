/* Closes an open surface where its boundary lies in a plane across an axis. */
#ifndef PM_SURFEXPORT_CLOSE_H
#define PM_SURFEXPORT_CLOSE_H

#include "tools/surfexport/skin.h"

/* Adds triangles between the open edges whose nodes have exactly x[axis] = value, outward normal
 * along +axis or -axis by `sense`: polygons with holes, ears clipped best first, no new nodes.
 * Chains of edges that end must end on one line along an axis; their ends are joined there, two by
 * two in order, and these new edges stay open (they belong to the next plane). PM_NUMERIC where the
 * boundary touches or crosses itself. Cost: about the square of the number of edges. */
enum pm_status skin_close(struct skin *s, int axis, double value, int sense, int32_t tag,
                          struct pm_err *err);
/* The closed loops of open edges in that plane, directed as in their triangles: node ids one after
 * the other, loop l is node[first[l]] .. node[first[l + 1] - 1]. */
struct skin_loops {
    ptrdiff_t n;
    ptrdiff_t *first; /* (n + 1) */
    int32_t *node;
};
enum pm_status skin_find_loops(const struct skin *s, int axis, double value,
                               struct skin_loops *loops, struct pm_err *err);
void skin_loops_release(struct skin_loops *loops);
/* Signed area of loop l seen along -axis [mm2]. */
double skin_loop_area(const struct skin *s, const struct skin_loops *loops, ptrdiff_t l, int axis);
/* 1: the point p (3), projected along the axis, is inside loop l. */
int skin_loop_contains(const struct skin *s, const struct skin_loops *loops, ptrdiff_t l, int axis,
                       const double *p);

#endif
