/* meshexport: the problem of a mesh or a state as an input deck of CalculiX, and the comparison of
 * a state with what CalculiX made of its deck. */
#ifndef PM_MESHEXPORT_H
#define PM_MESHEXPORT_H

#include "common/base/tool.h"
#include "common/files/mesh.h"

struct meshexport_opts {
    int npressure;                    /* 0: the operand is a state, which has them */
    double pressure[PM_MAX_CHAMBERS]; /* [p/mu] */
    long steps;                       /* load increments at least */
    const char *compare;              /* results of CalculiX (JOB.dat), or NULL */
};

enum pm_status meshexport_run(const struct meshexport_opts *opts, const struct pm_common *common,
                              struct pm_err *err);

#endif
