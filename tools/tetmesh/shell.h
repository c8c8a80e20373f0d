/* The closed surfaces of a robot as one watertight set of triangles: lateral exterior, caps,
 * chambers. */
#ifndef PM_SHELL_H
#define PM_SHELL_H

#include "common/files/surfaces.h"

struct pm_shell {
    ptrdiff_t nn, nt;
    double *x;        /* nodes (nn x 3) [mm] */
    double *size;     /* wanted edge length (nn) [mm] */
    double *S;        /* surface parameter, 0 on caps (nn x 3) */
    int32_t *surface; /* owner: 0 exterior (rims included), 1.. chambers, -1 inside a cap (nn) */
    int32_t *tri;     /* normal out of the closed surface (nt x 3) */
    int32_t *tag;     /* PM_FACE_* of mesh.h (nt) */
};

/* Meshes all surfaces with edges of about `size` mm (shorter where curved) and the planar caps at
 * the rims of the exterior. The caps come from gmsh. */
enum pm_status pm_shell_build(const struct pm_surfaces *s, double size, double timeout,
                              struct pm_shell *shell, struct pm_err *err);
void pm_shell_release(struct pm_shell *shell);

/* Refuses (PM_INPUT, with surfaces and place) surfaces that are inside out, cut themselves or each
 * other, lie outside the body or inside another chamber, or come closer than 1/20 of the wanted
 * edge length. */
enum pm_status pm_shell_check(const struct pm_shell *shell, ptrdiff_t nchambers,
                              struct pm_err *err);
/* "chamber 2", "exterior", "base", "tip". */
const char *pm_shell_name(int32_t tag, char name[32]);

#endif
