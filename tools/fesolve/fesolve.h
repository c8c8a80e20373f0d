/* fesolve: stable static equilibria of a mesh at one load or along a path of loads. */
#ifndef PM_FESOLVE_H
#define PM_FESOLVE_H

#include "common/base/tool.h"
#include "common/files/case.h"

enum { FESOLVE_MOST_GUESSES = 32 };

struct fesolve_opts {
    int have_load, have_form, npressure; /* exactly one of load, pressure and path */
    long load;
    enum pm_form form;
    double pressure[PM_MAX_CHAMBERS];            /* [p/mu] */
    const char *guess[FESOLVE_MOST_GUESSES + 1]; /* ends with NULL */
    int nguess;
    const char *path; /* file of pressures, one point a line */
    const char *element;
    struct pm_material material; /* instead of that of the mesh, where it says anything */
    double tolerance;
    long threads;
    int limit;
    int record_failure;
};

enum pm_status fesolve_run(const struct fesolve_opts *opts, const struct pm_common *common,
                           struct pm_err *err);

#endif
