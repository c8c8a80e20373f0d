/* Finite elements by name, and the space of one of them on a mesh. */
#ifndef PM_SPACE_H
#define PM_SPACE_H

#include "common/files/mesh.h"

enum {
    PM_MOST_NODES = 15,  /* of an element */
    PM_MOST_POINTS = 14, /* of its quadrature */
    PM_MOST_MODES = 4    /* of its dilatation */
};

/* x = sum_a x_a N_a; the values of bubbles (nodes 10 and on) are amplitudes, 0 in the reference
 * shape, so that every element is isoparametric. Node order: mesh.h, then the bubbles of the faces
 * opposite to vertices 0..3, then the one of the cell. */
struct pm_element_type {
    const char *name;
    int npe, npf;          /* nodes of element and boundary face                     */
    int nq;                /* quadrature points                                      */
    int modes;             /* of the projected dilatation: 0, 1 (mean) or 4 (linear) */
    double stiffness;      /* blend b = min(1, stiffness mu/kappa); < 0: b = 1 */
    const double (*xi)[3]; /* points  (nq x 3)                                       */
    const double *weight;  /* sum 1/6 (nq)                                           */
};

/* tet10-blend, tet10, tet10-mean, tet4, tet15; NULL: the default of the mesh (tet10-blend, on
 * linear meshes tet4). PM_USAGE: unknown, PM_INPUT: not on a linear mesh. */
enum pm_status pm_element_type(const char *name, const struct pm_mesh *mesh,
                               const struct pm_element_type **type, struct pm_err *err);
/* dN_a/dxi_j (npe x 3) at the reference point xi. */
void pm_element_shape_gradient(const struct pm_element_type *t, const double xi[3], double *dN);

struct pm_space {
    const struct pm_element_type *type;
    ptrdiff_t nn, ne, nf; /* nodes of the space: those of the mesh first */
    int32_t *tet;         /* (ne x npe) */
    int32_t *tri;         /* (nf x npf) boundary faces */
    double *x;            /* reference positions, 0 for bubbles (nn x 3) [mm] */
};

enum pm_status pm_space_new(const struct pm_mesh *mesh, const struct pm_element_type *type,
                            struct pm_space *s, struct pm_err *err);
void pm_space_release(struct pm_space *s);

#endif
