/* Lists of pressures of a case on standard output. */
#include <stdio.h>

#include "common/actuation/lattice.h"
#include "common/actuation/measure.h"
#include "common/base/memory.h"
#include "tools/wsint/wsint.h"

static enum pm_status load_case(const struct wsint_opts *opts, const struct pm_common *common,
                                const char *option, struct pm_case *c, struct pm_err *err)
{
    if (common->noperands != 1 || common->output != NULL)
        return pm_fail(err, PM_USAGE, "--%s takes one case file and no output", option);
    const enum pm_status status = pm_case_load(common->operands[0], c, err);
    return status == PM_OK ? wsint_apply(opts, c, err) : status;
}

enum pm_status wsint_print_points(const struct wsint_opts *opts, const struct pm_common *common,
                                  struct pm_err *err)
{
    enum pm_status status;
    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n;

    PM_TRY(load_case(opts, common, "points", &c, err));
    PM_TRY(pm_load_set(&c, c.form, &loads, &n, err));
    printf("point\tmultiplicity\tweight\tface\tsign");
    for (ptrdiff_t r = 0; r < c.nchambers; r++)
        printf("\tp%td", r + 1);
    for (ptrdiff_t g = 0; g < n; g++) {
        printf("\n%td\t%d\t%.9g\t%d\t%d", g, loads[g].multiplicity, loads[g].weight,
               loads[g].face + 1, loads[g].sign);
        for (ptrdiff_t r = 0; r < c.nchambers; r++)
            printf("\t%.12g", loads[g].p[r]);
    }
    putchar('\n');
done:
    pm_free(loads);
    pm_case_release(&c);
    return status;
}

enum pm_status wsint_print_boundary(const struct wsint_opts *opts, const struct pm_common *common,
                                    struct pm_err *err)
{
    enum pm_status status;
    struct pm_case c = {0};
    struct pm_lattice l;
    ptrdiff_t *ids = NULL, n;

    PM_TRY(load_case(opts, common, "boundary", &c, err));
    PM_TRY(pm_lattice_make(&c, opts->boundary, &l, err));
    PM_TRY(pm_lattice_walk(&c, &l, &ids, &n, err));
    for (ptrdiff_t i = 0; i < n; i++) {
        double p[PM_MAX_CHAMBERS];
        pm_lattice_pressure(&l, ids[i], p);
        for (int r = 0; r < l.n; r++)
            printf("%.12g%c", p[r], r + 1 < l.n ? ' ' : '\n');
    }
done:
    pm_free(ids);
    pm_case_release(&c);
    return status;
}
