/* What invkin says about its targets. */
#ifndef INVKIN_REPORT_H
#define INVKIN_REPORT_H

#include "common/files/inverse.h"
#include "common/files/sweep.h"

/* One line about target i, by -v. */
void invkin_tell(const struct pm_sweep *s, const struct pm_inverse *v, ptrdiff_t i);
/* A warning where targets were not reached; counts, by -v. */
void invkin_summarise(const struct pm_sweep *s, const struct pm_inverse *v);
/* PM_NUMERIC: the first target is not reached, and why. */
enum pm_status invkin_fail(const struct pm_sweep *s, const struct pm_inverse *v,
                           struct pm_err *err);
/* Tab separated on stdout, a line a target: number, verdict, pressures, components of the pose,
 * distance in position [mm] and in the rotation vector [degrees], pressures at bounds, iterations,
 * equilibria, factorisations. */
void invkin_table(const struct pm_sweep *s, const struct pm_inverse *v);

#endif
