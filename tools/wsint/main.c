#include <string.h>

#include "tools/wsint/wsint.h"

static const struct pm_option OPTIONS[] = {
    {"measure", 0, "NAME", "2T, 3T, 1R2T, 2R, 3R, 3R3T or manifold instead of the case's measure"},
    {"form", 0, "FORM", "boundary or volume instead of the case's form"},
    {"sign-from", 0, "WORK.h5", "take the orientation of the first design from this file"},
    {"per-axis", 0, "M", "Gauss points per axis instead of the case's"},
    {"full", 0, NULL, "use no symmetry of the case"},
    {"dense", 0, NULL,
     "from paths over the boundary of the actuation box: measure and its surface"},
    {"boundary", 0, "INTERVAL", "print those pressures of CASE.ini, a line each; write nothing"},
    {"points", 0, NULL, "print the Gauss set of CASE.ini, tab separated; write nothing"},
    {"show", 0, NULL, "print the result of a work or workspace file; write nothing"},
    {"record-failure", 0, NULL, "a failed state gives a work file that says so"},
    {0},
};

static enum pm_status take_count(const char *name, const char *value, long *out, struct pm_err *err)
{
    const enum pm_status status = pm_parse_long(name, value, out, err);
    if (status == PM_OK && *out < 1)
        return pm_fail(err, PM_USAGE, "option '--%s': found %ld, expected at least 1", name, *out);
    return status;
}

static enum pm_status take_interval(const char *name, const char *value, double *out,
                                    struct pm_err *err)
{
    const enum pm_status status = pm_parse_double(name, value, out, err);
    if (status == PM_OK && !(*out > 0))
        return pm_fail(err, PM_USAGE, "option '--%s': found %g, expected more than 0", name, *out);
    return status;
}

static enum pm_status take(void *opts, const char *name, const char *value, struct pm_err *err)
{
    struct wsint_opts *o = opts;
    if (strcmp(name, "measure") == 0)
        o->measure = value;
    else if (strcmp(name, "form") == 0)
        o->form = value;
    else if (strcmp(name, "sign-from") == 0)
        o->sign_from = value;
    else if (strcmp(name, "points") == 0)
        o->points = 1;
    else if (strcmp(name, "show") == 0)
        o->show = 1;
    else if (strcmp(name, "full") == 0)
        o->full = 1;
    else if (strcmp(name, "dense") == 0)
        o->dense = 1;
    else if (strcmp(name, "per-axis") == 0)
        return take_count(name, value, &o->per_axis, err);
    else if (strcmp(name, "boundary") == 0)
        return take_interval(name, value, &o->boundary, err);
    else
        o->record_failure = 1;
    return PM_OK;
}

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    return wsint_run(opts, common, err);
}

int main(int argc, char **argv)
{
    struct wsint_opts opts = {0};
    const struct pm_tool tool = {
        .name = "wsint",
        .operands = "STATE.h5.. | PATH.h5.. | CASE.ini | WORK.h5",
        .summary = "workspace measure and its derivatives from the equilibria at the Gauss points",
        .options = OPTIONS,
        .min_operands = 1,
        .max_operands = -1,
        .output_optional = 1,
        .option = take,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, &opts);
}
