/* Equilibria of one mesh along a path of pressures. Kind `path`: holds its mesh. */
#ifndef PM_SWEEP_H
#define PM_SWEEP_H

#include "common/files/mesh.h"

struct pm_sweep {
    struct pm_mesh mesh;
    char element[32];
    ptrdiff_t np;      /* points */
    double *pressure;  /* (np x nc) [p/mu] */
    int64_t *reached;  /* 1: equilibrium, 0: none was found and the rest is 0    (np) */
    char *reason;      /* one line a point, empty where it was reached */
    double *U;         /* end-effector: translation [mm], rotation vector [rad]  (np x 6) */
    double *J;         /* dU/d(p/mu)                                             (np x 6 x nc) */
    double *volume;    /* of the chambers                                        (np x nc) [mm3] */
    double *energy;    /* strain energy                                          (np) [mJ] */
    double *residual;  /* |g|_inf / |pressure load|_inf                          (np) */
    double *min_det_F; /*                                                        (np) */
    int64_t *factorisations; /* (np) */
    int64_t *intersections;  /* of the deformed boundary with itself                (np) */
    double *closeness;       /* G of geometry/closeness.h                           (np) */
    double *gap;             /* least distance across air, -1: wide                 (np) [mm] */
    double
        *displacement; /* of the mesh's nodes                                 (np x nn x 3) [mm] */
};

/* Arrays for np points of s->mesh, which is set. */
enum pm_status pm_sweep_allocate(struct pm_sweep *s, ptrdiff_t np, struct pm_err *err);
enum pm_status pm_sweep_load(const char *path, struct pm_sweep *s, struct pm_err *err);
enum pm_status pm_sweep_write(struct pm_h5 *f, const struct pm_sweep *s, struct pm_err *err);
void pm_sweep_release(struct pm_sweep *s);

#endif
