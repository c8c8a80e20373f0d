#include "common/files/inverse.h"

#include "common/base/memory.h"

enum pm_status pm_inverse_allocate(struct pm_inverse *v, ptrdiff_t np, struct pm_err *err)
{
    enum pm_status status;
    v->np = np;
    PM_TRY(PM_NEW(v->target, np * v->nd, err));
    PM_TRY(PM_NEW(v->error, 2 * np, err));
    PM_TRY(PM_NEW(v->verdict, np, err));
    PM_TRY(PM_NEW(v->bound, np * v->nc, err));
    PM_TRY(PM_NEW(v->iterations, np, err));
    PM_TRY(PM_NEW(v->equilibria, np, err));
done:
    return status;
}

enum pm_status pm_inverse_write(struct pm_h5 *f, const struct pm_inverse *v, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t two = 2, target[] = {v->np, v->nd}, error[] = {v->np, 2},
                    bound[] = {v->np, v->nc};
    PM_TRY(pm_h5_put(f, "/inverse/dofs", &v->nd, v->dofs, err));
    PM_TRY(pm_h5_put(f, "/inverse/limits", &two, v->limits, err));
    PM_TRY(pm_h5_put_double(f, "/inverse/length", v->length, err));
    PM_TRY(pm_h5_put_double(f, "/inverse/tolerance", v->tolerance, err));
    PM_TRY(pm_h5_put(f, "/inverse/target", target, v->target, err));
    PM_TRY(pm_h5_put(f, "/inverse/error", error, v->error, err));
    PM_TRY(pm_h5_put(f, "/inverse/verdict", &v->np, v->verdict, err));
    PM_TRY(pm_h5_put(f, "/inverse/bound", bound, v->bound, err));
    PM_TRY(pm_h5_put(f, "/inverse/iterations", &v->np, v->iterations, err));
    PM_TRY(pm_h5_put(f, "/inverse/equilibria", &v->np, v->equilibria, err));
done:
    return status;
}

void pm_inverse_release(struct pm_inverse *v)
{
    pm_free(v->target);
    pm_free(v->error);
    pm_free(v->verdict);
    pm_free(v->bound);
    pm_free(v->iterations);
    pm_free(v->equilibria);
    *v = (struct pm_inverse){.np = 0};
}
