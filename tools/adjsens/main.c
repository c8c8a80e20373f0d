#include <string.h>

#include "tools/adjsens/adjsens.h"

static const struct pm_option options[] = {
    {"check", 'c', NULL,
     "compare with differences of the whole computation in three random directions"},
    {"seed", 's', "N", "of the random directions of --check (default 1)"},
    {"radius", 'R', "MM",
     "largest displacement of a control point in the differences (default 0.02)"},
    {0}};

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct adjsens_opts *o = data;
    if (strcmp(name, "seed") == 0)
        return pm_parse_long(name, value, &o->seed, err);
    if (strcmp(name, "radius") == 0) {
        enum pm_status status = pm_parse_double(name, value, &o->radius, err);
        if (status == PM_OK && !(o->radius > 0.0))
            status = pm_fail(err, PM_USAGE, "option --radius: found %s, expected a positive length",
                             value);
        return status;
    }
    o->check = 1;
    return PM_OK;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return adjsens_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {.name = "adjsens",
                                        .operands = "STATE.h5 WORK.h5",
                                        .summary =
                                            "gradient of the workspace measure at one Gauss point",
                                        .options = options,
                                        .min_operands = 2,
                                        .max_operands = 2,
                                        .option = option,
                                        .run = run};
    struct adjsens_opts opts = {.seed = 1, .radius = 0.02};
    return pm_tool_main(&tool, argc, argv, &opts);
}
