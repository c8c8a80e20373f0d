/* Whole-string numbers of the command line. */
#include "common/base/tool.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum pm_status pm_parse_double(const char *name, const char *text, double *out, struct pm_err *err)
{
    char *end;
    double v = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(v))
        return pm_fail(err, PM_USAGE, "option '--%s': found '%s', expected a number", name, text);
    *out = v;
    return PM_OK;
}

enum pm_status pm_parse_long(const char *name, const char *text, long *out, struct pm_err *err)
{
    char *end;
    errno = 0;
    long v = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0)
        return pm_fail(err, PM_USAGE, "option '--%s': found '%s', expected an integer", name, text);
    *out = v;
    return PM_OK;
}

enum pm_status pm_parse_doubles(const char *name, const char *text, int max, double *out, int *n,
                                struct pm_err *err)
{
    const char *p = text;
    for (*n = 0;; p++) {
        char *end;
        double v = strtod(p, &end);
        if (end == p || (*end != ',' && *end != '\0') || !isfinite(v))
            return pm_fail(err, PM_USAGE, "option '--%s': found '%s', expected numbers as 'a,b,c'",
                           name, text);
        if (*n == max)
            return pm_fail(err, PM_USAGE, "option '--%s': found '%s', expected at most %d numbers",
                           name, text, max);
        out[(*n)++] = v;
        p = end;
        if (*p == '\0')
            return PM_OK;
    }
}
