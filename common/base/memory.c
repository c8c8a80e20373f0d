#include "common/base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Requests until the one that fails; 0: none. Only tests set it. */
static long countdown;

void pm_memory_fail_at(long n)
{
    countdown = n;
}

static int refuse(void)
{
    return countdown > 0 && --countdown == 0;
}

/* The checked size in bytes, at least 1; 0 where n * size does not fit. */
static size_t checked(ptrdiff_t n, size_t size)
{
    if (n < 0 || (size > 0 && (size_t)n > (size_t)PTRDIFF_MAX / size))
        return 0;
    size_t bytes = (size_t)n * size;
    return bytes > 0 ? bytes : 1;
}

void *pm_calloc(ptrdiff_t n, size_t size, struct pm_err *err)
{
    size_t bytes = checked(n, size);
    void *p = bytes == 0 || refuse() ? NULL : calloc(1, bytes);
    if (p == NULL)
        pm_fail(err, PM_SYSTEM, "out of memory: %td items of %zu bytes", n, size);
    return p;
}

void *pm_calloc_aligned(ptrdiff_t n, size_t size, struct pm_err *err)
{
    size_t bytes = checked(n > 0 ? n : 1, size);
    void *p = bytes == 0 || refuse() ? NULL : aligned_alloc(size, bytes);
    if (p == NULL)
        pm_fail(err, PM_SYSTEM, "out of memory: %td items of %zu bytes", n, size);
    else
        memset(p, 0, bytes);
    return p;
}

void *pm_realloc(void *p, ptrdiff_t n, size_t size, struct pm_err *err)
{
    size_t bytes = checked(n, size);
    void *q = bytes == 0 || refuse() ? NULL : realloc(p, bytes);
    if (q == NULL)
        pm_fail(err, PM_SYSTEM, "out of memory: %td items of %zu bytes", n, size);
    return q;
}

void pm_free(void *p)
{
    free(p);
}
