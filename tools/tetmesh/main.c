#include <string.h>

#include "tools/tetmesh/tetmesh.h"

static const struct pm_option options[] = {
    {"size", 's', "MM", "wanted edge length (default: of the case)"},
    {"previous", 'p', "MESH.h5", "morph this mesh while its elements bear it"},
    {"record-failure", 'r', NULL,
     "where the surfaces cannot be meshed, write a mesh file that says why"},
    {"timeout", 't', "S", "give up a run of the mesher after this many seconds"},
    {0}};

static enum pm_status positive(const char *name, const char *value, double *out, struct pm_err *err)
{
    const enum pm_status status = pm_parse_double(name, value, out, err);
    if (status == PM_OK && !(*out > 0))
        return pm_fail(err, PM_USAGE, "option --%s: found %s, expected a number > 0", name, value);
    return status;
}

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct tetmesh_opts *o = data;
    if (strcmp(name, "size") == 0)
        return positive(name, value, &o->size, err);
    if (strcmp(name, "timeout") == 0)
        return positive(name, value, &o->timeout, err);
    if (strcmp(name, "previous") == 0)
        o->previous = value;
    else
        o->record_failure = 1;
    return PM_OK;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return tetmesh_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "tetmesh",
        .operands = "SURF.h5",
        .summary = "volume mesh of curved 10-node tetrahedra between the surfaces",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
        .option = option,
        .run = run};
    struct tetmesh_opts opts = {0};
    return pm_tool_main(&tool, argc, argv, &opts);
}
