#include "tools/surfgen/surfgen.h"

static const struct pm_option OPTIONS[] = {{0}};

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    (void)opts;
    return surfgen_run(common, err);
}

int main(int argc, char **argv)
{
    const struct pm_tool tool = {
        .name = "surfgen",
        .operands = "CASE.ini",
        .summary = "initial surfaces of a design case",
        .options = OPTIONS,
        .min_operands = 1,
        .max_operands = 1,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, NULL);
}
