/* Messages to stderr by verbosity, and a one-line progress on a terminal. */
#ifndef PM_LOG_H
#define PM_LOG_H

/* -1 quiet, 0 normal (warnings), 1 -v (summary), 2 -vv (details). Set once by the tool frame. */
void pm_log_set(const char *tool, int verbosity);
void pm_log(int level, const char *format, ...) __attribute__((format(printf, 2, 3)));
void pm_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Live progress: overwrites its line, only when stderr is a terminal and verbosity >= 0; "" clears
 * it. */
void pm_progress(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Monotonic wall clock [s]. */
double pm_seconds(void);

#endif
