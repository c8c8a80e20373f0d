/* Symmetry orbits of control points. */
#ifndef PM_SYMMETRY_H
#define PM_SYMMETRY_H

#include "common/files/surfaces.h"

/* Makes the control points exactly symmetric: the representative of each orbit is averaged over its
 * images and copied to the others by sign flips or rotations. */
void pm_symmetrise_points(const struct pm_surfaces *s, double *phi);
/* Projects a field of vectors (gradient, step) on the symmetric subspace and clears what is not
 * free. */
void pm_symmetrise_vectors(const struct pm_surfaces *s, double *v);
/* Largest defect max |Q_g phi_i + t_g - phi_perm(i)| [mm]. */
double pm_symmetry_defect(const struct pm_surfaces *s, const double *phi);

/* Fills s->perm (new memory) for the operations of its case: B-spline control points by their
 * indices, those of chambers by their places phi, which must match within `tolerance` [mm].
 * PM_INPUT naming the control point without an image. */
enum pm_status pm_symmetry_find(struct pm_surfaces *s, double tolerance, struct pm_err *err);
/* Makes Phi and d0 of the closed surfaces exact along the orbits, as pm_symmetrise_points does for
 * phi. */
enum pm_status pm_symmetrise_reference(struct pm_surfaces *s, struct pm_err *err);

/* Chamber k (0-based) as the image of an earlier one: chamber r < k goes to k under operation *g;
 * returns r, or k itself (*g = 0) where it comes first in its orbit. */
ptrdiff_t pm_symmetry_source(const struct pm_symmetry *y, ptrdiff_t k, ptrdiff_t *g);
/* y = Q x + t of operation g for n points (n x 3). */
void pm_symmetry_points(const struct pm_symmetry *y, ptrdiff_t g, ptrdiff_t n, const double *x,
                        double *out);
/* The image of a closed surface under operation g, point by point. */
enum pm_status pm_symmetry_image(const struct pm_symmetry *y, ptrdiff_t g,
                                 const struct pm_surface *from, struct pm_surface *to,
                                 struct pm_err *err);

#endif
