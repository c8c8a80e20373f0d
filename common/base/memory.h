/* All memory comes from here: checked sizes, zeroed, and a test can make the n-th request fail. */
#ifndef PM_MEMORY_H
#define PM_MEMORY_H

#include <stddef.h>

#include "common/base/status.h"

/* n * size zeroed bytes (never NULL for n = 0), or NULL with err set to PM_SYSTEM. */
void *pm_calloc(ptrdiff_t n, size_t size, struct pm_err *err);
/* The same at an address that is a multiple of `size` (a power of 2): for vector types. */
void *pm_calloc_aligned(ptrdiff_t n, size_t size, struct pm_err *err);
/* Resizes to n * size bytes; on failure returns NULL with err set and leaves p alone. */
void *pm_realloc(void *p, ptrdiff_t n, size_t size, struct pm_err *err);
void pm_free(void *p);
/* Fault injection for tests: the n-th request from now fails (n = 0: none). */
void pm_memory_fail_at(long n);

/* p = n zeroed items; a status. */
#define PM_NEW(p, n, err)                                                                          \
    (((p) = pm_calloc((ptrdiff_t)(n), sizeof *(p), (err))) != NULL ? PM_OK : PM_SYSTEM)

/* p grown to n items, or the calling function returns PM_SYSTEM. */
#define PM_GROW(p, n, err)                                                                         \
    do {                                                                                           \
        void *q_ = pm_realloc(p, n, sizeof *(p), err);                                             \
        if (q_ == NULL)                                                                            \
            return PM_SYSTEM;                                                                      \
        (p) = q_;                                                                                  \
    } while (0)

#endif
