#include "tools/fesolve/path.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/points.h"
#include "common/mechanics/walk.h"

/* The points and how far they are. */
struct tour {
    const struct fesolve_opts *o;
    struct pm_walk walk;
    struct pm_sweep s;
    size_t said; /* characters of the reasons */
};

static enum pm_status read_points(struct tour *t, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nc = t->s.mesh.nc;
    double *pressure = NULL;
    ptrdiff_t np = 0;
    char why[64];
    snprintf(why, sizeof why, "the mesh has %td chambers", nc);
    PM_TRY(pm_points_read(t->o->path, nc, "pressure", why, &pressure, &np, err));
    PM_TRY(pm_sweep_allocate(&t->s, np, err));
    PM_TRY(PM_NEW(t->s.reason, np * (ptrdiff_t)(sizeof err->text + 1) + 1, err));
    memcpy(t->s.pressure, pressure, (size_t)(np * nc) * sizeof *pressure);
done:
    pm_free(pressure);
    return status;
}

static enum pm_status point(struct tour *t, ptrdiff_t i, struct pm_err *err)
{
    enum pm_status status;
    struct pm_sweep *s = &t->s;
    struct pm_err why = {0};
    const size_t room = (size_t)s->np * (sizeof why.text + 1) + 1;
    pm_progress("point %td of %td", i + 1, s->np);
    status = pm_walk_step(&t->walk, s->pressure + s->mesh.nc * i, &why);
    s->factorisations[i] = t->walk.r.factorisations;
    if (status == PM_OK) {
        status = pm_walk_record(&t->walk, s, i, err);
    } else if (status != PM_NUMERIC) {
        *err = why;
    } else if (!t->o->record_failure) {
        status = pm_fail(err, status, "point %td of '%s': %.400s", i + 1, t->o->path, why.text);
    } else {
        pm_warn("point %td of '%s': %s", i + 1, t->o->path, why.text);
        status = PM_OK;
    }
    t->said += (size_t)snprintf(s->reason + t->said, room - t->said, "%s\n", why.text);
    pm_log(1, "point %td: %lld factorisations%s", i + 1, (long long)s->factorisations[i],
           s->reached[i] ? "" : ", not reached");
    return status;
}

static void summarise(const struct pm_sweep *s)
{
    ptrdiff_t reached = 0, touching = 0;
    int64_t factorisations = 0;
    for (ptrdiff_t i = 0; i < s->np; i++) {
        reached += s->reached[i] != 0;
        touching += s->intersections[i] > 0;
        factorisations += s->factorisations[i];
    }
    if (touching > 0)
        pm_warn("self-contact is not modelled: the body penetrates itself at %td "
                "of %td points",
                touching, reached);
    pm_log(1, "%td of %td points reached, %lld factorisations", reached, s->np,
           (long long)factorisations);
}

enum pm_status fesolve_path(const struct fesolve_opts *o, const struct pm_common *common,
                            struct pm_mesh *mesh, struct pm_err *err)
{
    enum pm_status status;
    struct tour t = {.o = o};
    struct pm_h5 *out = NULL;
    const char *inputs[FESOLVE_MOST_GUESSES + 2] = {o->path};
    memcpy(inputs + 1, o->guess, sizeof o->guess);
    t.s.mesh = *mesh;
    *mesh = (struct pm_mesh){.nn = 0};
    PM_TRY(read_points(&t, err));
    PM_TRY(pm_walk_new(&t.s.mesh, o->element, o->tolerance, o->guess, &t.walk, err));
    snprintf(t.s.element, sizeof t.s.element, "%s", t.walk.m->space.type->name);
    for (ptrdiff_t i = 0; i < t.s.np; i++)
        PM_TRY(point(&t, i, err));
    summarise(&t.s);
    PM_TRY(pm_h5_create(common->output, "path", common, inputs, &out, err));
    PM_TRY(pm_sweep_write(out, &t.s, err));
    status = pm_h5_commit(out, err);
    out = NULL;
done:
    pm_h5_close(out);
    pm_walk_release(&t.walk);
    pm_sweep_release(&t.s);
    return status;
}
