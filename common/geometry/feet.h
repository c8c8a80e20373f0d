/* Private to penalty.c and feet.c: what is collected. */
#ifndef PM_FEET_H
#define PM_FEET_H

#include "common/geometry/penalty.h"

enum { PM_FEET_BEND = 1, PM_FEET_BOUND = 2 };

/* Has this control point (global index) a free coordinate? */
int pm_feet_moves(const struct pm_surfaces *s, ptrdiff_t m);

#endif
