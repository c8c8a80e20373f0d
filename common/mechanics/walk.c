#include "common/mechanics/walk.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/contact.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/restore.h"
#include "common/mechanics/start.h"

enum pm_status pm_walk_new(const struct pm_mesh *mesh, const char *element, double tolerance,
                           const char *const *guess, struct pm_walk *w, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nc = mesh->nc;
    *w = (struct pm_walk){.options = pm_solve_default, .guess = guess};
    w->options.tolerance = tolerance;
    PM_TRY(pm_model_new(mesh, element, &w->m, err));
    PM_TRY(pm_config_new(w->m, &w->c, err));
    PM_TRY(pm_config_new(w->m, &w->last, err));
    PM_TRY(PM_NEW(w->p, nc, err));
    PM_TRY(PM_NEW(w->at, nc, err));
    PM_TRY(PM_NEW(w->volume, nc, err));
    PM_TRY(PM_NEW(w->J, 6 * nc, err));
    PM_TRY(PM_NEW(w->f, 3 * w->m->nn, err));
    PM_TRY(PM_NEW(w->Jq, nc * w->m->nq, err));
done:
    return status;
}

void pm_walk_release(struct pm_walk *w)
{
    pm_config_release(&w->c);
    pm_config_release(&w->last);
    pm_model_free(w->m);
    pm_free(w->p);
    pm_free(w->at);
    pm_free(w->volume);
    pm_free(w->J);
    pm_free(w->f);
    pm_free(w->Jq);
    *w = (struct pm_walk){.begun = 0};
}

enum pm_status pm_walk_step(struct pm_walk *w, const double *p, struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = w->m;
    const ptrdiff_t nc = m->mesh->nc;
    const struct pm_guess guess = {.at = w->at};
    int loaded = 0;
    for (ptrdiff_t k = 0; k < nc; k++) {
        w->p[k] = p[k] * m->law.mu;
        loaded |= p[k] != 0.0;
    }
    pm_config_copy(m, &w->last, &w->c);
    if (w->begun) /* no pressure at all is the undeformed state */
        PM_TRY(pm_equilibrium(m, w->p, &w->options, loaded ? &guess : NULL, &w->c, w->volume, w->f,
                              &w->r, err));
    else
        PM_TRY(pm_start(m, w->p, &w->options, w->guess, &w->c, w->volume, w->f, &w->r, err));
    const long before = m->factorisations;
    PM_TRY(pm_jacobian(m, &w->c, m->law.mu, w->Jq, w->J, err));
    w->r.factorisations += m->factorisations - before;
    pm_config_copy(m, &w->c, &w->last);
    memcpy(w->at, w->p, (size_t)nc * sizeof *w->at);
    w->begun = 1;
done:
    return status;
}

enum pm_status pm_walk_record(const struct pm_walk *w, struct pm_sweep *s, ptrdiff_t i,
                              struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nc = s->mesh.nc, nn = s->mesh.nn;
    struct pm_self_contact contact;
    s->reached[i] = 1;
    memcpy(s->U + 6 * i, w->last.U, sizeof w->last.U);
    memcpy(s->J + 6 * nc * i, w->J, 6 * (size_t)nc * sizeof *w->J);
    memcpy(s->volume + nc * i, w->volume, (size_t)nc * sizeof *w->volume);
    pm_config_displacement(w->m, &w->last, s->displacement + 3 * nn * i);
    s->energy[i] = w->r.energy;
    s->residual[i] = w->r.residual;
    s->min_det_F[i] = w->r.min_det_F;
    PM_TRY(pm_contact_find(&s->mesh, s->displacement + 3 * nn * i, &contact, err));
    s->intersections[i] = contact.intersections;
    s->gap[i] = contact.gap;
    s->closeness[i] = contact.closeness;
done:
    return status;
}
