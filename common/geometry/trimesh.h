/* Triangle meshes that no map stands behind: topology, soundness, mirror images. */
#ifndef PM_TRIMESH_H
#define PM_TRIMESH_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_trimesh {
    ptrdiff_t nn, nt;
    double *x;    /* places (nn x 3) [mm] */
    int32_t *tri; /* nodes, counter-clockwise seen from outside (nt x 3) */
};

void pm_trimesh_release(struct pm_trimesh *m);

/* The triangles (a, next, after) around each node a. */
struct pm_star {
    ptrdiff_t *ptr; /* (nn + 1) */
    int32_t *next;  /* (3 nt) */
    int32_t *after; /* (3 nt) */
};

/* PM_INPUT naming the edge where more than one triangle has the edge (a, b) in this direction: not
 * a manifold, or not consistently oriented. */
enum pm_status pm_star_new(const struct pm_trimesh *m, struct pm_star *star, struct pm_err *err);
void pm_star_release(struct pm_star *star);
/* The third node of the triangle with the directed edge a -> b, -1 where there is none. */
int32_t pm_star_after(const struct pm_star *star, ptrdiff_t a, ptrdiff_t b);
/* The node before the first of a: a -> it is a boundary edge without triangle on its left; -1 for
 * an interior node. */
int32_t pm_star_last(const struct pm_star *star, ptrdiff_t a);

/* Is it one sphere with `loops` holes? PM_INPUT naming the first node or edge that is not: unused
 * nodes, edges of one triangle (loops = 0) or of three, fans that touch in a node, several parts, a
 * wrong Euler number. */
enum pm_status pm_trimesh_check(const struct pm_trimesh *m, const struct pm_star *star, int loops,
                                struct pm_err *err);
/* image (nn): the node at the mirror image of each in the plane x_axis = at, which must lie within
 * `tolerance` [mm]; PM_INPUT naming the first node without one. */
enum pm_status pm_trimesh_mirror(const struct pm_trimesh *m, int axis, double at, double tolerance,
                                 int32_t *image, struct pm_err *err);
/* The same surface with no edge longer than `longest` [mm]: edges are halved, triangles cut into
 * two, three or four, as often as it takes. PM_INPUT where that takes more than 2e6 nodes. */
enum pm_status pm_trimesh_refine(const struct pm_trimesh *m, double longest, struct pm_trimesh *out,
                                 struct pm_err *err);
/* Lowest and highest coordinates. */
void pm_trimesh_box(const struct pm_trimesh *m, double low[3], double high[3]);

#endif
