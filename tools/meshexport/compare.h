/* What CalculiX made of the deck of a state, beside the state. */
#ifndef PM_MESHEXPORT_COMPARE_H
#define PM_MESHEXPORT_COMPARE_H

#include "common/files/state.h"

/* Nodal displacements of the last block of JOB.dat at time 2, the end: u ((nn + 2) x 3) [mm, of the
 * last row rad], numbered as in the deck. PM_INPUT where that is missing, or a node of it. */
enum pm_status compare_read(const char *path, ptrdiff_t n, double *u, struct pm_err *err);
/* Prints to stdout, tab separated: quantity, here, there, relative difference. */
enum pm_status compare_print(const struct pm_state *s, const double *u, struct pm_err *err);

#endif
