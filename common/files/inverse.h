/* Targets of an inverse kinematics and how near they came: what a file of kind `path` holds beside
 * the equilibria. */
#ifndef PM_INVERSE_H
#define PM_INVERSE_H

#include "common/files/h5.h"

enum pm_verdict {
    PM_REACHED = 0,
    PM_AT_BOUND = 1,       /* the nearest pose, with a pressure at a bound */
    PM_NEAREST = 2,        /* the nearest pose, all pressures between their bounds */
    PM_NO_EQUILIBRIUM = 3, /* the body gives way on the way to the target */
    PM_UNFINISHED = 4      /* too many equilibria, or no progress */
};

struct pm_inverse {
    ptrdiff_t np, nd, nc; /* targets, components of the pose asked for, chambers */
    int64_t dofs[6];      /* which, 1..6                                 (nd) */
    double limits[2];     /* least and largest pressure                  [p/mu] */
    double length;        /* that weighs a radian                        [mm] */
    double tolerance;     /* of the position [mm] and of the orientation [degrees] */
    double *target;       /* positions [mm], rotation vectors [rad]      (np x nd) */
    double *error;        /* distance in position [mm], in the rotation vector [rad]  (np x 2) */
    int64_t *verdict;     /* enum pm_verdict                             (np) */
    int64_t *bound;       /* pressure at its lower bound -1, upper 1, between 0  (np x nc) */
    int64_t *iterations;  /* steps in pressure taken                     (np) */
    int64_t *equilibria;  /* finite element solutions, failed ones too   (np) */
};

/* Arrays for np targets, nd and nc set. */
enum pm_status pm_inverse_allocate(struct pm_inverse *v, ptrdiff_t np, struct pm_err *err);
enum pm_status pm_inverse_write(struct pm_h5 *f, const struct pm_inverse *v, struct pm_err *err);
void pm_inverse_release(struct pm_inverse *v);

#endif
