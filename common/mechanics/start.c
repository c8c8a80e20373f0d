#include "common/mechanics/start.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/state.h"
#include "common/mechanics/relax.h"
#include "common/mechanics/restore.h"
#include "common/mechanics/transfer.h"
#include "common/mechanics/warp.h"

/* An equilibrium of another load, a neighbouring shape or another mesh. */
struct guess {
    struct pm_state from;
    double *at;      /* its pressures (nc) [MPa] */
    pm_lanes *mixed; /* of the elements where it was carried to [MPa] */
    int usable;
    int same_mesh; /* but for the positions of its nodes */
};

static void guess_release(struct guess *g)
{
    pm_state_release(&g->from);
    pm_free(g->at);
    pm_free(g->mixed);
    *g = (struct guess){.usable = 0};
}

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

/* The one of the files (ends with NULL) whose pressures are nearest to p; usable = 0, with
 * warnings, where all record a failure or have other chambers. */
static enum pm_status choose(const char *const *paths, const struct pm_mesh *mesh, const double *p,
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

/* The guess of another mesh, with the law of m, at the loads of the guess. */
static enum pm_status fit(struct guess *g, struct pm_model *m, struct pm_config *c,
                          struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *old = NULL;
    struct pm_config before = {0};
    struct pm_warp *w = NULL;
    pm_lanes *gradient = NULL;

    PM_TRY(pm_model_new(&g->from.mesh, g->from.element, &old, err));
    old->law = m->law;
    old->blend = pm_element_blend(old->space.type, &old->law);
    PM_TRY(pm_config_new(old, &before, err));
    PM_TRY(pm_config_restore(old, &g->from, &before, err));
    PM_TRY(PM_NEW_LANES(gradient, 9 * m->nb * m->space.type->nq, err));
    PM_TRY(pm_model_mixed_new(m, &g->mixed, err));
    PM_TRY(pm_transfer(old, &before, m, gradient, g->mixed, err));
    memcpy(c->U, g->from.U, sizeof c->U);
    PM_TRY(pm_warp_new(m, &w, err));
    PM_TRY(pm_warp_fit(w, gradient, c, err));
done:
    pm_model_free(old);
    pm_config_release(&before);
    pm_warp_free(w);
    pm_free(gradient);
    return status;
}

/* The same, relaxed; *good = 0 where that fails. The counts of r grow by its own. */
static enum pm_status transfer(struct guess *g, struct pm_model *m, struct pm_config *c, int *good,
                               struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_err why = {0};

    PM_TRY(fit(g, m, c, err));
    pm_model_place_tip(m, c);
    status = pm_relax(m, g->at, c, &why);
    *good = status == PM_OK;
    r->factorisations += *good;
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

enum pm_status pm_start(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                        const char *const *paths, struct pm_config *c, double *volume, double *f,
                        struct pm_solve_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct pm_solve_report spent = {0};
    struct guess g = {.usable = 0};
    int good;

    PM_TRY(choose(paths, m->mesh, p, &g, err));
    good = g.usable;
    if (g.usable)
        PM_TRY(g.same_mesh ? carry(&g, m, c, err) : transfer(&g, m, c, &good, &spent, err));
    status = PM_NUMERIC;
    if (good) {
        struct pm_err why = {0};
        status = pm_equilibrium(m, p, o, &(struct pm_guess){.at = g.at, .mixed = g.mixed}, c,
                                volume, f, r, &why);
        if (status != PM_OK) {
            spent.factorisations += r->factorisations;
            spent.backoffs += r->backoffs + 1;
        }
        if (status != PM_OK && status != PM_NUMERIC)
            *err = why;
    }
    if (status == PM_NUMERIC) {
        if (g.usable)
            pm_warn(
                "the guess does not lead to an equilibrium: starting from the undeformed state");
        status = pm_equilibrium(m, p, o, NULL, c, volume, f, r, err);
    }
    r->factorisations += spent.factorisations;
    r->newton_steps += spent.newton_steps;
    r->backoffs += spent.backoffs;
done:
    guess_release(&g);
    return status;
}
