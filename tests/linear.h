/* Makes the sample mesh of records.h linear: one 4-node tetrahedron, imported. */
#ifndef PM_TESTS_LINEAR_H
#define PM_TESTS_LINEAR_H

#include <string.h>

#include "common/files/mesh.h"

static inline void sample_linear(struct pm_mesh *m)
{
    for (ptrdiff_t f = 0; f < m->nf; f++)
        memmove(m->tri + 3 * f, m->tri + 6 * f, 3 * sizeof *m->tri);
    memset(m->wptr, 0, 5 * sizeof *m->wptr);
    memset(m->surface, 0xff, 4 * sizeof *m->surface);
    m->nn = m->npe = 4;
    m->npf = 3;
    m->nw = m->N = 0;
    m->origin = PM_ORIGIN_IMPORTED;
}

#endif
