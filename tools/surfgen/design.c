#include "tools/surfgen/design.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/provenance.h"
#include "common/files/step.h"

static int same_symmetry(const struct pm_symmetry *a, const struct pm_symmetry *b,
                         ptrdiff_t nchambers)
{
    if (a->nops != b->nops)
        return 0;
    for (ptrdiff_t g = 0; g < a->nops; g++) {
        double off = 0;
        for (int i = 0; i < 9; i++)
            off = fmax(off, fabs(a->Q[g][i] - b->Q[g][i]));
        for (int i = 0; i < 3; i++)
            off = fmax(off, fabs(a->t[g][i] - b->t[g][i]));
        for (ptrdiff_t k = 0; k < nchambers; k++)
            off += a->chamber[g][k] != b->chamber[g][k];
        if (off > 1e-12)
            return 0;
    }
    return 1;
}

static enum pm_status check(const char *path, const struct pm_case *c, const struct pm_surfaces *s,
                            struct pm_err *err)
{
    const struct pm_case *was = &s->pcase;
    if (s->ns - 1 != c->nchambers)
        return pm_fail(err, PM_INPUT, "cannot use '%s': it has %td chambers, the case %td", path,
                       s->ns - 1, c->nchambers);
    if (was->height != c->height)
        return pm_fail(err, PM_INPUT, "cannot use '%s': it is %g mm high, the case %g", path,
                       was->height, c->height);
    if (!same_symmetry(&was->symmetry, &c->symmetry, c->nchambers))
        return pm_fail(err, PM_INPUT, "cannot use '%s': its symmetry is not that of the case",
                       path);
    return PM_OK;
}

enum pm_status pm_design_load(const char *path, const struct pm_case *c, struct pm_surfaces *s,
                              struct pm_err *err)
{
    enum pm_status status;
    char *kind = NULL, *history = NULL, *command = NULL;
    struct pm_step step = {.ntrials = 0};

    *s = (struct pm_surfaces){.ns = 0};
    PM_TRY(pm_h5_ancestry(path, &kind, &history, &command, err));
    if (kind != NULL && strcmp(kind, "step") == 0) {
        PM_TRY(pm_step_load(path, &step, err));
        PM_TRY(pm_surfaces_copy(&step.accepted, s, err));
    } else {
        PM_TRY(pm_surfaces_load(path, s, err));
    }
    PM_TRY(check(path, c, s, err));
    pm_case_release(&s->pcase);
    PM_TRY(pm_case_copy(c, &s->pcase, err));
done:
    pm_free(kind);
    pm_free(history);
    pm_free(command);
    pm_step_release(&step);
    if (status != PM_OK)
        pm_surfaces_release(s);
    return status;
}
