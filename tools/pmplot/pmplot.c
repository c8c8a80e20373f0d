#include "tools/pmplot/pmplot.h"

#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/step.h"

static enum pm_status plot_surfaces(const struct pmplot_opts *opts, const char *what,
                                    const char *path, struct pm_err *err)
{
    enum pm_status status;
    struct pm_surfaces s = {0};
    struct pm_step step = {0};

    if (opts->accepted)
        PM_TRY(pm_step_load(path, &step, err));
    else
        PM_TRY(pm_surfaces_load(path, &s, err));
    const struct pm_surfaces *shown = opts->accepted ? &step.accepted : &s;
    PM_TRY(strcmp(what, "surface") == 0 ? pmplot_surface(shown, err)
                                        : pmplot_section(shown, opts->y, err));
done:
    pm_surfaces_release(&s);
    pm_step_release(&step);
    return status;
}

static enum pm_status plot_states(const char *what, char *const *paths, ptrdiff_t n,
                                  struct pm_err *err)
{
    enum pm_status status;
    struct pm_state *states = NULL;

    PM_TRY(PM_NEW(states, n, err));
    for (ptrdiff_t i = 0; i < n; i++)
        PM_TRY(pm_state_load(paths[i], 0, &states[i], err));
    if (strcmp(what, "deformed") == 0)
        pmplot_deformed(&states[0]);
    else
        PM_TRY(pmplot_workspace(states, n, err));
done:
    for (ptrdiff_t i = 0; i < n && states != NULL; i++)
        pm_state_release(&states[i]);
    pm_free(states);
    return status;
}

static enum pm_status plot_path(const char *path, struct pm_err *err)
{
    struct pm_sweep s;
    const enum pm_status status = pm_sweep_load(path, &s, err);

    if (status == PM_OK)
        pmplot_path(&s);
    pm_sweep_release(&s);
    return status;
}

static enum pm_status plot_boundary(const char *path, struct pm_err *err)
{
    struct pm_workspace w;
    const enum pm_status status = pm_workspace_load(path, &w, err);

    if (status == PM_OK)
        pmplot_boundary(&w);
    pm_workspace_release(&w);
    return status;
}

enum pm_status pmplot_run(const struct pmplot_opts *opts, const struct pm_common *common,
                          struct pm_err *err)
{
    const char *what = common->operands[0];
    const int several = strcmp(what, "workspace") == 0;

    if (common->output != NULL)
        return pm_fail(err, PM_USAGE, "tables go to standard output, expected no -o");
    if (!several && common->noperands != 2)
        return pm_fail(err, PM_USAGE, "'%s' takes one file, got %d", what, common->noperands - 1);
    if (strcmp(what, "surface") == 0 || strcmp(what, "section") == 0)
        return plot_surfaces(opts, what, common->operands[1], err);
    if (strcmp(what, "path") == 0)
        return plot_path(common->operands[1], err);
    if (strcmp(what, "boundary") == 0)
        return plot_boundary(common->operands[1], err);
    if (several || strcmp(what, "deformed") == 0)
        return plot_states(what, common->operands + 1, common->noperands - 1, err);
    return pm_fail(
        err, PM_USAGE,
        "unknown table '%s', expected surface, section, deformed, path, boundary or workspace",
        what);
}
