#include <string.h>

#include "tools/surfremesh/surfremesh.h"

static const struct pm_option OPTIONS[] = {
    {"spacing", 0, "MM",
     "spacing of the chambers' control points (default: the case's, and only where needed)"},
    {"points", 0, "N", "control points per chamber instead"},
    {"alpha", 0, "A", "regularisation of the fit (default 0.1)"},
    {"iterations", 0, "K", "of the fit, 1 is the plain one (default 20)"},
    {"or-keep", 0, NULL,
     "where the result is not acceptable, write the surfaces unchanged and say why"},
    {0},
};

static enum pm_status take(void *opts, const char *name, const char *value, struct pm_err *err)
{
    struct surfremesh_opts *o = opts;
    enum pm_status status = PM_OK;

    if (strcmp(name, "or-keep") == 0)
        o->or_keep = 1;
    else if (strcmp(name, "spacing") == 0)
        status = pm_parse_double(name, value, &o->spacing, err);
    else if (strcmp(name, "alpha") == 0)
        status = pm_parse_double(name, value, &o->alpha, err);
    else if (strcmp(name, "points") == 0)
        status = pm_parse_long(name, value, &o->points, err);
    else
        status = pm_parse_long(name, value, &o->iterations, err);
    if (status == PM_OK && (o->spacing < 0 || o->alpha <= 0 || o->points < 0 || o->iterations < 1))
        status =
            pm_fail(err, PM_USAGE, "option --%s is '%s', expected a positive number", name, value);
    return status;
}

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    return surfremesh_run(opts, common, err);
}

int main(int argc, char **argv)
{
    struct surfremesh_opts opts = {.alpha = 0.1, .iterations = 20};
    const struct pm_tool tool = {
        .name = "surfremesh",
        .operands = "SURF.h5|STEP.h5",
        .summary =
            "spread the control points of surfaces evenly, leaving the surfaces where they are",
        .options = OPTIONS,
        .min_operands = 1,
        .max_operands = 1,
        .option = take,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, &opts);
}
