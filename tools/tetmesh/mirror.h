/* The coordinate mirrors of a design: the part that is meshed, and its images. */
#ifndef PM_MIRROR_H
#define PM_MIRROR_H

#include "common/files/mesh.h"
#include "common/files/surfaces.h"

/* Bit j of a set of planes stands for x_j = 0 (j = 0: x, 1: y). */
struct pm_mirrors {
    unsigned planes; /* all mirrors of the case */
    unsigned own;    /* those that take every chamber to itself: a part of the body is a model */
    ptrdiff_t op[2]; /* operation of the mirror at x_j = 0, where it is in planes */
};

void pm_mirrors_find(const struct pm_surfaces *s, struct pm_mirrors *y);
/* PM_INPUT where the control points are not images of each other under the group of the case, if it
 * has mirrors. */
enum pm_status pm_mirrors_check(const struct pm_surfaces *s, const struct pm_mirrors *y,
                                struct pm_err *err);
/* Planes of `y` that take surface k to itself; *kept = 0 for a chamber on the far side of one that
 * does not. */
unsigned pm_mirrors_cut(const struct pm_mirrors *y, const struct pm_surfaces *s, ptrdiff_t k,
                        int *kept);
/* Planes on which m has faces. */
unsigned pm_mirrors_of(const struct pm_mesh *m);
/* m with its image under the mirror at x_axis = 0, which its faces on that plane are: nodes on it
 * are shared, the others are images bit by bit. */
enum pm_status pm_mesh_reflect(const struct pm_surfaces *s, const struct pm_mirrors *y, int axis,
                               struct pm_mesh *m, struct pm_err *err);
/* Images of the nodes at each of the planes at which pm_mesh_reflect completed m, by the order of
 * its elements: image[j] (nn), NULL for other planes; new memory (pm_free). PM_INPUT where m is not
 * such a mesh. */
enum pm_status pm_mesh_images(const struct pm_mesh *m, unsigned planes, int32_t *image[2],
                              struct pm_err *err);

#endif
