/* Better places for the nodes inside, where elements are distorted. */
#ifndef PM_RELOCATE_H
#define PM_RELOCATE_H

#include "common/files/mesh.h"

struct pm_relocate_opts {
    double scaled, mean_ratio; /* bounds of the scaled Jacobian and the mean ratio */
    const int32_t *image[2];   /* images of the nodes at x = 0 and y = 0 (mirror.h), or NULL (nn) */
};

/* Moves nodes of elements below a bound, and their images likewise, so that the worst element
 * around each gets better: vertices with the middles of their edges, or middles alone. Nodes of
 * surfaces and caps stay, nodes of symmetry planes stay on them. Pattern search along the axes,
 * some hundred element qualities per node and sweep. *left: elements that stay below. */
enum pm_status pm_relocate(const struct pm_relocate_opts *o, struct pm_mesh *m, ptrdiff_t *left,
                           struct pm_err *err);

#endif
