#include <string.h>

#include "tools/tetmesh/tetmesh.h"

static const struct pm_option options[] = {
    {"size", 's', "MM", "wanted edge length (default: of the case)"},
    {"crest", 'c', "R", "edges over the radius of curvature, at most (default: of the case)"},
    {"layers", 'l', "N", "edges through a wall, at least (default: of the case)"},
    {"previous", 'p', "MESH.h5", "morph this mesh while its elements bear it"},
    {"keep-mesh", 'k', NULL, "with --previous: fail where its elements do not bear it"},
    {"record-failure", 'r', NULL,
     "where the surfaces cannot be meshed, write a mesh file that says why"},
    {"symmetry", 'y', "auto|none",
     "auto: the part of the body on one side of its mirror planes (default); none: all of it"},
    {"timeout", 't', "S", "give up a run of the mesher after this many seconds"},
    {"import", 'i', "FILE.msh", "take this gmsh file instead of surfaces"},
    {"promote", 0, NULL, "import: give 4-node tetrahedra 10 nodes, with straight edges"},
    {"reference", 0, "X,Y,Z",
     "import: reference point of the end-effector (default: centroid of the tip)"},
    {"case", 0, "CASE.ini", "import: case with the material"},
    {"material", 0, "NAME", "import: a preset of pneumorph-case(5), instead of --case"},
    {"law", 0, "NAME", "import: law of the material, instead of --case"},
    {"parameters", 0, "C1,C2,..", "import: parameters of --law, in the order of pneumorph-case(5)"},
    {"mu", 0, "MPA", "import: shear modulus of a neo-Hookean solid, instead of --case"},
    {"kappa", 0, "MPA", "import: bulk modulus (default: 100 mu)"},
    {0}};

static enum pm_status positive(const char *name, const char *value, double *out, struct pm_err *err)
{
    const enum pm_status status = pm_parse_double(name, value, out, err);
    if (status == PM_OK && !(*out > 0))
        return pm_fail(err, PM_USAGE, "option --%s: found %s, expected a number > 0", name, value);
    return status;
}

static enum pm_status reference(const char *name, const char *value, struct tetmesh_opts *o,
                                struct pm_err *err)
{
    const enum pm_status status =
        pm_parse_doubles(name, value, 3, o->reference, &o->have_reference, err);
    if (status == PM_OK && o->have_reference != 3)
        return pm_fail(err, PM_USAGE, "option --%s: found '%s', expected X,Y,Z", name, value);
    return status;
}

static enum pm_status symmetry(const char *name, const char *value, struct tetmesh_opts *o,
                               struct pm_err *err)
{
    o->whole = strcmp(value, "none") == 0;
    if (!o->whole && strcmp(value, "auto") != 0)
        return pm_fail(err, PM_USAGE, "option --%s: found '%s', expected auto or none", name,
                       value);
    return PM_OK;
}

static enum pm_status layers(const char *name, const char *value, struct tetmesh_opts *o,
                             struct pm_err *err)
{
    const enum pm_status status = pm_parse_long(name, value, &o->layers, err);
    if (status == PM_OK && o->layers < 0)
        return pm_fail(err, PM_USAGE, "option --%s: found %s, expected a number >= 0", name, value);
    return status;
}

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct tetmesh_opts *o = data;
    const struct {
        const char *name;
        double *number;
        const char **text;
        int *flag;
    } simple[] = {{"size", &o->size, NULL, NULL},
                  {"crest", &o->crest, NULL, NULL},
                  {"timeout", &o->timeout, NULL, NULL},
                  {"mu", &o->mu, NULL, NULL},
                  {"previous", NULL, &o->previous, NULL},
                  {"import", NULL, &o->import, NULL},
                  {"case", NULL, &o->case_file, NULL},
                  {"promote", NULL, NULL, &o->promote},
                  {"record-failure", NULL, NULL, &o->record_failure},
                  {"keep-mesh", NULL, NULL, &o->keep_mesh}};
    for (size_t k = 0; k < sizeof simple / sizeof simple[0]; k++) {
        if (strcmp(name, simple[k].name) != 0)
            continue;
        if (simple[k].number != NULL)
            return positive(name, value, simple[k].number, err);
        if (simple[k].text != NULL)
            *simple[k].text = value;
        else if (simple[k].flag != NULL)
            *simple[k].flag = 1;
        return PM_OK;
    }
    if (strcmp(name, "layers") == 0)
        return layers(name, value, o, err);
    if (strcmp(name, "symmetry") == 0)
        return symmetry(name, value, o, err);
    int taken;
    const enum pm_status status = pm_material_option(&o->material, name, value, &taken, err);
    return taken ? status : reference(name, value, o, err);
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return tetmesh_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "tetmesh",
        .operands = "[SURF.h5]",
        .summary = "volume mesh of curved 10-node tetrahedra between the surfaces",
        .options = options,
        .min_operands = 0,
        .max_operands = 1,
        .option = option,
        .run = run};
    struct tetmesh_opts opts = {.layers = -1};
    return pm_tool_main(&tool, argc, argv, &opts);
}
