/* Chambers and exteriors fitted to triangle meshes. */
#ifndef PM_GIVEN_H
#define PM_GIVEN_H

#include "common/files/surfaces.h"
#include "common/geometry/trimesh.h"

/* Distance of the given surface from the fitted one. */
struct pm_misfit {
    double mean, max; /* over the area of the given surface [mm] */
    double at[3];     /* the place of the largest [mm] */
};

/* The closed surface with control points at `spacing` [mm] on it. mirror (3) or NULL: the mesh is
 * its own mirror image, and so is the result [pm_parametrise_sphere]. */
enum pm_status pm_given_chamber(const struct pm_trimesh *m, double spacing, const int *mirror,
                                struct pm_surface *s, struct pm_misfit *misfit, struct pm_err *err);
/* The side wall of a closed surface whose flat ends lie in z = 0 and z = height, as a B-spline tube
 * of nu x nv control points with its rims exactly in these planes. */
enum pm_status pm_given_body(const struct pm_trimesh *m, const struct pm_case *c,
                             struct pm_surface *s, struct pm_misfit *misfit, struct pm_err *err);

#endif
