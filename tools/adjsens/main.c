#include <string.h>

#include "tools/adjsens/adjsens.h"

static const struct pm_option options[] = {
    {"form", 'f', "NAME", "of the shape derivative: domain (default) or boundary"},
    {"each", 'e', NULL,
     "derivatives of every U, J, chamber volume and compliance by control points"},
    {"nodal", 'n', NULL, "the same by the reference positions of all nodes, imported meshes too"},
    {"check", 'c', NULL,
     "compare with differences of the whole computation in three random directions"},
    {"points", 'p', "N", "--check: also N random control points of each surface, one by one"},
    {"seed", 's', "N", "of the random directions of --check (default 1)"},
    {"radius", 'R', "MM",
     "largest displacement of a control point in the differences (default 0.02)"},
    {0}};

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct adjsens_opts *o = data;
    enum pm_status status = PM_OK;
    if (strcmp(name, "seed") == 0)
        return pm_parse_long(name, value, &o->seed, err);
    if (strcmp(name, "form") == 0) {
        o->form = strcmp(value, "boundary") == 0 ? PM_SHAPE_BOUNDARY : PM_SHAPE_DOMAIN;
        if (o->form == PM_SHAPE_DOMAIN && strcmp(value, "domain") != 0)
            status = pm_fail(err, PM_USAGE, "option --form: found %s, expected domain or boundary",
                             value);
    } else if (strcmp(name, "points") == 0) {
        status = pm_parse_long(name, value, &o->points, err);
        if (status == PM_OK && o->points < 0)
            status =
                pm_fail(err, PM_USAGE, "option --points: found %s, expected at least 0", value);
    } else if (strcmp(name, "radius") == 0) {
        status = pm_parse_double(name, value, &o->radius, err);
        if (status == PM_OK && !(o->radius > 0.0))
            status = pm_fail(err, PM_USAGE, "option --radius: found %s, expected a positive length",
                             value);
    } else {
        *(strcmp(name, "each") == 0    ? &o->each
          : strcmp(name, "nodal") == 0 ? &o->nodal
                                       : &o->check) = 1;
    }
    return status;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return adjsens_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "adjsens",
        .operands = "STATE.h5 [WORK.h5]",
        .summary = "shape derivatives at one load: of the measure, of pose and Jacobian",
        .options = options,
        .min_operands = 1,
        .max_operands = 2,
        .option = option,
        .run = run};
    struct adjsens_opts opts = {.seed = 1, .radius = 0.02};
    return pm_tool_main(&tool, argc, argv, &opts);
}
