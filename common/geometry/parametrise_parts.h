/* What the maps of spheres and tubes share. */
#ifndef PM_PARAMETRISE_PARTS_H
#define PM_PARAMETRISE_PARTS_H

#include "common/geometry/trimesh.h"

/* Normal of triangle t times its area [mm2]. */
void pm_triangle_area(const struct pm_trimesh *m, ptrdiff_t t, double n[3]);
/* Turns theta so that (cos theta, sin theta) agrees best with the normals; `out` (nn) or NULL. */
void pm_turn_theta(const struct pm_trimesh *m, const uint8_t *out, double *theta);
/* Makes S exactly symmetric in the plane S_axis = 0. */
enum pm_status pm_symmetrise_map(const struct pm_trimesh *m, int axis, const int32_t *image,
                                 double *S, struct pm_err *err);

#endif
