/* invkin: chamber pressures for wanted poses of the end-effector. */
#ifndef INVKIN_H
#define INVKIN_H

#include "common/base/tool.h"
#include "common/files/case.h"

enum { INVKIN_MOST_GUESSES = 32 };

struct invkin_opts {
    double target[6]; /* one target (ntarget) [mm, rad] */
    int ntarget;
    const char *targets; /* or a file of them */
    int dof[6], ndof;    /* components of the pose, 0..5; ndof 0: those of the case */
    double bounds[2];    /* [p/mu] */
    int nbounds;         /* 0: those of the case, else 2 */
    double length;       /* that weighs a radian [mm] */
    double tolerance;    /* [mm], [degrees] */
    long most;           /* equilibria per target */
    const char *guess[INVKIN_MOST_GUESSES + 1]; /* ends with NULL */
    int nguess;
    const char *element;
    double residual; /* of the equilibria, over the pressure load */
    long threads;
    int table; /* print one */
    int record_failure;
};

/* Reads the mesh, pursues the targets in their order, writes a file of kind path. PM_NUMERIC where
 * the one target of `target` is not reached, unless record_failure. */
enum pm_status invkin_run(const struct invkin_opts *opts, const struct pm_common *common,
                          struct pm_err *err);

#endif
