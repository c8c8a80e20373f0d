/* The planes of the ends and the sides of the design domain. */
#ifndef PM_DOMAIN_H
#define PM_DOMAIN_H

#include "common/files/case.h"

/* Depth of x beyond bound `axis` [mm], negative inside, -HUGE_VAL where there is none, and the
 * direction n in which it grows. Axis 2: the end planes, which a chamber keeps cap_min away from;
 * axes 0 and 1, exterior only: the sides of the box, or 0 the cylinder. */
double pm_domain_depth(const struct pm_case *c, int chamber, int axis, const double x[3],
                       double n[3]);

#endif
