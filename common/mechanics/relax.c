#include "common/mechanics/relax.h"

#include "common/base/memory.h"

/* The mesh m at x + u, its tip part of the base; x and tri_tag are new memory. */
static enum pm_status deform(const struct pm_mesh *m, const double *u, struct pm_mesh *now,
                             struct pm_err *err)
{
    enum pm_status status;
    *now = *m;
    now->x = NULL;
    now->tri_tag = NULL;
    PM_TRY(PM_NEW(now->x, 3 * m->nn, err));
    PM_TRY(PM_NEW(now->tri_tag, m->nf, err));
    for (ptrdiff_t i = 0; i < 3 * m->nn; i++)
        now->x[i] = m->x[i] + u[i];
    for (ptrdiff_t f = 0; f < m->nf; f++)
        now->tri_tag[f] = m->tri_tag[f] == PM_FACE_TIP ? PM_FACE_BASE : m->tri_tag[f];
done:
    return status;
}

enum pm_status pm_relax(const struct pm_model *m, const double *p, struct pm_config *c,
                        struct pm_err *err)
{
    enum pm_status status;
    struct pm_mesh now = {.nn = 0};
    struct pm_model *soft = NULL;
    struct pm_config still = {0};
    double *f = NULL, *q = NULL, *none = NULL, low;
    int definite;

    PM_TRY(deform(m->mesh, c->u, &now, err));
    PM_TRY(pm_model_new(&now, m->space.type->name, &soft, err));
    PM_TRY(pm_config_new(soft, &still, err));
    PM_TRY(PM_NEW(none, 3 * m->nn, err));
    PM_TRY(PM_NEW(f, 3 * m->nn, err));
    PM_TRY(PM_NEW(q, soft->nq, err));
    PM_TRY(pm_model_factor(soft, &still, none, none, NULL, &definite, err));
    if (!definite)
        PM_TRY(pm_fail(err, PM_NUMERIC, "the stiffness of the carried shape is not definite"));
    pm_model_potential(m, c, p, f, NULL, &low);
    pm_model_reduce(soft, &still, f, q);
    PM_TRY(pm_model_solve(soft, q, 1, 0.0, err));
    pm_model_expand(soft, &still, q, f);
    for (ptrdiff_t i = 0; i < 3 * m->nn; i++)
        c->u[i] -= f[i];
done:
    pm_free(now.x);
    pm_free(now.tri_tag);
    pm_free(none);
    pm_free(f);
    pm_free(q);
    pm_config_release(&still);
    pm_model_free(soft);
    return status;
}
