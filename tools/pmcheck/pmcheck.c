#include "tools/pmcheck/pmcheck.h"

#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/record.h"
#include "common/files/schema.h"
#include "common/files/sens.h"
#include "common/files/state.h"
#include "common/files/step.h"
#include "common/files/sweep.h"
#include "common/files/work.h"
#include "common/files/workspace.h"

static const char all_kinds[] = "surface mesh state path work sens step skin workspace";

/* ---- items ---- */

/* Type, shape, sizes that agree, finite numbers. */
static enum pm_status read_item(struct pm_h5 *f, const struct pm_item *item, const char *name,
                                struct pm_err *err)
{
    ptrdiff_t dims[PM_MAX_RANK];
    char *data = NULL;
    const enum pm_status status = item->type == PM_TYPE_TEXT ? pm_h5_get_text(f, name, &data, err)
                                                             : pm_h5_get(f, name, dims, &data, err);
    pm_free(data);
    return status;
}

static enum pm_status check_items(struct pm_h5 *f, const char *kind, int failed, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t n;
    const struct pm_item *item = pm_schema_items(&n);
    for (ptrdiff_t i = 0; i < n; i++) {
        const char *hole = strstr(item[i].name, "%d");
        if (!pm_schema_word_in(kind, item[i].kinds))
            continue;
        for (int k = 0; k <= (hole != NULL ? PM_MAX_CHAMBERS : 0); k++) {
            char name[128];
            if (hole == NULL)
                snprintf(name, sizeof name, "%s", item[i].name);
            else
                snprintf(name, sizeof name, "%.*s%d%s", (int)(hole - item[i].name), item[i].name, k,
                         hole + 2);
            if (pm_h5_has(f, name) || (k == 0 && item[i].required && !failed))
                PM_TRY(read_item(f, &item[i], name, err));
        }
    }
done:
    return status;
}

/* ---- records ---- */

union record {
    struct pm_surfaces surface;
    struct pm_mesh mesh;
    struct pm_state state;
    struct pm_sweep path;
    struct pm_work work;
    struct pm_sens sens;
    struct pm_step step;
    struct pm_workspace workspace;
};

/* A skin has no reader but this one. */
static enum pm_status check_skin(const char *path, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    struct pm_case c = {.text = NULL};
    ptrdiff_t dims[PM_MAX_RANK];
    double *x = NULL;
    int32_t *tri = NULL;
    PM_TRY(pm_h5_open(path, "skin", &f, err));
    PM_TRY(pm_record_get_case(f, &c, err));
    PM_TRY(pm_h5_get(f, "/skin/x", dims, &x, err));
    const ptrdiff_t nn = dims[0];
    PM_TRY(pm_h5_get(f, "/skin/tri", dims, &tri, err));
    PM_TRY(pm_check_range(f, "/skin/tri", tri, 3 * dims[0], 0, nn, err));
done:
    pm_free(x);
    pm_free(tri);
    pm_case_release(&c);
    pm_h5_close(f);
    return status;
}

static enum pm_status check_record(const char *kind, const char *path, struct pm_err *err)
{
    enum pm_status status;
    union record r;
    memset(&r, 0, sizeof r);
    if (strcmp(kind, "surface") == 0) {
        status = pm_surfaces_load(path, &r.surface, err);
        pm_surfaces_release(&r.surface);
    } else if (strcmp(kind, "mesh") == 0) {
        status = pm_mesh_load(path, 1, &r.mesh, err);
        pm_mesh_release(&r.mesh);
    } else if (strcmp(kind, "state") == 0) {
        status = pm_state_load(path, 1, &r.state, err);
        pm_state_release(&r.state);
    } else if (strcmp(kind, "path") == 0) {
        status = pm_sweep_load(path, &r.path, err);
        pm_sweep_release(&r.path);
    } else if (strcmp(kind, "work") == 0) {
        status = pm_work_load(path, 1, &r.work, err);
        pm_work_release(&r.work);
    } else if (strcmp(kind, "sens") == 0) {
        status = pm_sens_load(path, &r.sens, err);
        pm_sens_release(&r.sens);
    } else if (strcmp(kind, "step") == 0) {
        status = pm_step_load(path, &r.step, err);
        pm_step_release(&r.step);
    } else if (strcmp(kind, "workspace") == 0) {
        status = pm_workspace_load(path, &r.workspace, err);
        pm_workspace_release(&r.workspace);
    } else {
        status = check_skin(path, err);
    }
    return status;
}

/* ---- one file ---- */

struct origin {
    char *kind, *tool, *version, *command, *inputs, *history, *failure;
};

static enum pm_status read_origin(struct pm_h5 *f, struct origin *o, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_h5_get_attribute(f, "kind", &o->kind, err));
    PM_TRY(pm_h5_get_attribute(f, "tool", &o->tool, err));
    PM_TRY(pm_h5_get_attribute(f, "tool_version", &o->version, err));
    PM_TRY(pm_h5_get_attribute(f, "command", &o->command, err));
    PM_TRY(pm_h5_get_attribute(f, "inputs", &o->inputs, err));
    PM_TRY(pm_h5_get_attribute(f, "history", &o->history, err));
    if (pm_h5_has(f, "/failure"))
        PM_TRY(pm_h5_get_text(f, "/failure", &o->failure, err));
done:
    return status;
}

static void print_lines(const char *label, const char *text)
{
    for (const char *p = text; *p != '\0'; p += strspn(p, "\n")) {
        const int n = (int)strcspn(p, "\n");
        printf("  %s: %.*s\n", label, n, p);
        p += n;
    }
}

static enum pm_status check_file(const char *path, int history, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    struct origin o = {0};
    PM_TRY(pm_h5_open(path, all_kinds, &f, err));
    PM_TRY(read_origin(f, &o, err));
    PM_TRY(check_items(f, o.kind, o.failure != NULL, err));
    pm_h5_close(f);
    f = NULL;
    PM_TRY(check_record(o.kind, path, err));
    printf("%s: valid, %s by %s %s\n", path, o.kind, o.tool, o.version);
    if (o.failure != NULL)
        print_lines("failure", o.failure);
    if (history)
        print_lines("history", o.history);
    print_lines("command", o.command);
    print_lines("input", o.inputs);
done:
    pm_h5_close(f);
    pm_free(o.kind);
    pm_free(o.tool);
    pm_free(o.version);
    pm_free(o.command);
    pm_free(o.inputs);
    pm_free(o.history);
    pm_free(o.failure);
    return status;
}

enum pm_status pmcheck_run(const struct pmcheck_opts *opts, const struct pm_common *common,
                           struct pm_err *err)
{
    int bad = 0;
    struct pm_err first = {.status = PM_OK};
    if (common->output != NULL)
        return pm_fail(err, PM_USAGE, "what is found goes to standard output, expected no -o");
    for (int i = 0; i < common->noperands; i++) {
        struct pm_err own = {.status = PM_OK};
        if (check_file(common->operands[i], opts->history, &own) == PM_OK)
            continue;
        if (own.status == PM_SYSTEM)
            return pm_fail(err, own.status, "%s", own.text);
        printf("%s: not valid: %s\n", common->operands[i], own.text);
        if (bad++ == 0)
            first = own;
    }
    if (bad > 1)
        return pm_fail(err, PM_INPUT, "%d of %d files are not valid, the first: %.400s", bad,
                       common->noperands, first.text);
    return bad > 0 ? pm_fail(err, PM_INPUT, "%s", first.text) : PM_OK;
}
