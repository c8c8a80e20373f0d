#include "common/base/libraries.h"

#include <SuiteSparse_config.h>
#include <stdio.h>

void pm_suitesparse_version(char *text, size_t size)
{
    snprintf(text, size, "%d.%d.%d", SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
             SUITESPARSE_SUBSUB_VERSION);
}
