/* adjsens --each, --nodal: derivatives of every entry of pose, Jacobian, volumes and compliance. */
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "tools/adjsens/adjsens.h"

enum { BATCH = 6 }; /* entries differentiated at once: right-hand sides of a solve */

/* Entry k in the order of struct pm_entries. */
static struct pm_objective entry(ptrdiff_t k, ptrdiff_t nc)
{
    struct pm_objective w = {.V = {0}};
    if (k < 6)
        w.U[k] = 1.0;
    else if ((k -= 6) < 6 * nc)
        w.J[k / nc][k % nc] = 1.0;
    else if ((k -= 6 * nc) < nc)
        w.V[k] = 1.0;
    else
        w.C[(k - nc) / nc][(k - nc) % nc] = 1.0;
    return w;
}

enum pm_status adjsens_entries(const struct adjsens_opts *o, struct adjsens_point *pt,
                               struct pm_sens *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_adjoint_at at = adjsens_at(pt);
    const struct pm_mesh *mesh = &pt->state.mesh;
    ptrdiff_t nc = mesh->nc, count = pm_entries_count(nc), size = 3 * pt->m->nn;
    double *D = NULL, D_ref[3 * BATCH];
    if (!o->each && !o->nodal)
        return PM_OK;
    out->nc = nc;
    PM_TRY(PM_NEW(out->compliance, nc * nc, err));
    PM_TRY(pm_compliance(pt->m, &pt->c, pt->Jq, out->compliance, err));
    PM_TRY(PM_NEW(D, BATCH * size, err));
    if (o->each) {
        out->each.n = mesh->N;
        PM_TRY(PM_NEW(out->each.d, 3 * count * mesh->N, err));
    }
    if (o->nodal) {
        out->nodal.n = mesh->nn;
        PM_TRY(PM_NEW(out->nodal.d, 3 * count * mesh->nn, err));
    }
    for (ptrdiff_t k = 0; k < count; k += BATCH) {
        ptrdiff_t n = count - k < BATCH ? count - k : BATCH;
        struct pm_objective w[BATCH];
        for (ptrdiff_t i = 0; i < n; i++)
            w[i] = entry(k + i, nc);
        PM_TRY(pm_adjoint(&at, n, w, o->form, D, D_ref, err));
        for (ptrdiff_t i = 0; i < n; i++) {
            double *d = D + i * size;
            if (o->nodal)
                memcpy(out->nodal.d + 3 * (k + i) * mesh->nn, d, 3 * (size_t)mesh->nn * sizeof *d);
            if (o->each)
                PM_TRY(adjsens_pull_back(pt, o->form, d, out->each.d + 3 * (k + i) * mesh->N, err));
        }
        pm_log(2, "%td of %td entries", k + n, count);
    }
done:
    pm_free(D);
    return status;
}
