/* Edges of a tetrahedral mesh and its quadratic nodes. */
#ifndef PM_EDGES_H
#define PM_EDGES_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_edges {
    ptrdiff_t nv, n; /* vertices, edges */
    ptrdiff_t *ptr;  /* edges of lower end a: ptr[a] .. ptr[a + 1] - 1 (nv + 1) */
    int32_t *low;    /* lower end  (n) */
    int32_t *high;   /* higher end, ascending for each lower one (n) */
};

/* Unique edges of ne tetrahedra (ne x 4), sorted by (low, high). */
enum pm_status pm_edges_new(ptrdiff_t nv, ptrdiff_t ne, const int32_t *tet, struct pm_edges *e,
                            struct pm_err *err);
void pm_edges_release(struct pm_edges *e);
/* Its number, -1 if there is none. */
ptrdiff_t pm_edges_find(const struct pm_edges *e, int32_t a, int32_t b);

struct pm_face {
    int32_t key[3]; /* vertices, ascending */
    int32_t element, side;
    int32_t turned; /* 1: seen from outside the element, key runs clockwise */
};

/* Faces of ne tetrahedra (4 ne, new memory), those of the same vertices together in the order of
 * their elements. */
enum pm_status pm_sorted_faces(ptrdiff_t ne, const int32_t *tet, struct pm_face **face,
                               struct pm_err *err);
/* Number of faces from k on, of n, that have the vertices of face k. */
ptrdiff_t pm_same_faces(const struct pm_face *face, ptrdiff_t k, ptrdiff_t n);

/* Faces of ne tetrahedra that belong to one of them only (n x 3, outward, new memory) with their
 * element. PM_NUMERIC where a face belongs to more than two. */
enum pm_status pm_boundary_faces(ptrdiff_t ne, const int32_t *tet, ptrdiff_t *n, int32_t **face,
                                 int32_t **element, struct pm_err *err);

#endif
