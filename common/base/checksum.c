#include "common/base/libraries.h"

#include <zlib.h>

unsigned long pm_crc32(unsigned long crc, const void *bytes, size_t n)
{
    return crc32_z(crc, bytes, n);
}

const char *pm_zlib_version(void)
{
    return zlibVersion();
}
