#include "common/mechanics/restore.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"

enum pm_status pm_config_restore(const struct pm_model *m, const struct pm_state *s,
                                 struct pm_config *c, struct pm_err *err)
{
    if (s->nbubble != m->nn - m->mesh->nn)
        return pm_fail(err, PM_INPUT,
                       "the state has %td bubbles, expected %td of element %s on its mesh",
                       s->nbubble, m->nn - m->mesh->nn, s->element);
    memcpy(c->u, s->u, 3 * (size_t)m->mesh->nn * sizeof *c->u);
    if (s->nbubble > 0)
        memcpy(c->u + 3 * m->mesh->nn, s->bubble, 3 * (size_t)s->nbubble * sizeof *c->u);
    memcpy(c->U, s->U, sizeof c->U);
    return PM_OK;
}

void pm_config_displacement(const struct pm_model *m, const struct pm_config *c, double *u)
{
    const struct pm_mesh *mesh = m->mesh;
    memcpy(u, c->u, 3 * (size_t)mesh->nn * sizeof *u);
    if (m->space.type->npe > 4 || mesh->npe == 4)
        return;
    for (ptrdiff_t e = 0; e < mesh->ne; e++)
        for (int k = 0; k < 6; k++) {
            const int32_t *t = mesh->tet + mesh->npe * e;
            const double *a = u + 3 * (ptrdiff_t)t[pm_tet10_edge[k][0]],
                         *b = u + 3 * (ptrdiff_t)t[pm_tet10_edge[k][1]];
            for (int i = 0; i < 3; i++)
                u[3 * (ptrdiff_t)t[4 + k] + i] = 0.5 * (a[i] + b[i]);
        }
}

enum pm_status pm_config_store(const struct pm_model *m, const struct pm_config *c,
                               struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t nn = m->mesh->nn;
    PM_TRY(PM_NEW(s->u, 3 * nn, err));
    pm_config_displacement(m, c, s->u);
    memcpy(s->U, c->U, sizeof s->U);
    s->nbubble = m->nn - nn;
    if (s->nbubble > 0) {
        PM_TRY(PM_NEW(s->bubble, 3 * s->nbubble, err));
        memcpy(s->bubble, c->u + 3 * nn, 3 * (size_t)s->nbubble * sizeof *s->bubble);
    }
done:
    return status;
}
