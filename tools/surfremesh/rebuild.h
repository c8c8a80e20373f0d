/* The steps of a reconstruction: plan, rebuild, judge. */
#ifndef PM_SURFREMESH_REBUILD_H
#define PM_SURFREMESH_REBUILD_H

#include "common/geometry/surface_map.h"
#include "tools/surfremesh/surfremesh.h"

struct rebuild {
    const struct pm_surfaces *from;
    const struct surfremesh_opts *o;
    int redo[PM_MAX_CHAMBERS + 1]; /* 1: the surface gets new control points; whole orbits */
    double spacing[PM_MAX_CHAMBERS + 1];
    double *shift; /* of the exterior's parameters (n x 2) */
    struct surfremesh_report *report;
};

/* Which surfaces need it: spacing of a chamber varies by more than 0.25 or its mean is off the
 * wanted one by more than 15 %, the longest edge of the exterior is above 2 times the mean; all
 * chambers if the options name a spacing or a count. */
enum pm_status rebuild_plan(struct rebuild *r, struct pm_err *err);
/* The new surfaces, fitted and symmetric. */
enum pm_status rebuild_surfaces(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err);
/* Parameter of the old surface k under S of the new one; `old` is the map of the old surface. */
enum pm_status rebuild_start(const struct rebuild *r, ptrdiff_t k, const struct pm_map *old,
                             const double S[3], struct pm_basis *work, double out[3],
                             struct pm_err *err);
/* Fills the report; its reason says what is not acceptable: distance above 0.3 mm, volume off by
 * more than 0.5 %, spacing worse, a fault of pm_surfaces_measure, a wall thinner than wall_min that
 * was not so before. */
enum pm_status rebuild_judge(struct rebuild *r, const struct pm_surfaces *to, struct pm_err *err);
/* Surface k lies too far off the old one, or its volume does, in the report. */
int rebuild_misses(const struct rebuild *r, ptrdiff_t k);

#endif
