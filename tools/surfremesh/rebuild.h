/* The steps of a reconstruction: plan, rebuild, judge. */
#ifndef PM_SURFREMESH_REBUILD_H
#define PM_SURFREMESH_REBUILD_H

#include "common/geometry/check.h"
#include "tools/surfremesh/surfremesh.h"

struct rebuild {
    const struct pm_surfaces *from;
    const struct surfremesh_opts *o;
    int redo[PM_MAX_CHAMBERS + 1]; /* 1: the surface gets new control points; whole orbits */
    enum surfremesh_method method[PM_MAX_CHAMBERS + 1]; /* exterior: SURFREMESH_REMESH */
    ptrdiff_t source[PM_MAX_CHAMBERS + 1],
        by[PM_MAX_CHAMBERS + 1];         /* the first surface of the orbit
                                             and the operation from it */
    double spacing[PM_MAX_CHAMBERS + 1]; /* of chambers [mm] */
    ptrdiff_t nu, nv;                    /* of the exterior */
    /* parameters of the old surface at the new control points (n x 3), NULL where they are Phi */
    double *carried[PM_MAX_CHAMBERS + 1];
    ptrdiff_t blame;        /* the surface that a refused result fails by, -1: no single one */
    struct pm_check before; /* of the old surfaces */
    struct surfremesh_report *report;
};

void rebuild_release(struct rebuild *r);
/* Which surfaces need it, and why (logged). A chamber: its spacing varies by more than 0.25, its
 * mean is off the wanted one by more than 15 %, its longest edge is above 2.5 times the mean, its
 * map is anisotropic (median above 1.5 or 95 % above 3: a new parametrisation), its cover is below
 * 1. The exterior: the longest edge is above 2 times the mean, or the mean is off the start's by
 * more than 15 %. All chambers if the options name a spacing or a count. */
enum pm_status rebuild_plan(struct rebuild *r, struct pm_err *err);
/* The new surfaces, fitted and symmetric. */
enum pm_status rebuild_surfaces(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err);
/* Parameters of the old surface k where the samples of the new one lie, pm_samples_new with `cuts`
 * and no spacing: S (samples of k x 3). */
void rebuild_carry(const struct rebuild *r, const struct pm_surface *to, ptrdiff_t k,
                   ptrdiff_t cuts, double *S);
/* Fills the report; its reason says what is not acceptable: distance above 0.3 mm either way,
 * volume off by more than 0.5 %, spacing or isotropy worse, a fold, a surface through itself, a
 * fault of pm_surfaces_measure, a wall thinner than wall_min that was not so before. The paper's
 * method drifts: its distance and volume are reported, not judged. */
enum pm_status rebuild_judge(struct rebuild *r, const struct pm_surfaces *to, struct pm_err *err);
/* Surface k lies too far off the old one, or its volume does, in the report. */
int rebuild_misses(const struct rebuild *r, ptrdiff_t k);

#endif
