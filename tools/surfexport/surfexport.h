/* surfexport: the surfaces of a design as triangles for printers, mesh generators and viewers, and
 * what it takes to cast it: mould halves and cores. */
#ifndef PM_SURFEXPORT_H
#define PM_SURFEXPORT_H

#include "common/base/tool.h"
#include "tools/surfexport/mould.h"

struct surfexport_opts {
    const char *what; /* body, exterior, chambers, chamberN, mould1, mould2, coreN, plate */
    double size;      /* longest edges [mm], 0: of the case */
    double tolerance; /* [mm] */
    int ascii;
    int accepted;            /* of a step file the accepted design */
    struct mould_opts mould; /* snap is set here */
};

enum pm_status surfexport_run(const struct surfexport_opts *opts, const struct pm_common *common,
                              struct pm_err *err);

#endif
