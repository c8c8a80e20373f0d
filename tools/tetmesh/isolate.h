/* Runs a job in a child process: its output is silenced, its crash or endless loop becomes a
 * status. */
#ifndef PM_ISOLATE_H
#define PM_ISOLATE_H

#include <stddef.h>

#include "common/base/status.h"

enum { PM_MAX_BLOBS = 8 };

struct pm_blob {
    void *data; /* pm_free */
    ptrdiff_t bytes;
};

/* job fills out[0..PM_MAX_BLOBS-1]; its status, message and blobs come back. PM_NUMERIC where it
 * crashes or takes more than `timeout` seconds (0: no limit). */
enum pm_status
pm_isolate(enum pm_status (*job)(const void *arg, struct pm_blob *out, struct pm_err *err),
           const void *arg, double timeout, struct pm_blob out[PM_MAX_BLOBS], struct pm_err *err);
void pm_blobs_release(struct pm_blob out[PM_MAX_BLOBS]);

#endif
