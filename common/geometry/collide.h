/* Intersections and distances in a set of triangles. */
#ifndef PM_COLLIDE_H
#define PM_COLLIDE_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"
#include "common/geometry/boxes.h"

struct pm_contact {
    ptrdiff_t a, b;  /* two triangles, or a node and a triangle; -1 if there is none */
    double at[3];    /* where [mm] */
    double distance; /* [mm] */
    ptrdiff_t pairs; /* how many there are (pm_collide_faces) */
};

/* The tree of the boxes of the triangles with their normals (nt x 3), or NULL. */
enum pm_status pm_collide_boxes(const double *x, ptrdiff_t nt, const int32_t *tri,
                                const double *normal, struct pm_boxes **boxes, struct pm_err *err);
/* Triangles parts * f .. parts * (f + 1) - 1 make up face f: counts the pairs of faces (a face with
 * itself too) of which an edge of a triangle pierces a triangle of the other, and gives the first
 * pair of triangles, by number. Touching does not count; triangles with a common edge are not
 * tested, with a common node only their other edges. About nt log nt. */
enum pm_status pm_collide_faces(const struct pm_boxes *boxes, const double *x, const int32_t *tri,
                                ptrdiff_t parts, struct pm_contact *c, struct pm_err *err);
/* The same, each triangle a face. */
enum pm_status pm_collide_pierce(const double *x, ptrdiff_t nt, const int32_t *tri,
                                 struct pm_contact *c, struct pm_err *err);
/* The node nearest, in parts of its own limit (nn) [mm], to a triangle it does not belong to; only
 * nodes within their limit are seen. Nodes with limit 0 are skipped. */
enum pm_status pm_collide_near(ptrdiff_t nn, const double *x, const double *limit, ptrdiff_t nt,
                               const int32_t *tri, struct pm_contact *c, struct pm_err *err);
/* Nearest point q of the triangle a b c to p; returns their distance [mm]. */
double pm_collide_closest(const double *p, const double *a, const double *b, const double *c,
                          double q[3]);
/* Solid angle of the triangles seen from p over 4 pi: 1 inside a closed outward surface, 0 outside.
 */
double pm_collide_winding(const double p[3], const double *x, ptrdiff_t nt, const int32_t *tri);
/* Volume enclosed by a closed outward surface, sum of det / 6 [mm3]. */
double pm_collide_volume(const double *x, ptrdiff_t nt, const int32_t *tri);

#endif
