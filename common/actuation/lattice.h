/* A lattice on the boundary of the actuation box, for dense workspaces [model 7.6]. Points are
 * named by id = sum k_r (steps + 1)^(n-1-r), pressure r = low + k_r (high - low)/steps. Measure 2R:
 * the six edges of its path and the centre of the box; the others: all faces. */
#ifndef PM_LATTICE_H
#define PM_LATTICE_H

#include "common/files/case.h"

struct pm_lattice {
    int n;            /* pressures: 2 or 3 */
    int steps;        /* intervals along an edge, even */
    int path;         /* 1: measure 2R */
    double low, high; /* [p/mu] */
    ptrdiff_t size;   /* ids */
};

/* The lattice with the largest interval that is at most `interval` [p/mu]. PM_INPUT unless the case
 * has two or three chambers and the measure a boundary form. */
enum pm_status pm_lattice_make(const struct pm_case *c, double interval, struct pm_lattice *l,
                               struct pm_err *err);
int pm_lattice_has(const struct pm_lattice *l, ptrdiff_t id);
void pm_lattice_pressure(const struct pm_lattice *l, ptrdiff_t id, double *p);
/* The id at p, -1 if it is none of the lattice. */
ptrdiff_t pm_lattice_find(const struct pm_lattice *l, const double *p);
ptrdiff_t pm_lattice_center(const struct pm_lattice *l);
/* 1 if operation g maps equilibria to equilibria: it keeps the clamped base. */
int pm_lattice_symmetry(const struct pm_case *c, ptrdiff_t g);
ptrdiff_t pm_lattice_image(const struct pm_case *c, const struct pm_lattice *l, ptrdiff_t g,
                           ptrdiff_t id);
/* One point of every orbit, each near the one before; the first is nearest to no pressure. *ids is
 * new memory (pm_free). Cost: the square of their number. */
enum pm_status pm_lattice_walk(const struct pm_case *c, const struct pm_lattice *l, ptrdiff_t **ids,
                               ptrdiff_t *n, struct pm_err *err);

/* Side s of the boundary, 0 <= s < pm_lattice_sides: the face p_face = const with its sign, or the
 * edge of the path along which p_face varies. */
struct pm_lattice_side {
    int face, sign, axes;
    ptrdiff_t origin, stride[2]; /* ids of its points: origin + i stride[0] + j stride[1] */
};
int pm_lattice_sides(const struct pm_lattice *l);
/* Axes of a face run so that (1, 2) is right-handed about the outward normal; the segment of a
 * square runs counterclockwise, an edge of the path as the path does. */
struct pm_lattice_side pm_lattice_side(const struct pm_lattice *l, int s);

#endif
