/* Even spacing by springs: step 1 of the paper's Algorithm 1 [paper 72-73, model 9 step 1]. */
#ifndef PM_SPRINGS_H
#define PM_SPRINGS_H

#include "common/geometry/remesh.h"

struct pm_springs_opts {
    double size;   /* > 0: splits and collapses bring the edges near this length first [mm] */
    double volume; /* the polyhedron's may change by this part, either way */
    int sweeps;
    int mirror[3]; /* as in pm_remesh_opts */
};

/* The control points move tangentially, half the way to the mean of their neighbours a sweep, their
 * edges flip every ten sweeps (Delaunay in configuration). Ends where the sum of the squared edges
 * falls by less than 1e-4 of itself, before the volume leaves its bounds, and before a triangle
 * folds in the parameter. Points do not get even where the connectivity is not: the sum is nearly
 * invariant under conformal maps. Errors as pm_remesh. */
enum pm_status pm_springs(const struct pm_surface *s, int surface, const struct pm_springs_opts *o,
                          struct pm_patch *p, struct pm_err *err);

#endif
