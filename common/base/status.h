/* Status and errors: every function that can fail returns enum pm_status and takes struct pm_err
 * last. */
#ifndef PM_STATUS_H
#define PM_STATUS_H

/* The values are the exit statuses of every tool. */
enum pm_status {
    PM_OK = 0,
    PM_SYSTEM = 1,  /* operating system or library */
    PM_USAGE = 2,   /* command line */
    PM_INPUT = 3,   /* contents of a file */
    PM_NUMERIC = 4, /* numerical failure */
};

struct pm_err {
    enum pm_status status;
    char text[512];
};

/* Records the failure in err (the first one wins) and returns status. */
enum pm_status pm_fail(struct pm_err *err, enum pm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Passes a failure on to the one exit label of a function: needs `enum pm_status status` and
 * `done:`. */
#define PM_TRY(call)                                                                               \
    do {                                                                                           \
        status = (call);                                                                           \
        if (status != PM_OK)                                                                       \
            goto done;                                                                             \
    } while (0)

#endif
