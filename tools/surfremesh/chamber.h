/* New control points of a chamber, spread evenly over the old surface. */
#ifndef PM_SURFREMESH_CHAMBER_H
#define PM_SURFREMESH_CHAMBER_H

#include "tools/surfremesh/surfremesh.h"

/* Redistribution over surface k (the first of its orbit) at `spacing` [mm]: isotropic remeshing, or
 * the paper's springs. Every new control point carries its parameter of the old surface, so no map
 * is inverted. Reflections of the case that keep the chamber, in planes at right angles, are
 * kept: one side is remeshed and reflected. *to gets Phi, phi = f_old (unfitted), d0 and the
 * triangulation; *carried (n x 3, new memory) the parameters of the old surface, NULL where they
 * are Phi. PM_NUMERIC where an operation keeps the chamber that is no product of such reflections:
 * an axis alone, planes at 60 degrees. */
enum pm_status pm_chamber_remesh(const struct pm_surfaces *s, ptrdiff_t k,
                                 enum surfremesh_method method, double spacing,
                                 struct pm_surface *to, double **carried, struct pm_err *err);

#endif
