/* A finished design as the start of another run. */
#ifndef PM_SURFGEN_DESIGN_H
#define PM_SURFGEN_DESIGN_H

#include "common/files/surfaces.h"

/* The surfaces of a surface file, or the accepted design of a step file, under case c. PM_INPUT
 * where the symmetry, the number of chambers or the height of the case is another. */
enum pm_status pm_design_load(const char *path, const struct pm_case *c, struct pm_surfaces *s,
                              struct pm_err *err);

#endif
