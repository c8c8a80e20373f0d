/* Validity of tetrahedra, those of 10 nodes curved. */
#ifndef PM_QUALITY_H
#define PM_QUALITY_H

#include "common/files/mesh.h"

/* det dX/dxi of a tet10 is a cubic polynomial; b are its 20 Bernstein coefficients, so that min b
 * is a lower bound over the whole element. Order: u <= v <= w over the vertices, lexicographic. X
 * (10 x 3). */
void pm_quality_bernstein(const double X[30], double b[20]);
/* Scaled Jacobian: min b / mean b, 1 for a straight element; -1 where the volume is not positive.
 * The mean of b is six times the volume. */
double pm_quality_scaled(const double X[30]);
/* Mean ratio of the straight tetrahedron of the four vertices: 12 (3 V)^(2/3) / sum of squared
 * edges, 1 for the regular one, <= 0 inverted. */
double pm_quality_mean_ratio(const double X[12]);
/* Nodes of element e (10 x 3) at the nodal positions x; a 4-node one gets the middles of its edges.
 */
void pm_quality_gather(const struct pm_mesh *m, const double *x, ptrdiff_t e, double X[30]);
/* Adds area and first moment [mm2, mm3] of a boundary face, straight or curved, by the 6-point
 * rule; returns its flux of x / 3: over a closed surface the volume inside [mm3]. */
double pm_quality_face(const struct pm_mesh *m, ptrdiff_t f, double *area, double moment[3]);

#endif
