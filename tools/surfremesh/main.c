#include <string.h>

#include "tools/surfremesh/surfremesh.h"

static const struct pm_option OPTIONS[] = {
    {"spacing", 0, "MM",
     "spacing of the chambers' control points (default: the case's, and only where needed)"},
    {"points", 0, "N", "control points per chamber instead"},
    {"alpha", 0, "A", "regularisation of the fit (default 0.1)"},
    {"iterations", 0, "K", "of the fit, 1 is the plain one (default 20, of the paper's method 1)"},
    {"method", 0, "NAME",
     "remesh (default), conformal (new parameters always) or paper (it drifts: not judged)"},
    {"or-keep", 0, NULL,
     "where the result is not acceptable, write the surfaces unchanged and say why"},
    {0},
};

static enum pm_status take_method(const char *value, enum surfremesh_method *method,
                                  struct pm_err *err)
{
    static const char *const names[] = {[SURFREMESH_REMESH] = "remesh",
                                        [SURFREMESH_CONFORMAL] = "conformal",
                                        [SURFREMESH_PAPER] = "paper"};

    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(value, names[k]) == 0) {
            *method = (enum surfremesh_method)k;
            return PM_OK;
        }
    return pm_fail(err, PM_USAGE, "option --method is '%s', expected remesh, conformal or paper",
                   value);
}

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
    else if (strcmp(name, "method") == 0)
        status = take_method(value, &o->method, err);
    else if ((status = pm_parse_long(name, value, &o->iterations, err)) == PM_OK &&
             o->iterations < 1)
        o->iterations = -1;
    if (status == PM_OK && (o->spacing < 0 || o->alpha <= 0 || o->points < 0 || o->iterations < 0))
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
    struct surfremesh_opts opts = {.alpha = 0.1};
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
