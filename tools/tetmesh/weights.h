/* Rows of weights of surface nodes over the global control points. */
#ifndef PM_WEIGHTS_H
#define PM_WEIGHTS_H

#include "common/files/mesh.h"
#include "common/geometry/surface_map.h"

struct pm_weights {
    const struct pm_surfaces *s; /* borrowed */
    ptrdiff_t nn, row;           /* nodes; rows closed so far */
    ptrdiff_t capacity;
    int64_t *ptr;
    int32_t *col;
    double *val;
    double *sum;     /* of the open row (N) */
    int32_t *used;   /* columns of the open row (N) */
    uint8_t *marked; /* (N) */
    ptrdiff_t nused;
    struct pm_basis basis;
};

enum pm_status pm_weights_init(struct pm_weights *w, const struct pm_surfaces *s, ptrdiff_t nn,
                               struct pm_err *err);
void pm_weights_release(struct pm_weights *w);
/* Adds factor times the weights of surface k at S to the open row. */
enum pm_status pm_weights_add(struct pm_weights *w, const struct pm_map *map, int32_t k,
                              const double S[3], double factor, struct pm_err *err);
/* Adds those of node a of m, on a surface at its S: t times its own and (1 - t)/2 times those of
 * the ends of its edge, which are not looked at where t is 1. map: of all surfaces. */
enum pm_status pm_weights_add_node(struct pm_weights *w, struct pm_map *const *map,
                                   const struct pm_mesh *m, ptrdiff_t a, const int32_t ends[2],
                                   double t, struct pm_err *err);
/* Closes the row, columns ascending; if it is not empty x (3) = row times phi. */
enum pm_status pm_weights_close_row(struct pm_weights *w, double *x, struct pm_err *err);
/* Hands the rows over to m (wptr, wcol, wval, nw). */
void pm_weights_finish(struct pm_weights *w, struct pm_mesh *m);
/* Do the stored rows of the vertices of m equal those of these surfaces at the stored parameters
 * (to 1e-12)? Then x(phi) of m is the same function as that of a new mesh. */
enum pm_status pm_weights_same(const struct pm_mesh *m, const struct pm_surfaces *s, int *same,
                               struct pm_err *err);

#endif
