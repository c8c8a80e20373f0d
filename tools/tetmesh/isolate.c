#include "tools/tetmesh/isolate.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/log.h"
#include "common/base/memory.h"

struct header {
    struct pm_err err;
    ptrdiff_t bytes[PM_MAX_BLOBS];
};

void pm_blobs_release(struct pm_blob out[PM_MAX_BLOBS])
{
    for (int k = 0; k < PM_MAX_BLOBS; k++) {
        pm_free(out[k].data);
        out[k] = (struct pm_blob){0};
    }
}

static int write_all(int fd, const void *data, ptrdiff_t bytes)
{
    const char *p = data;
    while (bytes > 0) {
        const ssize_t n = write(fd, p, (size_t)bytes);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return -1;
        p += n;
        bytes -= n;
    }
    return 0;
}

static void child(enum pm_status (*job)(const void *arg, struct pm_blob *out, struct pm_err *err),
                  const void *arg, int fd)
{
    struct pm_blob out[PM_MAX_BLOBS] = {{0}};
    struct header h = {.err = {.status = PM_OK}};
    const int null = open("/dev/null", O_WRONLY);
    if (null < 0 || dup2(null, 1) < 0 || dup2(null, 2) < 0)
        _exit(1);
    h.err.status = job(arg, out, &h.err);
    for (int k = 0; k < PM_MAX_BLOBS; k++)
        h.bytes[k] = h.err.status == PM_OK ? out[k].bytes : 0;
    int failed = write_all(fd, &h, sizeof h);
    for (int k = 0; k < PM_MAX_BLOBS && !failed; k++)
        failed = write_all(fd, out[k].data, h.bytes[k]);
    _exit(failed ? 1 : 0);
}

enum outcome { GOT_ALL, GOT_END, GOT_LATE };

/* Reads `bytes` bytes; GOT_END if the child ends before, GOT_LATE at the deadline. */
static enum outcome read_all(int fd, void *data, ptrdiff_t bytes, double deadline)
{
    char *p = data;
    while (bytes > 0) {
        const double left = deadline - pm_seconds();
        struct pollfd pfd = {.fd = fd, .events = POLLIN};
        if (left <= 0)
            return GOT_LATE;
        const int ready = poll(&pfd, 1, left > 1e5 ? -1 : (int)(1e3 * left) + 1);
        if (ready == 0 || (ready < 0 && errno == EINTR))
            continue;
        const ssize_t n = ready < 0 ? -1 : read(fd, p, (size_t)bytes);
        if (n <= 0)
            return GOT_END;
        p += n;
        bytes -= n;
    }
    return GOT_ALL;
}

static enum pm_status receive(int fd, double deadline, struct pm_blob out[PM_MAX_BLOBS],
                              enum outcome *outcome, struct pm_err *err)
{
    struct header h = {.err = {.status = PM_OK}};
    *outcome = read_all(fd, &h, sizeof h, deadline);
    if (*outcome != GOT_ALL)
        return PM_NUMERIC;
    if (h.err.status != PM_OK)
        return pm_fail(err, h.err.status, "%s", h.err.text);
    for (int k = 0; k < PM_MAX_BLOBS && *outcome == GOT_ALL; k++) {
        out[k].data = pm_calloc(h.bytes[k], 1, err);
        out[k].bytes = h.bytes[k];
        if (out[k].data == NULL)
            return PM_SYSTEM;
        *outcome = read_all(fd, out[k].data, h.bytes[k], deadline);
    }
    return *outcome == GOT_ALL ? PM_OK : PM_NUMERIC;
}

enum pm_status
pm_isolate(enum pm_status (*job)(const void *arg, struct pm_blob *out, struct pm_err *err),
           const void *arg, double timeout, struct pm_blob out[PM_MAX_BLOBS], struct pm_err *err)
{
    int fd[2], how = 0;
    enum outcome outcome = GOT_ALL;
    const double deadline = timeout > 0 ? pm_seconds() + timeout : HUGE_VAL;
    memset(out, 0, PM_MAX_BLOBS * sizeof *out);
    if (pipe(fd) != 0)
        return pm_fail(err, PM_SYSTEM, "cannot make a pipe: %s", strerror(errno));
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        close(fd[0]);
        child(job, arg, fd[1]);
    }
    close(fd[1]);
    enum pm_status status =
        pid < 0 ? pm_fail(err, PM_SYSTEM, "cannot start a process: %s", strerror(errno))
                : receive(fd[0], deadline, out, &outcome, err);
    close(fd[0]);
    if (outcome == GOT_LATE) {
        kill(pid, SIGKILL);
        status = pm_fail(err, PM_NUMERIC, "the mesher did not end within %g s", timeout);
    }
    while (pid > 0 && waitpid(pid, &how, 0) < 0 && errno == EINTR)
        ;
    if (outcome == GOT_END)
        status = pm_fail(err, PM_NUMERIC, "the mesher crashed (%s %d)",
                         WIFSIGNALED(how) ? "signal" : "status",
                         WIFSIGNALED(how) ? WTERMSIG(how) : WEXITSTATUS(how));
    if (status != PM_OK)
        pm_blobs_release(out);
    return status;
}
