#include "tools/invkin/invkin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/inverse.h"
#include "common/files/points.h"
#include "common/files/state.h"
#include "common/mechanics/walk.h"
#include "tools/invkin/pursue.h"
#include "tools/invkin/report.h"

/* The targets, the walk that serves them, and every pose that it has met. */
struct hunt {
    const struct invkin_opts *o;
    struct pursue_task task;
    struct pm_walk walk;
    struct pm_sweep s;
    struct pm_inverse v;
    struct pursue_pose *met; /* (nmet) */
    ptrdiff_t nmet, room;
    const char *guess[2]; /* the one that serves, NULL */
    size_t said;          /* characters of the reasons */
    long factorisations;  /* for this target */
};

static enum pm_status remember(struct hunt *h, const struct pursue_pose *pose, struct pm_err *err)
{
    if (h->nmet == h->room) {
        PM_GROW(h->met, 2 * h->room + 64, err);
        h->room = 2 * h->room + 64;
    }
    h->met[h->nmet++] = *pose;
    return PM_OK;
}

static enum pm_status solve(void *data, const double *p, double U[6], double *J, struct pm_err *err)
{
    enum pm_status status;
    struct hunt *h = data;
    const size_t nc = (size_t)h->s.mesh.nc;
    struct pursue_pose pose;
    status = pm_walk_step(&h->walk, p, err);
    h->factorisations += h->walk.r.factorisations;
    if (status != PM_OK)
        return status;
    memcpy(U, h->walk.last.U, sizeof pose.U);
    memcpy(J, h->walk.J, 6 * nc * sizeof *J);
    memcpy(pose.p, p, nc * sizeof *p);
    memcpy(pose.U, U, sizeof pose.U);
    memcpy(pose.J, J, 6 * nc * sizeof *J);
    return remember(h, &pose, err);
}

static const struct pursue_pose *nearest(const struct hunt *h)
{
    const struct pursue_pose *best = NULL;
    double least = INFINITY;
    for (ptrdiff_t i = 0; i < h->nmet; i++) {
        const double distance = pursue_distance(&h->task, h->met[i].U);
        if (distance < least) {
            least = distance;
            best = &h->met[i];
        }
    }
    return best;
}

/* The pressures of the guess that is nearest to the target, else the least ones, within the bounds.
 */
static enum pm_status first_pressures(struct hunt *h, double *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_state s = {.u = NULL};
    const ptrdiff_t nc = h->s.mesh.nc;
    double least = INFINITY;
    for (ptrdiff_t k = 0; k < nc; k++)
        p[k] = 0.0;
    for (const char *const *path = h->o->guess; *path != NULL; path++) {
        PM_TRY(pm_state_load(*path, 0, &s, err));
        if (s.mesh.nc != nc)
            PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': it has %td chambers, expected %td",
                           *path, s.mesh.nc, nc));
        if (pursue_distance(&h->task, s.U) < least) {
            least = pursue_distance(&h->task, s.U);
            memcpy(p, s.pressure, (size_t)nc * sizeof *p);
            h->guess[0] = *path;
        }
        pm_state_release(&s);
        s = (struct pm_state){.u = NULL};
    }
    for (ptrdiff_t k = 0; k < nc; k++)
        p[k] = fmin(h->task.high, fmax(h->task.low, p[k]));
done:
    pm_state_release(&s);
    return status;
}

/* The first pose of all; there is no pursuit without one. */
static enum pm_status begin(struct hunt *h, struct pm_err *err)
{
    enum pm_status status;
    struct pursue_pose start = {.p = {0}};
    PM_TRY(first_pressures(h, start.p, err));
    PM_TRY(solve(h, start.p, start.U, start.J, err));
done:
    return status;
}

/* Target i is done: the walk returns to its best pose where it has gone on from there. */
static enum pm_status record(struct hunt *h, ptrdiff_t i, struct pursue_result *r,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_sweep *s = &h->s;
    const ptrdiff_t nc = s->mesh.nc;
    struct pm_err why = {0};
    const size_t room = (size_t)s->np * (sizeof r->why + 1) + 1;
    int there = 1;
    for (ptrdiff_t k = 0; k < nc; k++)
        there = there && h->walk.at[k] == r->best.p[k] * h->walk.m->law.mu;
    if (!there) {
        r->equilibria++;
        PM_TRY(solve(h, r->best.p, r->best.U, r->best.J, err));
    }
    memcpy(s->pressure + nc * i, r->best.p, (size_t)nc * sizeof *s->pressure);
    PM_TRY(pm_walk_record(&h->walk, s, i, err));
    s->factorisations[i] = h->factorisations;
    h->v.verdict[i] = r->verdict;
    h->v.iterations[i] = r->iterations;
    h->v.equilibria[i] = r->equilibria;
    for (ptrdiff_t k = 0; k < nc; k++)
        h->v.bound[nc * i + k] = r->bound[k];
    memcpy(h->v.error + 2 * i, r->error, sizeof r->error);
    if (r->verdict == PM_NO_EQUILIBRIUM)
        snprintf(why.text, sizeof why.text, "%s", r->why);
    h->said += (size_t)snprintf(s->reason + h->said, room - h->said, "%s\n", why.text);
done:
    return status;
}

static enum pm_status pursue_target(struct hunt *h, ptrdiff_t i, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pursue_result r;
    int first = h->nmet == 0;
    pm_progress("target %td of %td", i + 1, h->s.np);
    memcpy(h->task.target, h->v.target + h->v.nd * i, (size_t)h->v.nd * sizeof *h->v.target);
    h->factorisations = 0;
    if (first)
        PM_TRY(begin(h, err));
    const struct pursue_pose start = *nearest(h);
    PM_TRY(pursue(&h->task, &start, &r, err));
    r.equilibria += first;
    PM_TRY(record(h, i, &r, err));
    invkin_tell(&h->s, &h->v, i);
done:
    return status;
}

/* Components, bounds and weights of the task from options and case. */
static enum pm_status set_task(struct hunt *h, const char *mesh, struct pm_err *err)
{
    const struct invkin_opts *o = h->o;
    const struct pm_case *c = &h->s.mesh.pcase;
    struct pursue_task *t = &h->task;
    t->nd = o->ndof > 0 ? o->ndof : c->ndofs;
    memcpy(t->dof, o->ndof > 0 ? o->dof : c->dofs, sizeof t->dof);
    if (t->nd == 0)
        return pm_fail(err, PM_USAGE,
                       "option --dofs: none, and the case of '%s' has no workspace, expected "
                       "components of the pose",
                       mesh);
    t->low = o->nbounds > 0 ? o->bounds[0] : c->pmin;
    t->high = o->nbounds > 0 ? o->bounds[1] : c->pmax;
    t->length = o->length;
    t->tolerance = o->tolerance;
    t->most = (int)o->most;
    t->n = (int)h->s.mesh.nc;
    t->pose = solve;
    t->data = h;
    h->v.nd = t->nd;
    h->v.nc = h->s.mesh.nc;
    for (int i = 0; i < t->nd; i++)
        h->v.dofs[i] = t->dof[i] + 1;
    h->v.limits[0] = t->low;
    h->v.limits[1] = t->high;
    h->v.length = t->length;
    h->v.tolerance = t->tolerance;
    return PM_OK;
}

static enum pm_status read_targets(struct hunt *h, struct pm_err *err)
{
    enum pm_status status;
    const struct invkin_opts *o = h->o;
    double *read = NULL;
    ptrdiff_t np = 1;
    char why[64];
    snprintf(why, sizeof why, "expected %d", h->task.nd);
    if (o->targets != NULL)
        PM_TRY(pm_points_read(o->targets, h->task.nd, "component", why, &read, &np, err));
    else if (o->ntarget != h->task.nd)
        PM_TRY(pm_fail(err, PM_USAGE, "option --target: found %d components, expected %d",
                       o->ntarget, h->task.nd));
    PM_TRY(pm_sweep_allocate(&h->s, np, err));
    PM_TRY(pm_inverse_allocate(&h->v, np, err));
    PM_TRY(
        PM_NEW(h->s.reason, np * (ptrdiff_t)(sizeof((struct pursue_result *)0)->why + 1) + 1, err));
    memcpy(h->v.target, read != NULL ? read : o->target,
           (size_t)(np * h->task.nd) * sizeof *h->v.target);
done:
    pm_free(read);
    return status;
}

static enum pm_status write_path(const struct hunt *h, const struct pm_common *common,
                                 struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *out = NULL;
    const char *inputs[INVKIN_MOST_GUESSES + 2] = {NULL};
    int n = 0;
    if (h->o->targets != NULL)
        inputs[n++] = h->o->targets;
    memcpy(inputs + n, h->o->guess, sizeof h->o->guess);
    PM_TRY(pm_h5_create(common->output, "path", common, inputs, &out, err));
    PM_TRY(pm_sweep_write(out, &h->s, err));
    PM_TRY(pm_inverse_write(out, &h->v, err));
    status = pm_h5_commit(out, err);
    out = status == PM_OK ? NULL : out;
done:
    pm_h5_close(out);
    return status;
}

enum pm_status invkin_run(const struct invkin_opts *o, const struct pm_common *common,
                          struct pm_err *err)
{
    enum pm_status status;
    struct hunt h = {.o = o};
    if ((o->targets != NULL) == (o->ntarget > 0))
        return pm_fail(err, PM_USAGE, "expected exactly one of --target and --targets");
    pm_threads_set((int)o->threads);
    PM_TRY(pm_mesh_load(common->operands[0], 0, &h.s.mesh, err));
    PM_TRY(set_task(&h, common->operands[0], err));
    PM_TRY(read_targets(&h, err));
    PM_TRY(pm_walk_new(&h.s.mesh, o->element, o->residual, h.guess, &h.walk, err));
    snprintf(h.s.element, sizeof h.s.element, "%s", h.walk.m->space.type->name);
    for (ptrdiff_t i = 0; i < h.s.np; i++)
        PM_TRY(pursue_target(&h, i, err));
    if (o->targets == NULL && !o->record_failure && h.v.verdict[0] != PM_REACHED) {
        status = invkin_fail(&h.s, &h.v, err);
        goto done;
    }
    invkin_summarise(&h.s, &h.v);
    PM_TRY(write_path(&h, common, err));
    if (o->table)
        invkin_table(&h.s, &h.v);
done:
    pm_walk_release(&h.walk);
    pm_sweep_release(&h.s);
    pm_inverse_release(&h.v);
    pm_free(h.met);
    return status;
}
