#include <string.h>

#include "tools/surfgen/surfgen.h"

static const struct pm_option OPTIONS[] = {
    {"body", 0, "FILE", "closed surface (STL, OBJ) of a body with shape = file"},
    {"design", 0, "FILE.h5", "surfaces of a finished design (surface, step) instead of the shapes"},
    {"chamber", 0, "N=FILE", "closed surface of a chamber with shape = file; repeatable"},
    {0},
};

static enum pm_status take(void *opts, const char *name, const char *value, struct pm_err *err)
{
    struct surfgen_files *files = opts;
    const int chamber = strcmp(name, "chamber") == 0, digit = value[0] - '1';
    const char **file = strcmp(name, "design") == 0 ? &files->design : &files->body;

    if (chamber) {
        if (digit < 0 || digit >= PM_MAX_CHAMBERS || value[1] != '=' || value[2] == '\0')
            return pm_fail(err, PM_USAGE, "option --chamber is '%s', expected N=FILE, N = 1 to %d",
                           value, (int)PM_MAX_CHAMBERS);
        file = &files->chamber[digit];
    }
    if (*file != NULL)
        return pm_fail(err, PM_USAGE, "option --%s is '%s', expected once%s", name, value,
                       chamber ? " for each chamber" : "");
    *file = value + (chamber ? 2 : 0);
    return PM_OK;
}

static enum pm_status run(void *opts, const struct pm_common *common, struct pm_err *err)
{
    return surfgen_run(opts, common, err);
}

int main(int argc, char **argv)
{
    struct surfgen_files files = {0};
    const struct pm_tool tool = {
        .name = "surfgen",
        .operands = "CASE.ini",
        .summary = "initial surfaces of a design case",
        .options = OPTIONS,
        .min_operands = 1,
        .max_operands = 1,
        .option = take,
        .run = run,
    };
    return pm_tool_main(&tool, argc, argv, &files);
}
