/* Cuts a surface by a plane across an axis. */
#ifndef PM_SURFEXPORT_CUT_H
#define PM_SURFEXPORT_CUT_H

#include "tools/surfexport/skin.h"

/* The part with sense * (x[axis] - value) > 0, appended to `to`. Nodes within `snap` [mm] of the
 * plane are moved into it; edges that cross it are cut; the nodes of the section have exactly
 * x[axis] = value. Where s is closed the section is open: skin_close. */
enum pm_status skin_cut(const struct skin *s, int axis, double value, int sense, double snap,
                        struct skin *to, struct pm_err *err);

#endif
