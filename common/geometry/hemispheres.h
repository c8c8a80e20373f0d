/* Local isotropy of a parametrisation: step 2 of the paper's Algorithm 1 [paper 75-76, model 9
 * step 2]. */
#ifndef PM_HEMISPHERES_H
#define PM_HEMISPHERES_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

/* Nodes S (nn x 3, in and out) of a closed triangulation of the unit sphere: in the stereographic
 * chart of each half, S_3 > -0.25 and then S_3 < 0.25, they move into the middle of their
 * neighbours (harmonic, equal weights), the others held. A half that would fold stays as it is;
 * *passes: halves done. One call is one sweep: several draw all nodes to one point. */
enum pm_status pm_hemispheres(ptrdiff_t nn, double *S, ptrdiff_t nt, const int32_t *tri,
                              int *passes, struct pm_err *err);

#endif
