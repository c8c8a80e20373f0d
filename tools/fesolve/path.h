/* Equilibria along a path of pressures. */
#ifndef PM_FESOLVE_PATH_H
#define PM_FESOLVE_PATH_H

#include "common/files/mesh.h"
#include "tools/fesolve/fesolve.h"

/* Solves on the mesh, which is taken over, at the points of o->path one after the other, each by
 * continuation from the last one that was reached (the first one as one load is), and writes a file
 * of kind path. A point without equilibrium is PM_NUMERIC and names it, or is recorded where
 * o->record_failure. */
enum pm_status fesolve_path(const struct fesolve_opts *o, const struct pm_common *common,
                            struct pm_mesh *mesh, struct pm_err *err);

#endif
