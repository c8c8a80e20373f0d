/* Typed HDF5 access through the schema table: the only user of hdf5.h. */
#ifndef PM_H5_H
#define PM_H5_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"
#include "common/base/tool.h"

struct pm_h5; /* an open file */

enum { PM_MAX_RANK = 4 };

/* Opens for reading; refuses (PM_INPUT) a missing or truncated file, a wrong `format`, major
 * version, or a kind that is not in the space separated list `kinds` ("mesh", "surface step"). */
enum pm_status pm_h5_open(const char *path, const char *kinds, struct pm_h5 **f,
                          struct pm_err *err);
/* Creates a temporary file beside `path`; root attributes (format, kind, tool, command, inputs with
 * digest, history of the inputs: provenance.h) come from `common`, whose existing operands are the
 * inputs. extra_inputs: further input files (options such as --previous), NULL terminated, may be
 * NULL. */
enum pm_status pm_h5_create(const char *path, const char *kind, const struct pm_common *common,
                            const char *const *extra_inputs, struct pm_h5 **f, struct pm_err *err);
/* Checks a created file for its required items, flushes it and renames it to its path; closes. On
 * failure the handle stays for pm_h5_close: PM_TRY(pm_h5_commit(f, err)); f = NULL; done:
 * pm_h5_close(f). */
enum pm_status pm_h5_commit(struct pm_h5 *f, struct pm_err *err);
/* Closes; removes the temporary of a created file. Accepts NULL. */
void pm_h5_close(struct pm_h5 *f);
const char *pm_h5_path(const struct pm_h5 *f);

/* Writes the dataset `name` of the schema; dims as in the schema (rank of them). Type: double,
 * int32_t, int64_t, uint8_t or text by schema. "%d" in a schema name: give the full name. */
enum pm_status pm_h5_put(struct pm_h5 *f, const char *name, const ptrdiff_t *dims, const void *data,
                         struct pm_err *err);
/* Reads a dataset into new memory (pm_free); fills dims. Refuses a missing item, another rank or
 * type, symbolic sizes that disagree with those already read from this file ("nn" is one number per
 * file), and NaN or infinite doubles: PM_INPUT `cannot use 'f': item '/mesh/x' ...`. */
enum pm_status pm_h5_get(struct pm_h5 *f, const char *name, ptrdiff_t *dims, void *data_out,
                         struct pm_err *err);
/* The same into caller's memory of `count` items; another total is PM_INPUT. */
enum pm_status pm_h5_get_into(struct pm_h5 *f, const char *name, ptrdiff_t count, void *data,
                              struct pm_err *err);
/* PM_INPUT `cannot use 'f': item '/name' ...`: for the checks of the records. */
enum pm_status pm_h5_refuse(const struct pm_h5 *f, struct pm_err *err, const char *item,
                            const char *format, ...) __attribute__((format(printf, 4, 5)));
int pm_h5_has(struct pm_h5 *f, const char *name);
/* Scalars and texts, same checks. */
enum pm_status pm_h5_put_double(struct pm_h5 *f, const char *name, double v, struct pm_err *err);
enum pm_status pm_h5_put_int(struct pm_h5 *f, const char *name, int64_t v, struct pm_err *err);
enum pm_status pm_h5_put_text(struct pm_h5 *f, const char *name, const char *v, struct pm_err *err);
enum pm_status pm_h5_get_double(struct pm_h5 *f, const char *name, double *v, struct pm_err *err);
enum pm_status pm_h5_get_int(struct pm_h5 *f, const char *name, int64_t *v, struct pm_err *err);
enum pm_status pm_h5_get_text(struct pm_h5 *f, const char *name, char **v, struct pm_err *err);
/* A copy of a root attribute (pm_free); PM_INPUT where there is none. */
enum pm_status pm_h5_get_attribute(struct pm_h5 *f, const char *name, char **text,
                                   struct pm_err *err);
/* Soft link inside the file, e.g. /VTKHDF/Points -> /mesh/x. */
enum pm_status pm_h5_link(struct pm_h5 *f, const char *target, const char *name,
                          struct pm_err *err);
/* Attributes Version and Type of the existing group /VTKHDF. */
enum pm_status pm_h5_mark_vtk(struct pm_h5 *f, const char *type, struct pm_err *err);
/* Writes the group /VTKHDF (UnstructuredGrid, nodes in VTK order) for the nn nodes of the dataset
 * `points`, already written, and the cells tet (ne x npe): npe 4 or 10, tetrahedra, 2, lines, or 3,
 * triangles. */
enum pm_status pm_h5_put_vtk(struct pm_h5 *f, const char *points, ptrdiff_t nn, ptrdiff_t ne,
                             ptrdiff_t npe, const int32_t *tet, struct pm_err *err);
/* Adds a nodal field (nn x ..) of the schema to /VTKHDF/PointData by a link, or one of the cells
 * (ne x ..) to /VTKHDF/CellData. */
enum pm_status pm_h5_vtk_point_field(struct pm_h5 *f, const char *dataset, const char *label,
                                     struct pm_err *err);
enum pm_status pm_h5_vtk_cell_field(struct pm_h5 *f, const char *dataset, const char *label,
                                    struct pm_err *err);

#endif
