/* Parameters S for the nodes of a triangle mesh that has none: near conformal, nothing folded. */
#ifndef PM_PARAMETRISE_H
#define PM_PARAMETRISE_H

#include "common/geometry/trimesh.h"

/* A closed surface of genus 0 onto the unit sphere: S = (sech psi cos theta, sech psi sin theta,
 * tanh psi) with the cylinder map of annulus.h between two poles, the nodes that lie furthest apart
 * along the surface, and the middle of the area at psi = 0. The poles are exactly (0, 0, -1) and
 * (0, 0, 1), the upper one in space at 1: there crowded nodes keep their full relative precision,
 * however slender the surface is. theta is turned so that S points where the normals point, on
 * average.
 * mirror (3) or NULL: the mesh is its own mirror image in the plane x_j = middle of its box,
 * triangles too, for every j with mirror[j]; then S is too, exactly: S_j changes its sign, 0 on the
 * plane. The poles lie in the mirror planes x and y.
 * S (nn x 3). PM_INPUT: not a closed surface of genus 0, no mirror image, no node on the planes,
 * poles too close (a mesh too coarse); PM_NUMERIC: triangles fold. About nn^1.5. */
enum pm_status pm_parametrise_sphere(const struct pm_trimesh *m, const int *mirror, double *S,
                                     struct pm_err *err);

/* An annulus between two rims onto the unit tube: S = (cos theta, sin theta, v), v = 0 on the rim
 * that lies lower on average, 1 on the other. v is a function of psi alone whose levels are evenly
 * spaced on the surface on average, theta as above. mirror: as above, planes x and y only. */
enum pm_status pm_parametrise_tube(const struct pm_trimesh *m, const int *mirror, double *S,
                                   struct pm_err *err);

struct pm_distortion {
    ptrdiff_t folded;    /* triangles that are not counter-clockwise in S */
    double median, most; /* anisotropy sigma_1 / sigma_2 of S -> x: median and 95 % of the area */
};
/* type: enum pm_surface_type. */
enum pm_status pm_parametrise_measure(const struct pm_trimesh *m, int32_t type, const double *S,
                                      struct pm_distortion *d, struct pm_err *err);

#endif
