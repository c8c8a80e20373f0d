/* The frame of a command line tool: options, help, version, messages, exit status. */
#ifndef PM_TOOL_H
#define PM_TOOL_H

#include "common/base/status.h"

/* One option of a tool. The common ones (-o -h -V -v -q) are added by the frame. */
struct pm_option {
    const char *name; /* long name without dashes */
    int letter;       /* short letter or 0 */
    const char *arg;  /* name of its argument in the help, NULL for a flag */
    const char *help;
};

struct pm_common {
    const char
        *output;   /* -o FILE, NULL if not given (the frame refuses that unless output_optional) */
    int verbosity; /* -q -1, 0, -v 1, -vv 2 */
    int noperands;
    char **operands;
    const char *tool;    /* name */
    const char *command; /* command line for provenance: base names of files, no absolute paths */
};

struct pm_tool {
    const char *name;
    const char *operands; /* as in the synopsis, e.g. "MESH.h5" */
    const char *summary;
    const struct pm_option *options; /* ends with a NULL name */
    int min_operands, max_operands;  /* max < 0: any number */
    int output_optional;
    /* Takes one option by long name; value is NULL for a flag. PM_USAGE with a message if unusable.
     */
    enum pm_status (*option)(void *opts, const char *name, const char *value, struct pm_err *err);
    enum pm_status (*run)(void *opts, const struct pm_common *common, struct pm_err *err);
};

/* Parses, runs, prints `name: message` to stderr on failure, returns the exit status. Also restarts
 * the process once with OMP_THREAD_LIMIT=1 and OPENBLAS_NUM_THREADS=1 where they are not set (both
 * are read at process start only), turns the GSL and HDF5 error printers off through their
 * wrappers. */
int pm_tool_main(const struct pm_tool *tool, int argc, char **argv, void *opts);

/* Whole-string numbers; PM_USAGE naming the option otherwise. Lists: "a,b,c", at most max, *n
 * found. */
enum pm_status pm_parse_double(const char *name, const char *text, double *out, struct pm_err *err);
enum pm_status pm_parse_long(const char *name, const char *text, long *out, struct pm_err *err);
enum pm_status pm_parse_doubles(const char *name, const char *text, int max, double *out, int *n,
                                struct pm_err *err);

#endif
