/* Lists of points in text files: one a line, numbers between blanks or commas, # begins a comment.
 */
#ifndef PM_POINTS_H
#define PM_POINTS_H

#include <stddef.h>

#include "common/base/status.h"

/* *x (np x n) is new memory; `what` names one number, `why` where n comes from ("the mesh has 2
 * chambers"). PM_INPUT names the line; no points are PM_INPUT. */
enum pm_status pm_points_read(const char *path, ptrdiff_t n, const char *what, const char *why,
                              double **x, ptrdiff_t *np, struct pm_err *err);

#endif
