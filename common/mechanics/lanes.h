/* Eight elements at a time: one lane per element, as the compiler's vector type. */
#ifndef PM_LANES_H
#define PM_LANES_H

#include "common/base/memory.h"

enum { PM_LANES = 8 };
typedef double pm_lanes __attribute__((vector_size(PM_LANES * sizeof(double))));

static inline pm_lanes pm_lanes_all(double s)
{
    return s - (pm_lanes){0};
}

/* p = n zeroed and aligned batches of lanes; a status. */
#define PM_NEW_LANES(p, n, err)                                                                    \
    (((p) = pm_calloc_aligned((ptrdiff_t)(n), sizeof *(p), (err))) != NULL ? PM_OK : PM_SYSTEM)

#endif
