/* A row of box-like cells on a common channel, and the body that follows it: the gaps between the
 * cells are open to the outside. The surface is a family of outlines along z: X(tau, u), tau along
 * the limb, u in [0, 1) around from the +x axis. */
#ifndef PM_PNEUNET_H
#define PM_PNEUNET_H

#include "common/files/case.h"

struct pm_pneunet; /* one surface; z counts from the middle of the limb */

/* The cavity of one limb, in the frame of its channel with +x outwards; tau runs from pole to pole.
 */
enum pm_status pm_pneunet_cavity(const struct pm_chamber *c, struct pm_pneunet **net,
                                 struct pm_err *err);
/* The exterior around all limbs of the case (1, 2 or 3), tau from the base to the tip. */
enum pm_status pm_pneunet_body(const struct pm_case *c, struct pm_pneunet **net,
                               struct pm_err *err);
void pm_pneunet_free(struct pm_pneunet *net);
/* tau runs from 0 to this. */
ptrdiff_t pm_pneunet_parts(const struct pm_pneunet *net);
void pm_pneunet_point(const struct pm_pneunet *net, double tau, double u, double x[3]);
/* Tables over tau = i / fine, i = 0 .. fine * parts: mean arc length from the start, circumference
 * over 2 pi. */
void pm_pneunet_table(const struct pm_pneunet *net, ptrdiff_t fine, double *s, double *r);

#endif
