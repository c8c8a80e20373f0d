/* Output files appear whole or not at all: written under a temporary name beside the target, then
 * renamed. The frame's signal handler removes what is still open. */
#ifndef PM_ATOMIC_H
#define PM_ATOMIC_H

#include <stdio.h>

#include "common/base/status.h"

enum { PM_PATH_MAX = 4096 };

struct pm_atomic {
    char target[PM_PATH_MAX], temporary[PM_PATH_MAX];
    int slot; /* in the handler's table, -1: not begun */
};

/* Chooses and registers the temporary name; creates nothing. PM_SYSTEM where the name is too long
 * or the folder does not exist. */
enum pm_status pm_atomic_begin(struct pm_atomic *a, const char *target, struct pm_err *err);
/* Renames the closed temporary to its target. */
enum pm_status pm_atomic_commit(struct pm_atomic *a, struct pm_err *err);
/* Removes the temporary; does nothing after a commit. */
void pm_atomic_abort(struct pm_atomic *a);
/* All in one for text files: `write` fills the open temporary; whether the stream took it is seen
 * to. */
enum pm_status pm_atomic_write(const char *target,
                               enum pm_status (*write)(void *data, FILE *out, struct pm_err *err),
                               void *data, struct pm_err *err);
/* On SIGINT, SIGTERM, SIGHUP: remove the temporaries, then die of the signal. A file size limit
 * becomes a write error instead of a signal. */
void pm_atomic_guard(void);

#endif
