#include <string.h>

#include "tools/invkin/invkin.h"

static const struct pm_option options[] = {
    {"target", 't', "U1,U2,..", "the wanted components of the pose [mm, rad]"},
    {"targets", 'T', "FILE", "targets of FILE, one a line, each from the nearest pose so far"},
    {"dofs", 'd', "1,3,..", "which components, out of 1..6 (default: those of the case)"},
    {"bounds", 'b', "LOW,HIGH", "bounds of the pressures p/mu (default: those of the case)"},
    {"length", 'l', "MM", "length that weighs a radian (default 57.3: a degree as 1 mm)"},
    {"tolerance", 'a', "T", "reached within T mm and T degrees (default 0.01)"},
    {"most", 'm', "N", "equilibria per target (default 40)"},
    {"guess", 'g', "STATE.h5", "start from this state; repeated: the nearest in pose"},
    {"element", 'e', "NAME", "finite element, as fesolve"},
    {"threads", 'j', "N", "threads of the factorisations (default 1)"},
    {"table", 0, NULL, "print a line a target, tab separated"},
    {"record-failure", 'r', NULL, "write the nearest pose of --target where it is not reached"},
    {0}};

static enum pm_status take_dofs(struct invkin_opts *o, const char *value, struct pm_err *err)
{
    double list[6];
    int n, last = 0;
    enum pm_status status = pm_parse_doubles("dofs", value, 6, list, &n, err);
    for (int i = 0; i < n && status == PM_OK; i++) {
        if (!(list[i] > last && list[i] <= 6.0 && list[i] == (double)(int)list[i]))
            return pm_fail(err, PM_USAGE,
                           "option --dofs: found '%s', expected ascending numbers out of 1..6",
                           value);
        last = (int)list[i];
        o->dof[i] = last - 1;
    }
    o->ndof = n;
    return status;
}

static enum pm_status take_positive(const char *name, const char *value, double *out,
                                    struct pm_err *err)
{
    enum pm_status status = pm_parse_double(name, value, out, err);
    if (status == PM_OK && !(*out > 0.0))
        status = pm_fail(err, PM_USAGE, "option --%s: found %s, expected more than 0", name, value);
    return status;
}

static enum pm_status take_count(const char *name, const char *value, long most, long *out,
                                 struct pm_err *err)
{
    enum pm_status status = pm_parse_long(name, value, out, err);
    if (status == PM_OK && (*out < 1 || *out > most))
        status =
            pm_fail(err, PM_USAGE, "option --%s: found %s, expected 1 to %ld", name, value, most);
    return status;
}

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    struct invkin_opts *o = data;
    enum pm_status status = PM_OK;
    if (strcmp(name, "target") == 0)
        status = pm_parse_doubles(name, value, 6, o->target, &o->ntarget, err);
    else if (strcmp(name, "targets") == 0)
        o->targets = value;
    else if (strcmp(name, "dofs") == 0)
        status = take_dofs(o, value, err);
    else if (strcmp(name, "bounds") == 0) {
        status = pm_parse_doubles(name, value, 2, o->bounds, &o->nbounds, err);
        if (status == PM_OK && (o->nbounds != 2 || !(o->bounds[0] < o->bounds[1])))
            status =
                pm_fail(err, PM_USAGE, "option --bounds: found '%s', expected LOW,HIGH", value);
    } else if (strcmp(name, "length") == 0)
        status = take_positive(name, value, &o->length, err);
    else if (strcmp(name, "tolerance") == 0)
        status = take_positive(name, value, &o->tolerance, err);
    else if (strcmp(name, "most") == 0)
        status = take_count(name, value, 10000, &o->most, err);
    else if (strcmp(name, "threads") == 0)
        status = take_count(name, value, 256, &o->threads, err);
    else if (strcmp(name, "guess") == 0) {
        if (o->nguess == INVKIN_MOST_GUESSES)
            return pm_fail(err, PM_USAGE, "option --guess: more than %d files",
                           INVKIN_MOST_GUESSES);
        o->guess[o->nguess++] = value;
    } else if (strcmp(name, "element") == 0)
        o->element = value;
    else if (strcmp(name, "table") == 0)
        o->table = 1;
    else
        o->record_failure = 1;
    return status;
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    return invkin_run(data, common, err);
}

int main(int argc, char **argv)
{
    static const struct pm_tool tool = {
        .name = "invkin",
        .operands = "MESH.h5",
        .summary = "chamber pressures for wanted poses of the end-effector",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
        .option = option,
        .run = run};
    struct invkin_opts opts = {.length = 57.295779513082323,
                               .tolerance = 0.01,
                               .most = 40,
                               .residual = 1e-8,
                               .threads = 1};
    return pm_tool_main(&tool, argc, argv, &opts);
}
