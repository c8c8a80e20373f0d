/* Smooth minimisation without bounds by L-BFGS: the only user of lbfgs.h. */
#ifndef PM_MINIMISE_H
#define PM_MINIMISE_H

#include <stddef.h>

#include "common/base/status.h"

/* The value at z (n), its gradient in g (n). Positive: the stopping rule is relative. HUGE_VAL
 * where z is no point. */
typedef double (*pm_minimise_value)(void *context, const double *z, double *g);

/* z (n): in the start, out the best point, at most 50 iterations on; ends where |g| is below 1e-3
 * of |z|, or five iterations gain less than 3e-4 of the value. Wants a value near 1 in its scale.
 */
enum pm_status pm_minimise(ptrdiff_t n, double *z, pm_minimise_value value, void *context,
                           struct pm_err *err);

#endif
