/* The body in cross-sections: discs about the chambers' axes joined by webs to the axis of the
 * body. */
#ifndef PM_OUTLINE_H
#define PM_OUTLINE_H

#include "common/files/case.h"

struct pm_outline; /* cross-sections at many heights, by arc length */

/* Envelope: the disc of a chamber has the radius of its profile without end caps offset by `wall`
 * along the normal, the web is everything within `web` of the segment from the chamber to the axis;
 * joined with fillets. An elliptic section takes the place of the disc, at the same distance.
 * Cylinder: one circle. Rounded box: one rectangle with round corners. Cells: pneunet.h. PM_INPUT
 * where a cross-section is not one closed curve about the axis. */
enum pm_status pm_outline_new(const struct pm_case *c, struct pm_outline **o, struct pm_err *err);
void pm_outline_free(struct pm_outline *o);
/* The point at the fraction turn in [0, 1) of the outline, counter-clockwise from the +x axis, and
 * v in [0, 1] of the way from the base to the tip: by height, around cells by arc length. */
void pm_outline_point(const struct pm_outline *o, double turn, double v, double x[3]);
/* z = H v everywhere. */
int pm_outline_is_level(const struct pm_outline *o);

#endif
