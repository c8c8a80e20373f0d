#include "tools/fesolve/path.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/sweep.h"
#include "common/geometry/contact.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/equilibrium.h"
#include "common/mechanics/restore.h"

enum { LINE = 4096 };

static enum pm_status read_line(const char *path, long number, char *line, ptrdiff_t nc, double *p,
                                int *found, struct pm_err *err)
{
    ptrdiff_t n = 0;
    char *save = NULL;
    if (strchr(line, '\n') == NULL && strlen(line) == LINE - 1)
        return pm_fail(err, PM_INPUT, "cannot use '%s': line %ld is longer than %d characters",
                       path, number, LINE - 2);
    line[strcspn(line, "#\r\n")] = '\0';
    for (char *word = strtok_r(line, ", \t", &save); word != NULL;
         word = strtok_r(NULL, ", \t", &save), n++) {
        char *end;
        const double v = strtod(word, &end);
        if (*end != '\0' || !isfinite(v))
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': line %ld: found '%.40s', expected a "
                           "pressure",
                           path, number, word);
        if (n < nc)
            p[n] = v;
    }
    *found = n > 0;
    if (n > 0 && n != nc)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': line %ld has %td pressures, the mesh has "
                       "%td chambers",
                       path, number, n, nc);
    return PM_OK;
}

enum pm_status fesolve_path_read(const char *path, ptrdiff_t nc, double **p, ptrdiff_t *np,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t capacity = 0;
    char *line = NULL;
    int found = 0;
    FILE *f = fopen(path, "r");
    *p = NULL;
    *np = 0;
    if (f == NULL)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno));
    PM_TRY(PM_NEW(line, LINE, err));
    for (long number = 1; fgets(line, LINE, f) != NULL; number++) {
        if (*np == capacity) {
            void *more = pm_realloc(*p, nc * (2 * capacity + 64), sizeof **p, err);
            if (more == NULL)
                PM_TRY(PM_SYSTEM);
            *p = more;
            capacity = 2 * capacity + 64;
        }
        PM_TRY(read_line(path, number, line, nc, *p + nc * *np, &found, err));
        *np += found;
    }
    if (ferror(f))
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", path, strerror(errno)));
    if (*np == 0)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': no points, expected one a line", path));
done:
    fclose(f);
    pm_free(line);
    return status;
}

/* The walk: the last configuration that is an equilibrium, and its pressures.
 */
struct walk {
    const struct fesolve_opts *o;
    struct pm_model *m;
    struct pm_sweep s;
    struct pm_config c, last;
    double *p, *at; /* pressures of the point and of the last one (nc) [MPa] */
    double *volume, *f, *Jq;
    int begun;   /* there is a last one */
    size_t said; /* characters of the reasons */
};

static enum pm_status allocate(struct walk *w, ptrdiff_t np, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nc = w->s.mesh.nc;
    PM_TRY(pm_sweep_allocate(&w->s, np, err));
    PM_TRY(PM_NEW(w->s.reason, np * (ptrdiff_t)(sizeof err->text + 1) + 1, err));
    PM_TRY(pm_model_new(&w->s.mesh, w->o->element, &w->m, err));
    PM_TRY(pm_config_new(w->m, &w->c, err));
    PM_TRY(pm_config_new(w->m, &w->last, err));
    PM_TRY(PM_NEW(w->p, nc, err));
    PM_TRY(PM_NEW(w->at, nc, err));
    PM_TRY(PM_NEW(w->volume, nc, err));
    PM_TRY(PM_NEW(w->f, 3 * w->m->nn, err));
    PM_TRY(PM_NEW(w->Jq, nc * w->m->nq, err));
    snprintf(w->s.element, sizeof w->s.element, "%s", w->m->space.type->name);
done:
    return status;
}

static void walk_release(struct walk *w)
{
    pm_sweep_release(&w->s);
    pm_config_release(&w->c);
    pm_config_release(&w->last);
    pm_free(w->p);
    pm_free(w->at);
    pm_free(w->volume);
    pm_free(w->f);
    pm_free(w->Jq);
}

/* Equilibrium at w->p into w->c. No pressure at all is the undeformed state. */
static enum pm_status step(struct walk *w, struct pm_solve_report *r, struct pm_err *err)
{
    struct pm_solve_options options = pm_solve_default;
    const struct pm_guess guess = {.at = w->at};
    int loaded = 0;
    for (ptrdiff_t k = 0; k < w->s.mesh.nc; k++)
        loaded |= w->p[k] != 0.0;
    if (!w->begun)
        return fesolve_balance(w->o, w->m, w->p, &w->c, w->volume, w->f, r, err);
    options.tolerance = w->o->tolerance;
    return pm_equilibrium(w->m, w->p, &options, loaded ? &guess : NULL, &w->c, w->volume, w->f, r,
                          err);
}

static enum pm_status record(struct walk *w, ptrdiff_t i, const struct pm_solve_report *r,
                             struct pm_err *err)
{
    enum pm_status status;
    struct pm_sweep *s = &w->s;
    const ptrdiff_t nc = s->mesh.nc, nn = s->mesh.nn;
    struct pm_self_contact contact;
    s->reached[i] = 1;
    PM_TRY(pm_jacobian(w->m, &w->c, w->m->law.mu, w->Jq, s->J + 6 * nc * i, err));
    memcpy(s->U + 6 * i, w->c.U, sizeof w->c.U);
    memcpy(s->volume + nc * i, w->volume, (size_t)nc * sizeof *w->volume);
    pm_config_displacement(w->m, &w->c, s->displacement + 3 * nn * i);
    s->energy[i] = r->energy;
    s->residual[i] = r->residual;
    s->min_det_F[i] = r->min_det_F;
    PM_TRY(pm_contact_find(&s->mesh, s->displacement + 3 * nn * i, &contact, err));
    s->intersections[i] = contact.intersections;
    s->gap[i] = contact.gap;
    pm_config_copy(w->m, &w->c, &w->last);
    memcpy(w->at, w->p, (size_t)nc * sizeof *w->p);
    w->begun = 1;
done:
    return status;
}

static enum pm_status point(struct walk *w, ptrdiff_t i, struct pm_err *err)
{
    enum pm_status status;
    struct pm_sweep *s = &w->s;
    struct pm_solve_report r = {0};
    struct pm_err why = {0};
    const size_t room = (size_t)s->np * (sizeof why.text + 1) + 1;
    pm_progress("point %td of %td", i + 1, s->np);
    for (ptrdiff_t k = 0; k < s->mesh.nc; k++)
        w->p[k] = s->pressure[s->mesh.nc * i + k] * w->m->law.mu;
    status = step(w, &r, &why);
    s->factorisations[i] = r.factorisations;
    if (status == PM_OK) {
        status = record(w, i, &r, err);
    } else if (status != PM_NUMERIC) {
        *err = why;
    } else if (!w->o->record_failure) {
        status = pm_fail(err, status, "point %td of '%s': %.400s", i + 1, w->o->path, why.text);
    } else {
        pm_warn("point %td of '%s': %s", i + 1, w->o->path, why.text);
        pm_config_copy(w->m, &w->last, &w->c);
        status = PM_OK;
    }
    w->said += (size_t)snprintf(s->reason + w->said, room - w->said, "%s\n", why.text);
    pm_log(1, "point %td: %ld factorisations%s", i + 1, r.factorisations,
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
    struct walk w = {.o = o};
    double *pressure = NULL;
    ptrdiff_t np = 0;
    struct pm_h5 *out = NULL;
    const char *inputs[FESOLVE_MOST_GUESSES + 2] = {o->path};
    memcpy(inputs + 1, o->guess, sizeof o->guess);
    w.s.mesh = *mesh;
    *mesh = (struct pm_mesh){.nn = 0};
    PM_TRY(fesolve_path_read(o->path, w.s.mesh.nc, &pressure, &np, err));
    PM_TRY(allocate(&w, np, err));
    memcpy(w.s.pressure, pressure, (size_t)(np * w.s.mesh.nc) * sizeof *pressure);
    for (ptrdiff_t i = 0; i < np; i++)
        PM_TRY(point(&w, i, err));
    summarise(&w.s);
    PM_TRY(pm_h5_create(common->output, "path", common, inputs, &out, err));
    PM_TRY(pm_sweep_write(out, &w.s, err));
    status = pm_h5_commit(out, err);
    out = NULL;
done:
    pm_h5_close(out);
    pm_free(pressure);
    pm_model_free(w.m);
    walk_release(&w);
    return status;
}
