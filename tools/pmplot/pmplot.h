/* Text tables for plotting programs on stdout, columns separated by blanks. Triangles are written
 * as grids of 2 x 2 points (the last corner twice) between two blank lines, as gnuplot wants them
 * to colour each one; `light` is the cosine between the normal and the direction of a fixed lamp.
 */
#ifndef PMPLOT_H
#define PMPLOT_H

#include "common/base/tool.h"
#include "common/files/state.h"
#include "common/files/surfaces.h"
#include "common/files/sweep.h"
#include "common/files/workspace.h"

struct pmplot_opts {
    int accepted; /* of a step file the accepted design, not the proposed one */
    double y;     /* of the section plane [mm] */
};

/* Operands: WHAT FILE.. */
enum pm_status pmplot_run(const struct pmplot_opts *opts, const struct pm_common *common,
                          struct pm_err *err);

/* surface: triangles x y z 0 light surface. section: closed curves x z where the plane y = const
 * cuts them. */
enum pm_status pmplot_surface(const struct pm_surfaces *s, struct pm_err *err);
enum pm_status pmplot_section(const struct pm_surfaces *s, double y, struct pm_err *err);
/* deformed: triangles x y z |u| light surface of a state: 0 outside, 1.. chambers. */
void pmplot_deformed(const struct pm_state *s);
/* path: a line a point that was reached: pressures, pose, volumes, energy, gap, intersections; a
 * blank line for one that was not. */
void pmplot_path(const struct pm_sweep *s);
/* boundary: the surface of a dense workspace, triangles x y z angle, or its curve, segments. */
void pmplot_boundary(const struct pm_workspace *w);
/* workspace: the image of the edges of the actuation square in the two DoFs of the case, closed;
 * then the given states, then their images by symmetry: U p. Between states the curve is the cubic
 * that has their U and J. Needs states at the corners of the square, themselves or by symmetry. */
enum pm_status pmplot_workspace(const struct pm_state *states, ptrdiff_t n, struct pm_err *err);

#endif
