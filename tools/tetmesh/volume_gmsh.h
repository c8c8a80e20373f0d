/* gmsh: planar caps, tetrahedra inside closed surfaces, mesh files. Each call runs gmsh in a child
 * process, quiet, single threaded, deterministic. */
#ifndef PM_VOLUME_GMSH_H
#define PM_VOLUME_GMSH_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_planar {
    ptrdiff_t nn, nt;
    double *x;    /* the loop's nodes first (nn x 3) [mm] */
    int32_t *tri; /* counter-clockwise like the loop (nt x 3) */
};

/* Meshes the polygon `loop` (n x 3, z constant, counter-clockwise seen from +z) with edges of
 * `size` inside; its edges are kept. */
enum pm_status pm_gmsh_disc(ptrdiff_t n, const double *loop, double size, double timeout,
                            struct pm_planar *out, struct pm_err *err);

struct pm_gmsh_input {
    ptrdiff_t nn, nt;
    const double *x;      /* (nn x 3) [mm] */
    const int32_t *tri;   /* closed shells (nt x 3) */
    const int32_t *shell; /* shell of each triangle: 0 outer, 1.. holes (nt) */
    int32_t nshells;
};

struct pm_tetra {
    ptrdiff_t nn, ne;
    double *x;     /* the surface's nodes first, unchanged (nn x 3) [mm] */
    int32_t *tet;  /* vertices, positive (ne x 4) */
    int delaunay;  /* 1: HXT failed and the Delaunay algorithm did it */
    char why[256]; /* how HXT failed, "" if it did not */
};

/* Fills the outer shell minus the holes. PM_NUMERIC with gmsh's message where both algorithms fail.
 */
enum pm_status pm_gmsh_volume(const struct pm_gmsh_input *in, double timeout, struct pm_tetra *out,
                              struct pm_err *err);

#endif
