/* Near conformal map of an annulus of triangles to a cylinder: theta around, psi along, both
 * discrete harmonic with the same positive weights (cotangents, clipped), so that nothing folds in
 * (theta, psi) by Tutte's theorem once theta rises along both rims [model 6.4]. */
#ifndef PM_ANNULUS_H
#define PM_ANNULUS_H

#include "common/geometry/trimesh.h"

struct pm_annulus {
    const struct pm_trimesh *mesh;
    const struct pm_star *star;
    const uint8_t *out;    /* 1: node and its triangles do not belong to it (nn) */
    const int32_t *rim[2]; /* nodes of both rims, in the direction in which theta rises: seen from
                              outside with psi upwards, to the right */
    ptrdiff_t nrim[2];
};

/* psi (nn): 0 on rim[0], `modulus` on rim[1], the length of the cylinder of radius 1 with the same
 * conformal type; theta (nn) in [0, 2 pi). Nodes that are out keep their values. */
enum pm_status pm_annulus_map(const struct pm_annulus *a, double *psi, double *theta,
                              double *modulus, struct pm_err *err);

#endif
