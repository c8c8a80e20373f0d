/* Is a set of surfaces a robot? Walls, containment, coverage, folds, curvature. */
#ifndef PM_CHECK_H
#define PM_CHECK_H

#include "common/geometry/distance.h"

struct pm_check {
    char fault[160]; /* first of: a chamber leaves the body or meets another, a hole in the cover
                        (sum of kernels < 1), a fold; "" if none */
    struct pm_approach wall; /* closest approach of two distinct surfaces [mm] */
    double cap;              /* least distance of a chamber from the planes z = 0 and z = H [mm] */
    double cap_x[3];         /* where [mm] */
    double coverage;         /* least sum of kernels on the chambers: at the samples and at the
                                circumcentres of the triangles of control points */
    double outside;          /* depth of the exterior beyond the design domain, <= 0 inside [mm] */
    double outside_x[3];     /* where [mm] */
    double curvature;        /* largest sqrt(c1^2 + c2^2) over the samples [1/mm] */
    double curvature_x[3];   /* where [mm] */
};

/* Measures, with samples at spacing <= wall_min / 2. */
enum pm_status pm_surfaces_measure(const struct pm_surfaces *s, struct pm_check *check,
                                   struct pm_err *err);
/* The same, and refuses (PM_INPUT, with the position) a fault, walls thinner than wall_min, caps
 * thinner than cap_min and a body that leaves its domain (by more than 0.01 mm, to which a fitted
 * cylinder is exact). */
enum pm_status pm_surfaces_check(const struct pm_surfaces *s, struct pm_check *check,
                                 struct pm_err *err);

#endif
