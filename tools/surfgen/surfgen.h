#ifndef PM_SURFGEN_H
#define PM_SURFGEN_H

#include "common/base/tool.h"
#include "common/files/surfaces.h"

/* Reads the case, writes its initial surfaces. */
enum pm_status surfgen_run(const struct pm_common *common, struct pm_err *err);
/* The initial surfaces of a case, fitted, exactly symmetric and checked. */
enum pm_status pm_surfgen(const struct pm_case *c, struct pm_surfaces *s, struct pm_err *err);

#endif
