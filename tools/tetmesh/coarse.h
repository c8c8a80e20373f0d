/* Do the edges of a mesh resolve its surfaces? */
#ifndef PM_COARSE_H
#define PM_COARSE_H

#include "common/files/mesh.h"
#include "common/files/surfaces.h"

/* Part of the area of the surfaces (the caps and cuts left out) in faces of m, whose nodes lie on
 * s, with an edge longer than 1.5 times what `size` [mm] and the curvature at its ends and its
 * middle ask for (shell.h); new meshes: 0 to 0.07. One evaluation of the map per node. */
enum pm_status pm_coarse_part(const struct pm_surfaces *s, double size, const struct pm_mesh *m,
                              double *part, struct pm_err *err);

#endif
