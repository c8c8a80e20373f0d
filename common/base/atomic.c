#include "common/base/atomic.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { SLOTS = 8 };

/* What a signal handler may read: names complete before `used` is set, `used` cleared before reuse.
 */
static char open_name[SLOTS][PM_PATH_MAX];
static volatile sig_atomic_t open_used[SLOTS];

enum pm_status pm_atomic_begin(struct pm_atomic *a, const char *target, struct pm_err *err)
{
    a->slot = -1;
    const char *slash = strrchr(target, '/');
    int folder = slash == NULL ? 0 : (int)(slash - target) + 1;
    int length = snprintf(a->temporary, sizeof a->temporary, "%.*s.%s.%ld.tmp", folder, target,
                          target + folder, (long)getpid());
    if (length < 0 || length >= PM_PATH_MAX || target[folder] == '\0')
        return pm_fail(err, PM_SYSTEM, "cannot write '%s': not a usable file name", target);
    memcpy(a->target, target, strlen(target) + 1);
    char parent[PM_PATH_MAX];
    snprintf(parent, sizeof parent, "%.*s.", folder, target);
    if (access(parent, W_OK) != 0)
        return pm_fail(err, PM_SYSTEM, "cannot write '%s': %s", target, strerror(errno));
    for (int i = 0; i < SLOTS; i++) {
        if (!open_used[i]) {
            memcpy(open_name[i], a->temporary, sizeof a->temporary);
            open_used[i] = 1;
            a->slot = i;
            return PM_OK;
        }
    }
    return pm_fail(err, PM_SYSTEM, "cannot write '%s': more than %d files open for writing", target,
                   (int)SLOTS);
}

enum pm_status pm_atomic_commit(struct pm_atomic *a, struct pm_err *err)
{
    if (rename(a->temporary, a->target) != 0)
        return pm_fail(err, PM_SYSTEM, "cannot write '%s': %s", a->target, strerror(errno));
    open_used[a->slot] = 0;
    a->slot = -1;
    return PM_OK;
}

void pm_atomic_abort(struct pm_atomic *a)
{
    if (a->slot < 0)
        return;
    unlink(a->temporary);
    open_used[a->slot] = 0;
    a->slot = -1;
}

enum pm_status pm_atomic_write(const char *target,
                               enum pm_status (*write)(void *data, FILE *out, struct pm_err *err),
                               void *data, struct pm_err *err)
{
    enum pm_status status;
    struct pm_atomic file = {.slot = -1};
    FILE *out = NULL;
    int failed;
    PM_TRY(pm_atomic_begin(&file, target, err));
    out = fopen(file.temporary, "wb");
    if (out == NULL)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot write '%s': %s", target, strerror(errno)));
    PM_TRY(write(data, out, err));
    failed = ferror(out);
    failed |= fclose(out);
    out = NULL;
    if (failed)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot write '%s': %s", target, strerror(errno)));
    status = pm_atomic_commit(&file, err);
done:
    if (out != NULL)
        fclose(out);
    pm_atomic_abort(&file);
    return status;
}

static void on_signal(int number)
{
    for (int i = 0; i < SLOTS; i++)
        if (open_used[i])
            unlink(open_name[i]);
    /* SA_RESETHAND restored the default action: the status tells the caller which signal it was. */
    raise(number);
}

void pm_atomic_guard(void)
{
    static const int fatal[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof fatal / sizeof fatal[0]; i++) {
        struct sigaction old;
        if (sigaction(fatal[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)
            sigaction(fatal[i], &action, NULL);
    }
    signal(SIGXFSZ, SIG_IGN);
}
