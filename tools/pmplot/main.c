#include <string.h>

#include "tools/pmplot/pmplot.h"

static const struct pm_option OPTIONS[] = {
    {"accepted", 0, NULL, "of a step file plot the accepted design, not the proposed one"},
    {"y", 0, "MM", "plane of the section (default 0)"},
    {0},
};

static enum pm_status take(void *opts, const char *name, const char *value, struct pm_err *err)
{
    struct pmplot_opts *o = opts;
    if (strcmp(name, "y") == 0)
        return pm_parse_double(name, value, &o->y, err);
    o->accepted = 1;
    return PM_OK;
}

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    return pmplot_run(opts, common, err);
}

int main(int argc, char **argv)
{
    struct pmplot_opts opts = {0};
    const struct pm_tool tool = {
        .name = "pmplot",
        .operands = "surface|section|deformed|path|boundary|workspace FILE.h5..",
        .summary = "tables of shapes, deformed bodies and workspaces for plotting programs",
        .options = OPTIONS,
        .min_operands = 2,
        .max_operands = -1,
        .output_optional = 1,
        .option = take,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, &opts);
}
