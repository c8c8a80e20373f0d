/* A triangulated surface that grows, and what must be true of it before it is written. */
#ifndef PM_SURFEXPORT_SKIN_H
#define PM_SURFEXPORT_SKIN_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"
#include "common/files/mesh.h"

/* Tags of triangles: PM_FACE_EXTERIOR, PM_FACE_BASE, PM_FACE_TIP, 1.. chambers, and the faces of
 * moulds and cores: */
enum { SKIN_MOULD = -10, SKIN_PRINT = -11 };

struct skin {
    ptrdiff_t nn, nt, nodes, triangles; /* in use; room for */
    double *x;                          /* node positions              (nn x 3) [mm] */
    double *curvature;                  /* sqrt(c1^2 + c2^2)           (nn)     [1/mm] */
    double *wall;                       /* to the nearest other surface (nn)    [mm] */
    int32_t *surface;                   /* of the node: 0 exterior with caps, 1.. chambers, -1 */
    int32_t *tri;                       /* nodes, normal outward       (nt x 3) */
    int32_t *tag;                       /* (nt) */
};

void skin_release(struct skin *s);
/* "exterior", "base", "tip", "chamber3", "mould", "print". */
const char *skin_tag_name(int32_t tag, char name[32]);
enum pm_status skin_add_node(struct skin *s, const double x[3], int32_t surface,
                             struct pm_err *err);
enum pm_status skin_add_triangle(struct skin *s, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c, int32_t tag,
                                 struct pm_err *err);
/* The triangles with low <= tag <= high and their nodes, appended to `to`. */
enum pm_status skin_extract(const struct skin *from, int32_t low, int32_t high, struct skin *to,
                            struct pm_err *err);
/* Removes the triangles of a tag; their nodes stay. */
void skin_drop(struct skin *s, int32_t tag);
/* Turns the triangles with low <= tag <= high over. */
void skin_flip(struct skin *s, int32_t low, int32_t high);

/* Normal n with length 2 area of triangle t. */
void skin_normal(const struct skin *s, ptrdiff_t t, double n[3]);
/* The edges of one triangle only, directed as in it (n x 2), new memory. PM_NUMERIC where an edge
 * has more than two triangles or two that disagree in orientation. */
enum pm_status skin_open_edges(const struct skin *s, int32_t **edge, ptrdiff_t *n,
                               struct pm_err *err);
/* PM_NUMERIC, with the place, unless s is closed and oriented, does not pierce itself, encloses a
 * volume > 0, and keeps the corners of each triangle apart in single precision (STL). */
enum pm_status skin_check(const struct skin *s, struct pm_err *err);

#endif
