/* One target: Gauss-Newton steps in the pressures within their bounds and a trust region. */
#ifndef INVKIN_PURSUE_H
#define INVKIN_PURSUE_H

#include "common/files/case.h"
#include "common/files/inverse.h"

/* What is asked for. e = D (U - U*) over the components `dof`, D = 1 for positions, `length` for
 * the rotation vector; |e| is what becomes small. */
struct pursue_task {
    int nd, dof[6];   /* components of the pose, 0..5 */
    double target[6]; /* (nd) [mm, rad] */
    double length;    /* [mm] */
    double tolerance; /* [mm] of the position, [degrees] of the rotation vector */
    int n;            /* chambers */
    double low, high; /* bounds of all pressures [p/mu] */
    int most;         /* equilibria at most */
    /* U(p) and J = dU/dp; PM_NUMERIC: there is no equilibrium at p. */
    enum pm_status (*pose)(void *data, const double *p, double U[6], double *J, struct pm_err *err);
    void *data;
};

struct pursue_pose {
    double p[PM_MAX_CHAMBERS];     /* [p/mu] */
    double U[6];                   /* [mm, rad] */
    double J[6 * PM_MAX_CHAMBERS]; /* (6 x n) */
};

struct pursue_result {
    struct pursue_pose best;
    double error[2]; /* distance of the positions [mm], of the rotation vectors [rad] */
    enum pm_verdict verdict;
    int bound[PM_MAX_CHAMBERS]; /* -1 low, 1 high, 0 between */
    int iterations;             /* steps taken */
    int equilibria;             /* calls of pose(), failed ones too */
    int failures;               /* of them without equilibrium */
    char why[192];              /* the last of these */
};

/* |e| of a pose, weighed [mm]. */
double pursue_distance(const struct pursue_task *t, const double U[6]);
/* From `start`, a pose that pose() has given. Each step minimises |e + D J dp| over the box of the
 * bounds and of the trust region; where chambers are more than components, it is the shortest one
 * (box.h). A pose is the nearest one where no step within the bounds moves it, by its Jacobian, by
 * more than the tolerance. Fails only where pose() fails other than by PM_NUMERIC. */
enum pm_status pursue(const struct pursue_task *t, const struct pursue_pose *start,
                      struct pursue_result *r, struct pm_err *err);

#endif
