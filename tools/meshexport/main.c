#include <string.h>

#include "tools/meshexport/meshexport.h"

static const struct pm_option options[] = {
    {"pressure", 'p', "P1,P2,..",
     "chamber pressures as ratios p/mu (default: those of the state, which needs its element "
     "then)"},
    {"steps", 's', "N", "apply the load in at least N increments (default 1)"},
    {"compare", 'c', "JOB.dat",
     "print how the results of CalculiX differ from STATE.h5; write nothing"},
    {0}};

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct meshexport_opts *o = data;
    enum pm_status status = PM_OK;
    if (strcmp(name, "pressure") == 0) {
        status = pm_parse_doubles(name, value, PM_MAX_CHAMBERS, o->pressure, &o->npressure, err);
    } else if (strcmp(name, "steps") == 0) {
        status = pm_parse_long(name, value, &o->steps, err);
        if (status == PM_OK && (o->steps < 1 || o->steps > 10000))
            status =
                pm_fail(err, PM_USAGE, "option --steps: found %ld, expected 1 to 10000", o->steps);
    } else {
        o->compare = value;
    }
    return status;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return meshexport_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "meshexport",
        .operands = "STATE.h5 | MESH.h5",
        .summary = "the problem of a state or mesh as an input deck of CalculiX",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
        .output_optional = 1,
        .option = option,
        .run = run};
    struct meshexport_opts opts = {.steps = 1};
    return pm_tool_main(&tool, argc, argv, &opts);
}
