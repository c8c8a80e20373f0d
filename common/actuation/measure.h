/* Workspace measures w(U, J) per point [model 7]; T = sigma * sum weight * w.
 *
 *   2T 3T 1R2T  area or volume in the case's DoFs                              boundary, volume
 *   3R          volume of orientations, density sinc^2(eta/2)/8, eta = |theta| boundary, volume
 *   3R3T        volume of poses, the same density, all six DoFs                boundary, volume
 *   2R          solid angle of the pointing direction R(theta) e_z, 3 chambers boundary
 *   manifold    sqrt det(A^T A), A the selected rows of J, chambers <= DoFs    volume
 *
 * 3R by the Taylor field has the density (1 - eta^2/12)/8 [1] and the boundary form alone; its sum
 * over a reduced set is not quite that of the full one, for that field does not turn with theta. A
 * weight over the workspace (weight.h) multiplies the density: volume form alone. The manifold
 * measure is a length, area, .. of the poses in mm^n, in rad^n where all DoFs are rotations, n
 * chambers; a rotation counts as lever times its angle where translations are among them. */
#ifndef PM_MEASURE_H
#define PM_MEASURE_H

#include "common/actuation/loads.h"

/* PM_INPUT unless measure, DoFs, number of chambers and form fit together; says what is supported.
 */
enum pm_status pm_measure_check(const struct pm_case *c, enum pm_form form, struct pm_err *err);
int pm_measure_has_form(const struct pm_case *c, enum pm_form form);
/* Replaces the measure of the case, and its DoFs by the usual ones of that measure. */
enum pm_status pm_measure_select(struct pm_case *c, const char *name, struct pm_err *err);
/* Contribution of one point before sigma and weight: w, dw/dU (6), dw/dJ (6 x n), J is (6 x n) per
 * unit of p/mu. Boundary form: (sign/n) det(J with column `face` replaced by F(U)); volume form:
 * density * det J * weight. PM_NUMERIC where 2R points at -e_z, the pole of its potential, and
 * where the columns of J are dependent for manifold. */
enum pm_status pm_measure_point(const struct pm_case *c, enum pm_form form,
                                const struct pm_load *load, const double U[6], const double *J,
                                double *w, double dw_dU[6], double *dw_dJ, struct pm_err *err);
/* det of the selected rows of J: changes sign where the workspace folds. 0 for 2R, whose map is not
 * square; sqrt det(A^T A) for manifold. */
double pm_measure_det(const struct pm_case *c, const double *J);
const char *pm_measure_unit(const struct pm_case *c);

#endif
