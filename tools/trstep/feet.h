/* Private to penalty.c and feet.c: what is collected. */
#ifndef TRSTEP_FEET_H
#define TRSTEP_FEET_H

#include "tools/trstep/penalty.h"

enum { FEET_BEND = 1, FEET_BOUND = 2 };

/* Has this control point (global index) a free coordinate? */
int feet_moves(const struct pm_surfaces *s, ptrdiff_t m);

#endif
