#ifndef PM_SURFGEN_H
#define PM_SURFGEN_H

#include "common/base/tool.h"
#include "common/files/surfaces.h"
#include "common/geometry/check.h"

/* Closed triangle meshes (STL, OBJ) for what the case says is from a file, or a design instead of
 * all shapes of the case; NULL: none. */
struct surfgen_files {
    const char *design; /* surface or step file whose surfaces are taken as they are */
    const char *body;
    const char *chamber[PM_MAX_CHAMBERS];
};

/* Reads the case, writes its initial surfaces. Of a design, warns of what breaks the constraints.
 */
enum pm_status surfgen_run(const struct surfgen_files *files, const struct pm_common *common,
                           struct pm_err *err);
/* How well it went. */
struct pm_surfgen_report {
    /* distance of each wanted surface from the fitted one, at points that the fit has not seen:
     * mean over the area, largest (1 + chambers) [mm] */
    double mean[PM_MAX_CHAMBERS + 1], max[PM_MAX_CHAMBERS + 1];
    struct pm_check check;
};
/* The initial surfaces of a case, fitted, exactly symmetric and checked. Warns of a fit error above
 * a tenth of the spacing of control points, refuses (PM_INPUT) one above half of it. */
enum pm_status pm_surfgen(const struct pm_case *c, struct pm_surfaces *s,
                          struct pm_surfgen_report *report, struct pm_err *err);
/* The same of a case with files; PM_USAGE where one is missing or not asked for. The distance from
 * a file is stated, not judged: what files hold may have sharp edges. */
enum pm_status pm_surfgen_from(const struct pm_case *c, const struct surfgen_files *files,
                               struct pm_surfaces *s, struct pm_surfgen_report *report,
                               struct pm_err *err);

#endif
