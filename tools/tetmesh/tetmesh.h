/* tetmesh: surfaces -> volume mesh, or an imported mesh. */
#ifndef PM_TETMESH_H
#define PM_TETMESH_H

#include "common/base/tool.h"
#include "common/files/mesh.h"

struct tetmesh_opts {
    double size;          /* wanted edge length [mm], 0: of the case */
    double timeout;       /* [s], 0: none */
    const char *previous; /* mesh to morph, or NULL */
    int record_failure;
};

enum pm_status tetmesh_run(const struct tetmesh_opts *o, const struct pm_common *common,
                           struct pm_err *err);

#endif
