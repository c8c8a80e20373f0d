/* Private to contact.c and closeness.c: the deformed boundary as flat triangles. */
#ifndef PM_SKIN_H
#define PM_SKIN_H

#include "common/files/mesh.h"
#include "common/geometry/boxes.h"

struct pm_skin_plane {
    int32_t tag;
    int axis;
    double at, side; /* coordinate [mm]; the body is where side * (x - at) > 0 */
};

/* The boundary but the symmetry planes; a quadratic face is four triangles. */
struct pm_skin {
    const struct pm_mesh *m; /* borrowed */
    ptrdiff_t nt, parts;     /* triangles, of one face */
    int32_t *tri;            /* (nt x 3) */
    int32_t *tag;            /* of a triangle                      (nt) */
    double *y;               /* positions                          (nn x 3) [mm] */
    double *facet;           /* of the triangles, unit             (nt x 3) */
    struct pm_boxes *boxes;
    struct pm_skin_plane plane[3];
    int nplanes;
};

/* At x + u (nn x 3) [mm]. */
enum pm_status pm_skin_new(const struct pm_mesh *m, const double *u, struct pm_skin *s,
                           struct pm_err *err);
void pm_skin_release(struct pm_skin *s);

#endif
