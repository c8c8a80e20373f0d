/* A previous mesh, morphed. */
#ifndef PM_REUSE_H
#define PM_REUSE_H

#include "common/files/mesh.h"
#include "common/files/surfaces.h"
#include "tools/tetmesh/mirror.h"

enum { PM_REUSE_WHY = 256 };

/* The previous mesh, which must be cut at `planes`, for the surfaces s. */
struct pm_reuse {
    const char *path;
    const struct pm_surfaces *s;
    const struct pm_mirrors *y;
    unsigned planes;
    double size;            /* wanted edge length [mm] */
    int good;               /* it serves */
    char why[PM_REUSE_WHY]; /* not */
};

/* Moves it, as generated or, where its elements do not bear that or the surfaces have other control
 * points (carry.h), from its present state. r->good: m holds it, else m is empty and r->why says
 * why: it is of other surfaces, its elements do not bear the motion, or its edges are too long for
 * the new shape (coarse.h). */
enum pm_status pm_reuse_mesh(struct pm_reuse *r, struct pm_mesh *m, struct pm_err *err);

#endif
