/* Equilibrium of one mesh at one load. Kind `state`: holds its mesh. */
#ifndef PM_STATE_H
#define PM_STATE_H

#include "common/files/mesh.h"

/* Self-contact of the deformed body, which the equilibrium does not know of (geometry/contact.h).
 */
struct pm_self_contact {
    int64_t intersections; /* pairs of faces that pierce each other */
    double gap;            /* least distance across air [mm]: 0 where faces pierce, -1: wide */
    double closeness;      /* G of geometry/closeness.h [1] */
    double at[3];          /* where, deformed [mm] */
    int32_t surface[2];    /* PM_FACE_* of the two faces there */
};

struct pm_state {
    struct pm_mesh mesh;
    char failure[512]; /* "" or why there is no equilibrium (also passes a mesh failure on) */
    char element[32];
    int64_t form, load; /* which point of which Gauss set (pm_load_set), load -1: free pressures */
    double *pressure;   /* (n) [p/mu] */
    double *u;          /* nodal displacement (nn x 3) [mm] */
    ptrdiff_t nbubble;  /* amplitudes of the bubbles of tet15, else none */
    double *bubble;     /* (nbubble x 3) [mm] */
    double U[6];        /* end-effector: translation [mm], rotation vector [rad] */
    double *J;          /* dU/d(p/mu)         (6 x n)  */
    double *volume, *volume0; /* chamber volumes, deformed and reference (n) [mm3] */
    double reaction[6]; /* force [N] and moment about the reference point [N mm] of the clamp on the
                           body */
    double energy;      /* strain energy [mJ] */
    double residual;    /* |g|_inf / |pressure load|_inf */
    double min_det_F;
    int64_t load_steps, newton_steps, factorisations, backoffs;
    int64_t unknowns, solves;            /* solves with a factor, of all right-hand sides at once */
    double factor_entries, factor_flops; /* of one factorisation */
    double limit;   /* of --limit: limit pressures over the wanted, 0: not sought or none */
    int64_t stable; /* 1: tangent positive definite at the solution */
    int64_t warm;   /* 1: started from --guess */
    struct pm_self_contact contact;
};

enum pm_status pm_state_read(struct pm_h5 *f, struct pm_state *s, struct pm_err *err);
enum pm_status pm_state_load(const char *path, int allow_failure, struct pm_state *s,
                             struct pm_err *err);
enum pm_status pm_state_write(struct pm_h5 *f, const struct pm_state *s, struct pm_err *err);
void pm_state_release(struct pm_state *s);

#endif
