/* How much more a robot gives way at one pressure than at the others. Near the loss of stability
 * dU/dp grows without bound, and so does any measure summed over points: an optimiser would go
 * there. The objective is therefore the measure times
 *
 *   f = exp(-20 sum_g <ln(a_g/a_max)>^2),  a_g = |A_g| / (prod_h |A_h|)^(1/n),  <x> = max(x, 0),
 *
 * A_g the selected rows of J at point g of n, those of rotations times the height of the body (the
 * lever of the case if given) where translations are among them [model 7]. */
#ifndef PM_AMPLIFICATION_H
#define PM_AMPLIFICATION_H

#include "common/files/case.h"

/* f for J (ng x 6 x nc), its derivative df_dJ (the same; NULL: not wanted) and the largest a_g.
 * 1 where a_max (amplification_max of the case) is 0 or a point does not move at all. */
double pm_amplification(const struct pm_case *c, ptrdiff_t ng, const double *J, double *largest,
                        double *df_dJ);

#endif
