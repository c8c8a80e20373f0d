/* Surfaces from the files of the command line. */
#ifndef PM_SURFGEN_FILES_H
#define PM_SURFGEN_FILES_H

#include "tools/surfgen/given.h"
#include "tools/surfgen/surfgen.h"

/* PM_USAGE unless the files are those that the case asks for. */
enum pm_status pm_files_check(const struct pm_case *c, const struct surfgen_files *files,
                              struct pm_err *err);
int pm_files_has(const struct pm_case *c, ptrdiff_t surface);
/* Surface k of the robot (0 the body), fitted to its file. */
enum pm_status pm_files_surface(const struct pm_case *c, const struct surfgen_files *files,
                                ptrdiff_t k, struct pm_surface *s, struct pm_misfit *misfit,
                                struct pm_err *err);

#endif
