#include "common/base/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

/* One process, one tool: what the frame set at start. */
static const char *log_tool = "pneumorph";
static int log_verbosity;
static int progress_shown;

void pm_log_set(const char *tool, int verbosity)
{
    log_tool = tool;
    log_verbosity = verbosity;
}

static void clear_progress(void)
{
    if (progress_shown)
        fputs("\r\033[K", stderr);
    progress_shown = 0;
}

void pm_log(int level, const char *format, ...)
{
    if (log_verbosity < level)
        return;
    clear_progress();
    va_list args;
    va_start(args, format);
    fprintf(stderr, "%s: ", log_tool);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
}

void pm_warn(const char *format, ...)
{
    if (log_verbosity < 0)
        return;
    clear_progress();
    va_list args;
    va_start(args, format);
    fprintf(stderr, "%s: warning: ", log_tool);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
}

void pm_progress(const char *format, ...)
{
    if (log_verbosity < 0 || !isatty(STDERR_FILENO))
        return;
    clear_progress();
    if (format[0] == '\0')
        return;
    va_list args;
    va_start(args, format);
    fprintf(stderr, "%s: ", log_tool);
    vfprintf(stderr, format, args);
    va_end(args);
    fflush(stderr);
    progress_shown = 1;
}

double pm_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
