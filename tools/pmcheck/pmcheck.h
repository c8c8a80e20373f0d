/* pmcheck: is a file what its kind promises, and what made it? */
#ifndef PM_PMCHECK_H
#define PM_PMCHECK_H

#include "common/base/tool.h"

struct pmcheck_opts {
    int history; /* print the commands of the ancestors too */
};

/* Reads every operand whole: all items of the schema and the record itself; prints to stdout what
 * it is and what made it, or what is wrong. PM_INPUT where one is not valid: all are looked at. */
enum pm_status pmcheck_run(const struct pmcheck_opts *opts, const struct pm_common *common,
                           struct pm_err *err);

#endif
