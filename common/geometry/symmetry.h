/* Symmetry orbits of control points. */
#ifndef PM_SYMMETRY_H
#define PM_SYMMETRY_H

#include "common/files/surfaces.h"

/* Makes the control points exactly symmetric: the representative of each orbit is averaged over its images
 * and copied to the others by sign flips or rotations. */
void pm_symmetrise_points(const struct pm_surfaces *s, double *phi);
/* Projects a field of vectors (gradient, step) on the symmetric subspace and clears what is not free. */
void pm_symmetrise_vectors(const struct pm_surfaces *s, double *v);
/* Largest defect max |Q_g phi_i + t_g - phi_perm(i)| [mm]. */
double pm_symmetry_defect(const struct pm_surfaces *s, const double *phi);

#endif
