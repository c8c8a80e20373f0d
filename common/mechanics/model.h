/* The assembled potential Pi(q; p, X) = strain energy - sum_r p_r V_r with a clamped base and a
 * rigid end-effector [model 2, 3], and all its derivatives. Unknowns q: 3 per free node in
 * elimination order, then the end-effector's t (3) and theta (3) if the mesh has a tip. Pressures
 * here are in MPa. Components of free nodes on symmetry planes, and end-effector DoFs that a plane
 * excludes, are fixed (their equations are unity). Directions: "q-vector" (nq); "nodal" (nn x 3).
 */
#ifndef PM_MODEL_H
#define PM_MODEL_H

#include "common/files/mesh.h"
#include "common/mechanics/element.h"
#include "common/mechanics/pattern.h"
#include "common/mechanics/rotation.h"
#include "common/mechanics/sparse.h"

enum { PM_NODE_FREE = 0, PM_NODE_CLAMPED = 1, PM_NODE_TIP = 2 };

struct pm_model {
    const struct pm_mesh *mesh; /* borrowed */
    struct pm_law law;
    double blend;
    ptrdiff_t nq, tail; /* unknowns; 6 with an end-effector, 0 without */
    uint8_t *kind;      /* PM_NODE_*                              (nn) */
    uint8_t *fixed;     /* equation is fixed                      (nq) */
    struct pm_pattern pattern;
    double *dN;       /* shape gradients at the points          (ne x 4 x 10 x 3) [1/mm] */
    double *w;        /* weights                                (ne x 4)          [mm3] */
    double *arm;      /* X_a - X_ref                            (nn x 3)          [mm] */
    double origin[3]; /* x0 of the cavity volumes, on every symmetry plane        [mm] */
    double *value;    /* tangent, values of the pattern */
    struct pm_cholesky *factor;
    long factorisations;
};

/* Configuration: nodal displacements of all nodes (those of the tip follow U) and the end-effector.
 */
struct pm_config {
    double *u;   /* (nn x 3) [mm] */
    double U[6]; /* [mm], [rad] */
};

enum pm_status pm_model_new(const struct pm_mesh *mesh, const char *element, struct pm_model **m,
                            struct pm_err *err);
void pm_model_free(struct pm_model *m);
enum pm_status pm_config_new(const struct pm_model *m, struct pm_config *c,
                             struct pm_err *err); /* undeformed */
void pm_config_copy(const struct pm_model *m, const struct pm_config *from, struct pm_config *to);
void pm_config_release(struct pm_config *c);

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
/* Assembles K at c (f: nodal forces there; pressure (ne x 4) for MIP or NULL) and factors it. */
enum pm_status pm_model_factor(struct pm_model *m, const struct pm_config *c, const double *p,
                               const double *f, const double *pressure, int *definite,
                               struct pm_err *err);
enum pm_status pm_model_solve(struct pm_model *m, double *q, ptrdiff_t nrhs, struct pm_err *err);
/* MIP pressures (ne x 4) at c, linearised along the nodal field du. */
void pm_model_pressure(const struct pm_model *m, const struct pm_config *c, const double *du,
                       double *pressure);

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

/* The element e as kernels take it, and its nodal values gathered from a nodal field. */
struct pm_element pm_model_element(const struct pm_model *m, ptrdiff_t e);
/* Deformed positions of boundary face f relative to the origin of the volumes (6 x 3) [mm]. */
void pm_model_face(const struct pm_model *m, const struct pm_config *c, ptrdiff_t f, double x[18]);
void pm_gather(const int32_t *nodes, int n, const double *nodal, double *local);

#endif
