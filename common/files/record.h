/* What the record modules share. */
#ifndef PM_RECORD_H
#define PM_RECORD_H

#include <string.h>

#include "common/base/memory.h"
#include "common/files/case.h"
#include "common/files/h5.h"

/* Parses /case/text of the file. */
enum pm_status pm_record_get_case(struct pm_h5 *f, struct pm_case *c, struct pm_err *err);
/* Reads /failure into text, "" where the file records none. */
enum pm_status pm_record_get_failure(struct pm_h5 *f, char *text, size_t size, struct pm_err *err);
/* A short text item; longer than size - 1 is PM_INPUT. */
enum pm_status pm_record_get_short(struct pm_h5 *f, const char *name, char *text, size_t size,
                                   struct pm_err *err);
/* PM_INPUT where an entry is outside [low, high). */
enum pm_status pm_check_range(const struct pm_h5 *f, const char *name, const int32_t *v,
                              ptrdiff_t n, ptrdiff_t low, ptrdiff_t high, struct pm_err *err);
/* A recorded failure as an error: PM_INPUT `cannot use 'f': it records a failure: ...`. */
enum pm_status pm_record_fail(const char *path, const char *failure, struct pm_err *err);

/* *(T **)target = copy of n items of `size` bytes. */
enum pm_status pm_copy_array(void *target, const void *from, ptrdiff_t n, size_t size,
                             struct pm_err *err);

#endif
