/* What the frame asks of the libraries at start. Each function is implemented in the one .c file
 * that includes the library's header. */
#ifndef PM_LIBRARIES_H
#define PM_LIBRARIES_H

#include <stddef.h>

/* GSL returns its error codes instead of aborting. */
void pm_gsl_quiet(void);
const char *pm_gsl_version(void);
/* HDF5 keeps its error stack to itself. */
void pm_h5_quiet(void);
void pm_h5_version(char *text, size_t size);
void pm_suitesparse_version(char *text, size_t size);
/* CRC32 of zlib: crc of the bytes so far (start with 0) and n more. */
unsigned long pm_crc32(unsigned long crc, const void *bytes, size_t n);
const char *pm_zlib_version(void);

#endif
