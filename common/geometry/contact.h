/* Self-contact of a deformed body, which the equilibrium does not know of: is it there, and how
 * near is it? */
#ifndef PM_CONTACT_H
#define PM_CONTACT_H

#include "common/files/state.h"

/* The boundary of the mesh at x + u (u: nn x 3 [mm]), its quadratic faces cut into four flat
 * triangles.
 * Intersections: pm_collide_faces, and the faces that reach through a symmetry plane, which meet
 * their mirror images. Gap: the least distance d from a corner of a triangle with normal n to a
 * point of a triangle with normal m that face each other through air: d.n >= 0.8 |d| > 0 and
 * -d.m >= 0.8 |d|; across a symmetry plane twice the distance of a corner that faces it. The cone
 * leaves out what is merely near along the surface; in a round tube or groove of radius r the gap
 * is 1.6 r. The closeness G of closeness.h is found too. Gaps beyond 1/20 of the diagonal of the
 * body are not looked for. About nf log nf. */
enum pm_status pm_contact_find(const struct pm_mesh *m, const double *u, struct pm_self_contact *c,
                               struct pm_err *err);
/* Warns, in one line, of intersections; says at -v how near it is. */
void pm_contact_tell(const struct pm_self_contact *c);

#endif
