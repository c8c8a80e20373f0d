/* The assembled potential Pi(q; p, X) = strain energy - sum_r p_r V_r with a clamped base and a
 * rigid end-effector [model 2, 3], and all its derivatives. Unknowns q: 3 per free node in
 * elimination order, then the end-effector's t (3) and theta (3) if the mesh has a tip. Pressures
 * here are in MPa. Components of free nodes on symmetry planes, and end-effector DoFs that a plane
 * excludes, are fixed (their equations are unity). Directions: "q-vector" (nq); "nodal" (nn x 3).
 */
#ifndef PM_MODEL_H
#define PM_MODEL_H

#include <time.h>

#include "common/files/mesh.h"
#include "common/mechanics/cavity.h"
#include "common/mechanics/element.h"
#include "common/mechanics/pattern.h"
#include "common/mechanics/rotation.h"
#include "common/base/sparse.h"

enum { PM_NODE_FREE = 0, PM_NODE_CLAMPED = 1, PM_NODE_TIP = 2 };

/* CPU seconds of this process by kind of work. */
struct pm_cost {
    double order, assemble, factor, solve, warp;
};

struct pm_model {
    const struct pm_mesh *mesh; /* borrowed */
    struct pm_law law;
    struct pm_space space; /* nn, elements and faces with the nodes of the finite element */
    struct pm_cavity cavity;
    double blend;
    ptrdiff_t nn, nb; /* nodes of the space, batches of PM_LANES elements (the last one filled with
                         its last element) */
    ptrdiff_t nq, tail; /* unknowns; 6 with an end-effector, 0 without */
    uint8_t *kind;      /* PM_NODE_*                              (nn) */
    uint8_t *fixed;     /* equation is fixed                      (nq) */
    struct pm_pattern pattern;
    struct pm_slot
        *slot;        /* where the blocks of an element go in `value` (ne x npe (npe + 1) / 2) */
    pm_lanes *dN;     /* shape gradients at the points      (nb x points x npe x 3) [1/mm] */
    pm_lanes *w;      /* weights                            (nb x points)           [mm3] */
    pm_lanes *phi;    /* modes of the dilatation            (nb x modes x points) */
    double *arm;      /* X_a - X_ref                            (nn x 3)          [mm] */
    double origin[3]; /* x0 of the cavity volumes, on every symmetry plane        [mm] */
    double *value;    /* tangent, values of the pattern */
    struct pm_cholesky *factor;
    int factored; /* the factor is one of a positive definite tangent: 1 that of `value`, 2 an older
                     one, 0 none */
    int steps;    /* of conjugate gradients since it was made */
    long factorisations, solves; /* solves: with the factor, of all columns together */
    struct pm_cost cost;
};

/* Block (a, b) of an element: values[at + c * height + d] holds its component (d, c), or (c, d)
 * where transposed. */
struct pm_slot {
    ptrdiff_t at; /* -1: no place, -2: one of the nodes belongs to the end-effector */
    int32_t height;
    int32_t transposed;
};

/* Configuration: nodal displacements of all nodes (those of the tip follow U) and the end-effector.
 */
struct pm_config {
    double *u;   /* (nn x 3) [mm] */
    double U[6]; /* [mm], [rad] */
};

/* element: a name of space.h, NULL for the default of the mesh. */
enum pm_status pm_model_new(const struct pm_mesh *mesh, const char *element, struct pm_model **m,
                            struct pm_err *err);
void pm_model_free(struct pm_model *m);
enum pm_status pm_config_new(const struct pm_model *m, struct pm_config *c,
                             struct pm_err *err); /* undeformed */
void pm_config_copy(const struct pm_model *m, const struct pm_config *from, struct pm_config *to);
void pm_config_release(struct pm_config *c);

/* Moves the nodes of the end-effector by c->U: u_a = t + (R - I) r_a. */
void pm_model_place_tip(const struct pm_model *m, struct pm_config *c);
/* to = from moved by s dq (to may be from). */
void pm_model_move(const struct pm_model *m, const struct pm_config *from, const double *dq,
                   double s, struct pm_config *to);
/* First map: nodal field of a q-vector at theta of c: v (free), 0 (clamped), v_t + R_i v_i r_a
 * (tip). */
void pm_model_expand(const struct pm_model *m, const struct pm_config *c, const double *v,
                     double *nodal);
/* T^T: q-vector of nodal forces; fixed entries are 0. */
void pm_model_reduce(const struct pm_model *m, const struct pm_config *c, const double *nodal,
                     double *q);

/* Potential and nodal forces f = dPi/dx at all nodes (NULL: not wanted); volumes (nc) [mm3] (NULL).
 * An element with det F <= 0 gives an infinite potential. */
double pm_model_potential(const struct pm_model *m, const struct pm_config *c, const double *p,
                          double *f, double *volume, double *min_det);
/* dV_r/dx (nodal) for chamber r, 0-based. */
void pm_model_volume_gradient(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                              double *nodal);
/* Assembles K at c (f: nodal forces there; mixed for MIP or NULL) into m->value. */
void pm_model_assemble(struct pm_model *m, const struct pm_config *c, const double *p,
                       const double *f, const pm_lanes *mixed);
/* The same, and factors it. */
enum pm_status pm_model_factor(struct pm_model *m, const struct pm_config *c, const double *p,
                               const double *f, const pm_lanes *mixed, int *definite,
                               struct pm_err *err);
/* Makes solves with the tangent at c (mixed as in pm_model_assemble) possible, by the factor at
 * hand and conjugate gradients where they need few steps, else by its own factor. probe (q-vector):
 * a right-hand side, replaced by its solution to `tolerance`. definite: 1 by the new factor, or
 * where the eigenvalues of factor^-1 K that the probe excites lie above 1/4. */
enum pm_status pm_model_prepare(struct pm_model *m, const struct pm_config *c, const double *p,
                                const double *f, const pm_lanes *mixed, double *probe,
                                double tolerance, int *definite, struct pm_err *err);
/* q (nq x nrhs) is replaced by K^-1 q, K as assembled last. Where the factor is older: to residuals
 * of `tolerance`, with a new factor if that takes too long. */
enum pm_status pm_model_solve(struct pm_model *m, double *q, ptrdiff_t nrhs, double tolerance,
                              struct pm_err *err);
/* Steps of conjugate gradients that cost half a factorisation. */
int pm_model_patience(const struct pm_model *m);
/* Independent pressures and stresses (nb x points x PM_MIXED) at c, linearised along the nodal
 * field du. */
enum pm_status pm_model_mixed_new(const struct pm_model *m, pm_lanes **mixed, struct pm_err *err);
void pm_model_mixed(const struct pm_model *m, const struct pm_config *c, const double *du,
                    pm_lanes *mixed);

/* out = K_x v (nodal, pressure stiffness included; overwritten). */
void pm_model_apply(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, double *out);
/* out = third derivative of Pi by x contracted with nodal v and w (overwritten). */
void pm_model_third(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, const double *w, double *out);
/* out += s d2V_r/dx2 v */
void pm_model_volume_apply(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                           double s, const double *v, double *out);
/* Explicit derivative at fixed deformed positions of all nodes of dPi[g] + sum_k d2Pi[v_k, h_k]; D
 * (nn x 3) overwritten; v, h (n x nn x 3), n <= 8. */
void pm_model_shape(const struct pm_model *m, const struct pm_config *c, const double *g,
                    ptrdiff_t n, const double *v, const double *h, double *D);

/* Deformed positions of boundary face f relative to the origin of the volumes (npf x 3) [mm]. */
void pm_model_face(const struct pm_model *m, const struct pm_config *c, ptrdiff_t f, double *x);
/* Batch b of elements as kernels take it, and the values of a nodal field in it (npe x 3). */
struct pm_element pm_model_batch(const struct pm_model *m, ptrdiff_t b);
void pm_model_gather(const struct pm_model *m, ptrdiff_t b, const double *nodal, pm_lanes *local);
/* Elements of the batch. */
int pm_model_lanes(const struct pm_model *m, ptrdiff_t b);
/* Chamber of boundary face f, 0-based, or -1. */
ptrdiff_t pm_model_chamber(const struct pm_model *m, ptrdiff_t f);
/* Adds the CPU time since `start` (of clock()) to one of the costs. */
void pm_cost_add(double *cost, clock_t start);
/* Values of a nodal field at n nodes (n x 3). */
void pm_gather(const int32_t *nodes, ptrdiff_t n, const double *nodal, double *local);

#endif
