/* The closed surfaces of a robot, or of its part on the positive sides of mirror planes, as one
 * watertight set of triangles: lateral exterior, caps, chambers, faces on the planes. */
#ifndef PM_SHELL_H
#define PM_SHELL_H

#include "common/files/surfaces.h"
#include "common/geometry/remesh.h"
#include "tools/tetmesh/mirror.h"

struct pm_walls;

struct pm_shell {
    ptrdiff_t nn, nt;
    unsigned planes;  /* cut at these mirrors (mirror.h); coordinates on them are 0 exactly */
    double *x;        /* nodes (nn x 3) [mm] */
    double *size;     /* wanted edge length (nn) [mm] */
    double *S;        /* surface parameter, 0 on planar faces (nn x 3) */
    int32_t *surface; /* owner: 0 exterior (rims included), 1.. chambers, -1 inside a planar face
                         (nn) */
    int32_t *tri;     /* normal out of the closed surface (nt x 3) */
    int32_t *tag;     /* PM_FACE_* of mesh.h (nt) */
};

struct pm_shell_opts {
    double size;                  /* wanted edge length [mm] */
    double crest;                 /* and over the radius of curvature */
    double timeout;               /* of gmsh [s], 0: none */
    const struct pm_walls *walls; /* edges are shorter at thin walls (walls.h), or NULL */
};

/* Edges of `size` mm, shorter where curved. */
struct pm_remesh_opts pm_shell_edges(double size, double crest);
/* Meshes all surfaces on the positive sides of the planes of y with edges of about `size` mm
 * (shorter where curved) and the planar caps at the rims of the exterior, which come from gmsh. The
 * faces on the planes are for pm_flat_cuts, after the checks. */
enum pm_status pm_shell_build(const struct pm_surfaces *s, const struct pm_mirrors *y,
                              const struct pm_shell_opts *o, struct pm_shell *shell,
                              struct pm_err *err);
void pm_shell_release(struct pm_shell *shell);
/* Refuses (PM_INPUT, with surfaces and place) surfaces that are inside out, cut themselves or each
 * other, lie outside the body or inside another chamber, or come closer than 1/20 of the wanted
 * edge length there, judged by the bent shell (middle.h); their images at mirror planes stand for
 * what is behind these. Then the flat one, which gmsh fills, must not meet itself. */
enum pm_status pm_shell_check(const struct pm_shell *shell, const struct pm_shell *bent,
                              ptrdiff_t nchambers, struct pm_err *err);
/* Room for so many more. */
enum pm_status pm_shell_grow(struct pm_shell *s, ptrdiff_t nn, ptrdiff_t nt, struct pm_err *err);
/* "chamber 2", "exterior", "base", "tip". */
const char *pm_shell_name(int32_t tag, char name[32]);

#endif
