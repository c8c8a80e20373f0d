/* Files of triangles. */
#ifndef PM_SURFEXPORT_WRITE_H
#define PM_SURFEXPORT_WRITE_H

#include "common/base/tool.h"
#include "common/files/case.h"
#include "tools/surfexport/skin.h"

enum write_format { WRITE_STL, WRITE_STL_ASCII, WRITE_OBJ, WRITE_MSH, WRITE_VTK };

/* By the suffix of path: .stl, .obj, .msh, .h5 or .vtkhdf; PM_USAGE for another one. */
enum pm_status write_format_of(const char *path, enum write_format *format, struct pm_err *err);
/* Writes all but WRITE_VTK, whole or not at all. `name` stands in the file. */
enum pm_status write_triangles(const struct skin *s, enum write_format format, const char *name,
                               const char *path, struct pm_err *err);
/* A file of kind "skin" with VTKHDF; with curvature and walls where `fields`. */
enum pm_status write_vtk(const struct skin *s, const struct pm_case *c, int fields,
                         const struct pm_common *common, struct pm_err *err);

#endif
