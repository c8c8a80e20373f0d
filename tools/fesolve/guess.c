#include "tools/fesolve/guess.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/advect.h"
#include "common/mechanics/transfer.h"
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
        g->same_shape =
            g->same_mesh && memcmp(old->x, mesh->x, 3 * (size_t)mesh->nn * sizeof *mesh->x) == 0;
        g->same_mesh &= g->same_shape || mesh->npe == 10; /* advect.h is for these */
        g->parts = g->same_mesh && !g->same_shape ? 4 : 1;
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

/* One part of the way: c, an equilibrium of shape a, to shape b. m is the model of shape a. */
static enum pm_status carry(struct guess *g, const struct pm_model *m, const struct pm_mesh *b,
                            struct pm_config *c, struct pm_err *err)
{
    enum pm_status status;
    double *still = NULL, *u = NULL;

    pm_free(g->mixed);
    PM_TRY(pm_model_mixed_new(m, &g->mixed, err));
    PM_TRY(PM_NEW(still, 3 * m->nn, err));
    PM_TRY(PM_NEW(u, 3 * b->nn, err));
    pm_model_mixed(m, c, still, g->mixed);
    if (!g->same_shape) {
        PM_TRY(pm_advect(m->mesh, c->u, b, u, err));
        memcpy(c->u, u, 3 * (size_t)b->nn * sizeof *u);
    }
done:
    pm_free(still);
    pm_free(u);
    return status;
}

/* Equilibrium of the model at the loads of the guess, from c only. */
static enum pm_status settle(struct guess *g, struct pm_model *m, struct pm_config *c, int *good,
                             struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_solve_options options = pm_solve_default;
    struct pm_solve_report part;
    struct pm_err why = {0};
    double *f = NULL, *volume = NULL;

    options.tolerance = 1e-3; /* a way station */
    PM_TRY(PM_NEW(f, 3 * m->mesh->nn, err));
    PM_TRY(PM_NEW(volume, m->mesh->nc, err));
    status = pm_equilibrium(m, g->at, &options, &(struct pm_guess){.at = g->at, .mixed = g->mixed},
                            c, volume, f, &part, &why);
    r->newton_steps += part.newton_steps;
    r->factorisations += part.factorisations;
    r->backoffs += part.backoffs;
    *good = status == PM_OK;
    if (status == PM_NUMERIC)
        status = PM_OK;
    else if (status != PM_OK)
        *err = why;
done:
    pm_free(f);
    pm_free(volume);
    return status;
}

enum pm_status guess_carry(struct guess *g, const struct pm_model *model, int parts,
                           struct pm_config *c, int *good, struct pm_solve_report *r,
                           struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *old = &g->from.mesh, *mesh = model->mesh;
    struct pm_mesh between = *mesh;
    struct pm_model *m = NULL, *next = NULL;
    double *x = NULL;

    if (!g->same_mesh)
        return transfer(g, model, c, good, r, err);
    *good = 1;
    PM_TRY(PM_NEW(x, 3 * mesh->nn * parts, err));
    memcpy(c->u, g->from.u, 3 * (size_t)mesh->nn * sizeof *c->u);
    memcpy(c->U, g->from.U, sizeof c->U);
    PM_TRY(pm_model_new(old, g->from.element, &m, err));
    for (int k = 1; k < parts && *good; k++) {
        between.x = x + 3 * mesh->nn * (k - 1);
        for (ptrdiff_t i = 0; i < 3 * mesh->nn; i++)
            between.x[i] = old->x[i] + (mesh->x[i] - old->x[i]) * k / parts;
        PM_TRY(carry(g, m, &between, c, err));
        PM_TRY(pm_model_new(&between, g->from.element, &next, err));
        PM_TRY(settle(g, next, c, good, r, err));
        pm_model_free(m);
        m = next;
        next = NULL;
    }
    if (*good)
        PM_TRY(carry(g, m, mesh, c, err));
done:
    pm_model_free(m);
    pm_model_free(next);
    pm_free(x);
    return status;
}
