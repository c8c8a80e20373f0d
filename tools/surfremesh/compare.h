/* How far two forms of one surface lie apart. */
#ifndef PM_SURFREMESH_COMPARE_H
#define PM_SURFREMESH_COMPARE_H

#include "common/geometry/samples.h"

enum { COMPARE_CUTS = 3 }; /* of the triangles of control points */

/* Samples of a surface with their places and normals. */
struct compare_side {
    const struct pm_surface *s;
    struct pm_samples m;
    double *x, *normal; /* (n x 3), (n x 3) */
};
enum pm_status compare_side_init(struct compare_side *c, const struct pm_surface *s,
                                 struct pm_err *err);
void compare_side_release(struct compare_side *c);

/* Distances of the samples of each from the other surface, feet found by Newton: mean over both and
 * the largest [mm]. Feet on the old surface start at S (samples of `now` x 3; it gets the feet),
 * or, S = NULL, as those on the new one at the nearest sample whose normal points the same way. */
enum pm_status compare_surfaces(const struct compare_side *old, const struct compare_side *now,
                                double *S, double *mean, double *max, struct pm_err *err);

#endif
