#include <string.h>

#include "tools/fesolve/fesolve.h"

static const struct pm_option options[] = {
    {"load", 'l', "G", "solve at point G (from 0) of the Gauss set of the case"},
    {"form", 'F', "NAME", "Gauss set: boundary or volume (default: the form of the case)"},
    {"pressure", 'p', "P1,P2,..", "solve at these chamber pressures, as ratios p/mu"},
    {"path", 'P', "FILE", "solve at the pressures of FILE, one point a line, each from the last"},
    {"guess", 'g', "STATE.h5",
     "start from this state, also of another mesh; repeated: the nearest in pressure"},
    {"limit", 0, NULL, "find the limit pressures between zero and those of --load or --pressure"},
    {"element", 'e', "NAME",
     "tet10-blend (default; of a linear mesh tet4), tet10, tet10-mean, tet4 or tet15"},
    {"material", 0, "NAME", "another material than the mesh says: a preset of pneumorph-case(5)"},
    {"law", 0, "NAME", "another material: its law"},
    {"parameters", 0, "C1,C2,..", "parameters of --law, in the order of pneumorph-case(5)"},
    {"kappa", 0, "MPA", "another bulk modulus (default with another material: 100 mu)"},
    {"tolerance", 't', "T", "residual / pressure load at the solution (default 1e-8)"},
    {"threads", 'j', "N",
     "threads of the factorisations (default 1: several processes beside each other are faster)"},
    {"record-failure", 'r', NULL,
     "where there is no stable equilibrium, write a file that says why"},
    {0}};

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct fesolve_opts *o = data;
    int taken;
    enum pm_status status = pm_material_option(&o->material, name, value, &taken, err);
    if (taken)
        return status;
    if (strcmp(name, "load") == 0) {
        o->have_load = 1;
        status = pm_parse_long(name, value, &o->load, err);
    } else if (strcmp(name, "form") == 0) {
        o->have_form = 1;
        o->form = strcmp(value, "volume") == 0 ? PM_FORM_VOLUME : PM_FORM_BOUNDARY;
        if (strcmp(value, "volume") != 0 && strcmp(value, "boundary") != 0)
            status = pm_fail(err, PM_USAGE,
                             "option --form: found '%s', expected boundary or volume", value);
    } else if (strcmp(name, "pressure") == 0) {
        status = pm_parse_doubles(name, value, PM_MAX_CHAMBERS, o->pressure, &o->npressure, err);
    } else if (strcmp(name, "path") == 0) {
        o->path = value;
    } else if (strcmp(name, "guess") == 0) {
        if (o->nguess == FESOLVE_MOST_GUESSES)
            return pm_fail(err, PM_USAGE, "option --guess: more than %d files",
                           FESOLVE_MOST_GUESSES);
        o->guess[o->nguess++] = value;
    } else if (strcmp(name, "threads") == 0) {
        status = pm_parse_long(name, value, &o->threads, err);
        if (status == PM_OK && (o->threads < 1 || o->threads > 256))
            status = pm_fail(err, PM_USAGE, "option --threads: found %s, expected 1 to 256", value);
    } else if (strcmp(name, "limit") == 0) {
        o->limit = 1;
    } else if (strcmp(name, "element") == 0) {
        o->element = value;
    } else if (strcmp(name, "tolerance") == 0) {
        status = pm_parse_double(name, value, &o->tolerance, err);
        if (status == PM_OK && !(o->tolerance > 0.0 && o->tolerance < 1.0))
            status = pm_fail(err, PM_USAGE,
                             "option --tolerance: found %s, expected a number in (0, 1)", value);
    } else {
        o->record_failure = 1;
    }
    return status;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return fesolve_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {.name = "fesolve",
                                        .operands = "MESH.h5",
                                        .summary =
                                            "stable static equilibrium of a soft robot at one load",
                                        .options = options,
                                        .min_operands = 1,
                                        .max_operands = 1,
                                        .option = option,
                                        .run = run};
    struct fesolve_opts opts = {.tolerance = 1e-8, .threads = 1};
    return pm_tool_main(&tool, argc, argv, &opts);
}
