/* Control points of a chamber of revolution: rings uniform on the chamber, conformal on the sphere.
 */
#ifndef PM_CHAMBER_H
#define PM_CHAMBER_H

#include "common/files/surfaces.h"
#include "tools/surfgen/profile.h"

/* An odd number of rings half a step out of phase by turns, points per ring a multiple of
 * `multiple` (even), one point at each pole: closed under the mirrors through the axis and the flip
 * of z. phi lies on the shape (unfitted), d0 is not set. */
enum pm_status pm_chamber_seed(const struct pm_chamber *c, const struct pm_profile *p,
                               ptrdiff_t multiple, struct pm_surface *s, struct pm_err *err);
#endif
