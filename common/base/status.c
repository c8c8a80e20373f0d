#include "common/base/status.h"

#include <stdarg.h>
#include <stdio.h>

enum pm_status pm_fail(struct pm_err *err, enum pm_status status, const char *format, ...)
{
    if (err != NULL && err->status == PM_OK) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
        err->status = status;
    }
    return status;
}
