/* The steps of a reconstruction: plan, rebuild, judge. */
#ifndef PM_SURFREMESH_REBUILD_H
#define PM_SURFREMESH_REBUILD_H

#include "tools/surfremesh/surfremesh.h"

/* What surfaces break of what trials hold (penalty.h). */
struct rebuild_breach {
    double curvature[PM_MAX_CHAMBERS + 1];                      /* (ns) */
    double wall[(PM_MAX_CHAMBERS + 1) * (PM_MAX_CHAMBERS + 1)]; /* (ns x ns), a <= b */
};

struct rebuild {
    const struct pm_surfaces *from;
    const struct surfremesh_opts *o;
    int redo[PM_MAX_CHAMBERS + 1]; /* 1: the surface gets new control points; whole orbits */
    enum surfremesh_method method[PM_MAX_CHAMBERS + 1]; /* exterior: SURFREMESH_REMESH */
    ptrdiff_t source[PM_MAX_CHAMBERS + 1],
        by[PM_MAX_CHAMBERS + 1];                 /* the first surface of the orbit
                                                     and the operation from it */
    double spacing[PM_MAX_CHAMBERS + 1];         /* of chambers [mm] */
    ptrdiff_t nu, nv;                            /* of the exterior */
    struct pm_surface made[PM_MAX_CHAMBERS + 1]; /* new ones, of the first of an orbit */
    /* parameters of the old surface at the new control points (n x 3), NULL where they are Phi */
    double *carried[PM_MAX_CHAMBERS + 1];
    ptrdiff_t blame[2];           /* the surfaces that the joined result fails by, -1: any */
    struct rebuild_breach before; /* by the old surfaces */
    struct surfremesh_report *report;
};

void rebuild_release(struct rebuild *r);
/* Which surfaces need it, and why (logged). A chamber: its spacing varies by more than 0.25, its
 * mean is above the wanted one by more than 15 %, its longest edge is above 2.5 times the mean, its
 * map is anisotropic (median above 1.5 or 95 % above 3: a new parametrisation), its cover is below
 * 1. The exterior: the longest edge is above 2 times the mean, or the mean is above the
 * start's by more than 15 %. None gets fewer control points than it has unless asked. All chambers
 * if the options name a spacing or a count. */
enum pm_status rebuild_plan(struct rebuild *r, struct pm_err *err);
/* Surface k, the first of its orbit, gets new control points, fitted to the old surface. */
enum pm_status rebuild_surface(struct rebuild *r, ptrdiff_t k, struct pm_err *err);
/* All surfaces together, the new ones where redo says so, with their images, symmetric. */
enum pm_status rebuild_join(const struct rebuild *r, struct pm_surfaces *to, struct pm_err *err);
/* Moves the control points of the new surfaces in *s and in made as little as brings curvature
 * and walls near their limits (polish.c). */
enum pm_status rebuild_polish(struct rebuild *r, struct pm_surfaces *s, struct pm_err *err);
/* Enters surface k, its images too, in the report; its reason says what is not acceptable: distance
 * above 0.3 mm either way, unasked a mean above wall_min/250, volume off by more than 0.5 %,
 * spacing worse, a fold, a surface through itself. The paper's method drifts: its distance and
 * volume are reported, not judged. */
enum pm_status rebuild_judge_surface(struct rebuild *r, ptrdiff_t k, struct pm_err *err);
/* Does the new surface k lie too far off the old one, or its volume? */
int rebuild_misses(const struct rebuild *r, ptrdiff_t k);
/* The same for all together: a fault of pm_surfaces_measure, curvature 25 % above its limit, walls,
 * voids or caps 2 % below theirs, unless the old ones were worse; blame says by which surfaces. */
enum pm_status rebuild_judge_robot(struct rebuild *r, const struct pm_surfaces *to,
                                   struct pm_err *err);

#endif
