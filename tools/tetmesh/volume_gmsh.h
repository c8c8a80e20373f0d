/* gmsh: planar faces, tetrahedra inside closed surfaces, mesh files. Each call runs gmsh in a child
 * process, quiet, single threaded, deterministic. */
#ifndef PM_VOLUME_GMSH_H
#define PM_VOLUME_GMSH_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_outline {
    ptrdiff_t nn, nloops;
    const double *x;        /* corners, one loop after the other; the first loop counter-clockwise,
                               the others are holes (nn x 2) [mm] */
    const ptrdiff_t *first; /* corners of loop l: first[l] .. first[l + 1] - 1 (nloops + 1) */
};

struct pm_planar {
    ptrdiff_t nn, nt;
    double *x;    /* the outline's corners first (nn x 2) [mm] */
    int32_t *tri; /* counter-clockwise (nt x 3) */
};

/* Meshes the inside of the outline with edges of `size` away from it; its edges are kept. */
enum pm_status pm_gmsh_planar(const struct pm_outline *in, double size, double timeout,
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

enum { PM_GROUP_NAME = 64 };

/* What a mesh file holds in its named physical groups. */
struct pm_msh {
    ptrdiff_t nn, ne, nt, ng;
    int64_t *tag;   /* node numbers, ascending (nn) */
    double *x;      /* (nn x 3) */
    int corners;    /* nodes of a tetrahedron: 4 or 10 */
    int32_t *tet;   /* tetrahedra of the group `body`, places of nodes (ne x corners) */
    int32_t *tri;   /* vertices of the triangles of the other groups (nt x 3) */
    int32_t *group; /* their group (nt) */
    char (*name)[PM_GROUP_NAME]; /* names of the surface groups (ng) */
};

/* Reads a gmsh file (2.2 or 4.1, ASCII or binary), whose first line the caller has looked at.
 * PM_INPUT with gmsh's message where it cannot, where there is no group `body` of 4- or 10-node
 * tetrahedra of one kind, or where elements refer to missing nodes. */
enum pm_status pm_gmsh_read(const char *path, struct pm_msh *out, struct pm_err *err);
void pm_msh_release(struct pm_msh *m);

#endif
