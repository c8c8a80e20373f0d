/* How evenly and how isotropically control points lie on their surface. */
#ifndef PM_SURFREMESH_SPACING_H
#define PM_SURFREMESH_SPACING_H

#include "common/files/surfaces.h"

struct pm_spacing {
    double mean;    /* edge length of the triangulation [mm] */
    double cv;      /* standard deviation / mean of the edges */
    double longest; /* longest / mean */
    double near_cv; /* standard deviation / mean of the distances to the nearest neighbour */
    double area;    /* of the triangulation [mm2] */
    /* sigma_1 / sigma_2 of the map's derivative at the control points: median, and what 95 % stay
     * below */
    double median, most;
};
enum pm_status pm_spacing_of(const struct pm_surface *s, struct pm_spacing *out,
                             struct pm_err *err);

#endif
