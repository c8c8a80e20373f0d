#include <stddef.h>

#include "tools/pmcheck/pmcheck.h"

static const struct pm_option options[] = {
    {"history", 0, NULL, "print the commands of all ancestors too"}, {0}};

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct pmcheck_opts *o = data;
    (void)name;
    (void)value;
    (void)err;
    o->history = 1;
    return PM_OK;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return pmcheck_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {.name = "pmcheck",
                                        .operands = "FILE.h5..",
                                        .summary = "is a file valid, and what made it",
                                        .options = options,
                                        .min_operands = 1,
                                        .max_operands = -1,
                                        .output_optional = 1,
                                        .option = option,
                                        .run = run};
    struct pmcheck_opts opts = {0};
    return pm_tool_main(&tool, argc, argv, &opts);
}
