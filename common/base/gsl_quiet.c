#include "common/base/libraries.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_version.h>

void pm_gsl_quiet(void)
{
    gsl_set_error_handler_off();
}

const char *pm_gsl_version(void)
{
    return gsl_version;
}
