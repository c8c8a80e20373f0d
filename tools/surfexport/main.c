#include <string.h>

#include "tools/surfexport/surfexport.h"

static const struct pm_option options[] = {
    {"what", 'w', "PART",
     "body (default), exterior, chambers, chamberN, mould1, mould2, coreN or plate"},
    {"size", 's', "MM", "longest edges (default: of the case's mesh)"},
    {"tolerance", 't', "MM", "largest distance of surfaces and triangles (default 0.1)"},
    {"ascii", 0, NULL, "STL as text"},
    {"accepted", 0, NULL, "of a step file take the accepted design, not the proposed one"},
    {"pull", 0, "AXIS", "mould: axis along which the halves part, x or y (default y)"},
    {"mould-wall", 0, "MM", "mould: thickness around the body (default 8)"},
    {"clearance", 0, "MM", "mould: gap around pins, prints and halves (default 0.2)"},
    {"print-diameter", 0, "MM", "core: diameter of the print, 0: none (default 4)"},
    {0}};

static enum pm_status number(const char *name, const char *value, int zero, double *out,
                             struct pm_err *err)
{
    const enum pm_status status = pm_parse_double(name, value, out, err);
    if (status == PM_OK && !(zero ? *out >= 0 : *out > 0))
        return pm_fail(err, PM_USAGE, "option --%s: found %s, expected a number %s 0", name, value,
                       zero ? ">=" : ">");
    return status;
}

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct surfexport_opts *o = data;
    const struct {
        const char *name;
        double *number;
        int zero;
    } numbers[] = {{"size", &o->size, 0},
                   {"tolerance", &o->tolerance, 0},
                   {"mould-wall", &o->mould.wall, 0},
                   {"clearance", &o->mould.clearance, 1},
                   {"print-diameter", &o->mould.print, 1}};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (strcmp(name, numbers[k].name) == 0)
            return number(name, value, numbers[k].zero, numbers[k].number, err);
    if (strcmp(name, "what") == 0)
        o->what = value;
    else if (strcmp(name, "ascii") == 0)
        o->ascii = 1;
    else if (strcmp(name, "accepted") == 0)
        o->accepted = 1;
    else if (strcmp(value, "x") != 0 && strcmp(value, "y") != 0)
        return pm_fail(err, PM_USAGE, "option --pull: found '%s', expected x or y", value);
    else
        o->mould.pull = value[0] - 'x';
    return PM_OK;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return surfexport_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "surfexport",
        .operands = "SURF.h5 | STEP.h5",
        .summary = "triangles of a design for printing, meshing and viewing; moulds and cores",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
        .option = option,
        .run = run};
    struct surfexport_opts opts = {.what = "body",
                                   .tolerance = 0.1,
                                   .mould = {.pull = 1, .wall = 8, .print = 4, .clearance = 0.2}};
    return pm_tool_main(&tool, argc, argv, &opts);
}
