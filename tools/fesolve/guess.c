#include "tools/fesolve/guess.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/transfer.h"
#include "common/mechanics/warp.h"
#include "tools/fesolve/relax.h"

static int same_connectivity(const struct pm_mesh *a, const struct pm_mesh *b)
{
    return a->nn == b->nn && a->ne == b->ne && a->npe == b->npe && a->nc == b->nc &&
           memcmp(a->tet, b->tet, (size_t)(a->npe * a->ne) * sizeof *a->tet) == 0;
}

static enum pm_status guess_load(const char *path, const struct pm_mesh *mesh, struct guess *g,
                                 struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *old = &g->from.mesh;

    *g = (struct guess){.usable = 0};
    PM_TRY(pm_state_load(path, 1, &g->from, err));
    if (g->from.failure[0] != '\0') {
        pm_warn("guess '%s' records a failure: starting from the undeformed state", path);
    } else if (old->nc != mesh->nc) {
        pm_warn("guess '%s' has %td chambers, the mesh %td: starting from the undeformed state",
                path, old->nc, mesh->nc);
    } else {
        PM_TRY(PM_NEW(g->at, mesh->nc, err));
        for (ptrdiff_t r = 0; r < mesh->nc; r++)
            g->at[r] = g->from.pressure[r] * old->pcase.mu;
        g->same_mesh = same_connectivity(old, mesh);
        g->usable = 1;
    }
done:
    return status;
}

enum pm_status guess_choose(const char *const *paths, const struct pm_mesh *mesh, const double *p,
                            struct guess *g, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct guess next = {.usable = 0};
    double least = INFINITY;

    *g = (struct guess){.usable = 0};
    for (; *paths != NULL; paths++) {
        double distance = 0.0;
        PM_TRY(guess_load(*paths, mesh, &next, err));
        for (ptrdiff_t r = 0; r < mesh->nc && next.usable; r++)
            distance = fmax(distance, fabs(next.at[r] - p[r]));
        if (next.usable && distance < least) {
            least = distance;
            guess_release(g);
            *g = next;
            next = (struct guess){.usable = 0};
        }
        guess_release(&next);
    }
done:
    guess_release(&next);
    return status;
}

void guess_release(struct guess *g)
{
    pm_state_release(&g->from);
    pm_free(g->at);
    pm_free(g->mixed);
    *g = (struct guess){.usable = 0};
}

/* The guess of another mesh at the loads of the guess. */
static enum pm_status transfer(const struct guess *g, const struct pm_model *m, struct pm_config *c,
                               int *good, struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_err why = {0};

    PM_TRY(pm_transfer(&g->from.mesh, g->from.u, m->mesh, c->u, err));
    memcpy(c->U, g->from.U, sizeof c->U);
    pm_model_place_tip(m, c);
    status = fesolve_relax(m, g->at, c, &why);
    r->factorisations += status == PM_OK;
    *good = status == PM_OK;
    r->backoffs += !*good;
    if (status == PM_SYSTEM)
        *err = why;
    else
        status = PM_OK;
done:
    return status;
}

/* The guess of another shape of the same elements. */
static enum pm_status carry(struct guess *g, struct pm_model *m, struct pm_config *c,
                            struct pm_err *err)
{
    enum pm_status status;
    const size_t n = 3 * (size_t)m->mesh->nn;
    struct pm_warp *w = NULL;
    double *X = NULL, *u = NULL;

    PM_TRY(PM_NEW(X, 3 * m->nn, err)); /* bubbles: 0 */
    PM_TRY(PM_NEW(u, 3 * m->nn, err));
    memcpy(X, g->from.mesh.x, n * sizeof *X);
    memcpy(u, g->from.u, n * sizeof *u);
    if (g->from.nbubble == m->nn - m->mesh->nn && g->from.nbubble > 0)
        memcpy(u + n, g->from.bubble, 3 * (size_t)g->from.nbubble * sizeof *u);
    memcpy(c->U, g->from.U, sizeof c->U);
    PM_TRY(pm_model_mixed_new(m, &g->mixed, err));
    PM_TRY(pm_warp_new(m, &w, err));
    PM_TRY(pm_warp_carry(w, X, u, c, g->mixed, err));
done:
    pm_warp_free(w);
    pm_free(X);
    pm_free(u);
    return status;
}

enum pm_status guess_carry(struct guess *g, struct pm_model *m, struct pm_config *c, int *good,
                           struct pm_solve_report *r, struct pm_err *err)
{
    *good = 1;
    return g->same_mesh ? carry(g, m, c, err) : transfer(g, m, c, good, r, err);
}
