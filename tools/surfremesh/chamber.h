/* New control points of a chamber, spread evenly over the old surface. */
#ifndef PM_SURFREMESH_CHAMBER_H
#define PM_SURFREMESH_CHAMBER_H

#include "common/files/surfaces.h"

/* Isotropic remeshing of surface k (the first of its orbit) at `spacing` [mm]; every new control
 * point carries its parameter of the old surface, r = f_old(S), so Phi = S needs no inversion.
 * Mirrors of the case that keep the chamber are kept exactly: one side is remeshed and reflected.
 * *to gets Phi, phi = f_old(Phi) (unfitted), d0 and the triangulation. PM_NUMERIC where an
 * operation other than a coordinate mirror keeps the chamber. */
enum pm_status pm_chamber_remesh(const struct pm_surfaces *s, ptrdiff_t k, double spacing,
                                 struct pm_surface *to, struct pm_err *err);
/* Spacing of the control points over the surface: edge lengths of their triangulation. */
struct pm_spacing {
    double mean;    /* [mm] */
    double cv;      /* standard deviation / mean */
    double longest; /* longest / mean */
    double area;    /* of the triangulation [mm2] */
};
enum pm_status pm_spacing_of(const struct pm_surface *s, struct pm_spacing *out,
                             struct pm_err *err);

#endif
