#include "tools/fesolve/fesolve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/loads.h"
#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/state.h"
#include "common/geometry/contact.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/equilibrium.h"
#include "common/mechanics/limit.h"
#include "common/mechanics/restore.h"
#include "common/mechanics/start.h"
#include "tools/fesolve/path.h"

/* Pressures of the run: a point of a Gauss set, or those given. */
static enum pm_status choose_load(const struct fesolve_opts *o, struct pm_state *s,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_case *c = &s->mesh.pcase;
    struct pm_load *set = NULL;
    ptrdiff_t n = 0;
    s->form = o->have_form ? o->form : c->form;
    s->load = -1;
    PM_TRY(PM_NEW(s->pressure, s->mesh.nc, err));
    if (o->have_load) {
        PM_TRY(pm_load_set(c, (enum pm_form)s->form, &set, &n, err));
        if (o->load < 0 || o->load >= n)
            status =
                pm_fail(err, PM_USAGE,
                        "option --load: found %ld, the %s form of this case has points 0 to %td",
                        o->load, s->form == PM_FORM_VOLUME ? "volume" : "boundary", n - 1);
        else
            memcpy(s->pressure, set[o->load].p, (size_t)s->mesh.nc * sizeof *s->pressure);
        s->load = o->load;
    } else if (o->npressure != s->mesh.nc) {
        status =
            pm_fail(err, PM_USAGE, "option --pressure: found %d values, the mesh has %td chambers",
                    o->npressure, s->mesh.nc);
    } else {
        memcpy(s->pressure, o->pressure, (size_t)s->mesh.nc * sizeof *s->pressure);
    }
done:
    pm_free(set);
    return status;
}

/* Force and moment about the reference point that the clamp exerts on the body. */
static void reaction(const struct pm_model *m, const struct pm_config *c, const double *f,
                     double out[6])
{
    memset(out, 0, 6 * sizeof *out);
    for (ptrdiff_t a = 0; a < m->mesh->nn; a++) {
        const double *fa = f + 3 * a;
        double x[3];
        if (m->kind[a] != PM_NODE_CLAMPED)
            continue;
        for (int i = 0; i < 3; i++) {
            x[i] = m->arm[3 * a + i] + c->u[3 * a + i];
            out[i] += fa[i];
        }
        for (int i = 0; i < 3; i++)
            out[3 + i] += x[(i + 1) % 3] * fa[(i + 2) % 3] - x[(i + 2) % 3] * fa[(i + 1) % 3];
    }
}

/* The limit of the pressures p; the state becomes the last stable one on the way. */
static enum pm_status seek_limit(const struct fesolve_opts *o, struct pm_model *m, const double *p,
                                 struct pm_config *c, double *f, struct pm_solve_report *r,
                                 struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_solve_options options = pm_solve_default;
    struct pm_limit limit;
    options.tolerance = o->tolerance;
    PM_TRY(pm_limit_find(m, p, &options, c, s->volume, f, r, &limit, err));
    s->limit = limit.found ? limit.factor : 0.0;
    for (ptrdiff_t i = 0; i < s->mesh.nc; i++)
        s->pressure[i] *= limit.reached;
    if (limit.found)
        printf("limit\t%.9g\treached\t%.9g\n", limit.factor, limit.reached);
    else
        printf("limit\tnone\treached\t1\n");
    pm_log(1,
           limit.found ? "limit at %.9f of the pressures after %ld steps of volume control"
                       : "no limit up to %.0f times the pressures (%ld steps of volume control)",
           limit.factor, limit.steps);
done:
    return status;
}

static void tell_cost(const struct pm_model *m, const struct pm_state *s)
{
    const struct pm_cost *t = &m->cost;
    double rate = t->factor > 0.0 ? (double)m->factorisations * s->factor_flops / t->factor : 0.0;
    pm_log(1, "factor: %.3e entries, %.3e operations, %.3f s each at %.1f GFlop/s; %lld solves",
           s->factor_entries, s->factor_flops, t->factor / fmax(1.0, (double)m->factorisations),
           1e-9 * rate, (long long)s->solves);
    pm_log(1, "CPU s: order %.2f, assemble %.2f, factor %.2f, solve %.2f, turn %.2f", t->order,
           t->assemble, t->factor, t->solve, t->warp);
}

static enum pm_status solve(const struct fesolve_opts *o, struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t nc = s->mesh.nc;
    struct pm_model *m = NULL;
    struct pm_config c = {0};
    struct pm_solve_options options = pm_solve_default;
    struct pm_solve_report r;
    double *p = NULL, *f = NULL, *Jq = NULL, low;
    options.tolerance = o->tolerance;
    PM_TRY(pm_model_new(&s->mesh, o->element, &m, err));
    PM_TRY(pm_config_new(m, &c, err));
    PM_TRY(PM_NEW(p, nc, err));
    PM_TRY(PM_NEW(f, 3 * m->nn, err));
    PM_TRY(PM_NEW(Jq, nc * m->nq, err));
    PM_TRY(PM_NEW(s->J, 6 * nc, err));
    PM_TRY(PM_NEW(s->volume, nc, err));
    PM_TRY(PM_NEW(s->volume0, nc, err));
    pm_model_potential(m, &c, p, NULL, s->volume0, &low);
    for (ptrdiff_t i = 0; i < nc; i++)
        p[i] = s->pressure[i] * m->law.mu;
    if (o->limit)
        PM_TRY(seek_limit(o, m, p, &c, f, &r, s, err));
    else
        PM_TRY(pm_start(m, p, &options, o->guess, &c, s->volume, f, &r, err));
    const long before = m->factorisations;
    PM_TRY(pm_jacobian(m, &c, m->law.mu, Jq, s->J, err));
    r.factorisations += m->factorisations - before;
    reaction(m, &c, f, s->reaction);
    PM_TRY(pm_config_store(m, &c, s, err));
    snprintf(s->element, sizeof s->element, "%s", m->space.type->name);
    s->energy = r.energy;
    s->residual = r.residual;
    s->min_det_F = r.min_det_F;
    s->load_steps = r.load_steps;
    s->newton_steps = r.newton_steps;
    s->factorisations = r.factorisations;
    s->backoffs = r.backoffs;
    s->unknowns = m->nq;
    s->solves = m->solves;
    pm_cholesky_size(m->factor, &s->factor_entries, &s->factor_flops);
    s->stable = 1;
    s->warm = r.warm;
    pm_log(1,
           "%td unknowns: %ld load steps, %ld Newton steps, %ld factorisations, %ld back-offs%s, "
           "residual %.1e",
           m->nq, r.load_steps, r.newton_steps, r.factorisations, r.backoffs,
           r.warm ? ", warm" : "", r.residual);
    tell_cost(m, s);
    pm_log(1, "U = %.6f %.6f %.6f mm, %.6f %.6f %.6f rad; smallest det F %.3f", s->U[0], s->U[1],
           s->U[2], s->U[3], s->U[4], s->U[5], s->min_det_F);
    PM_TRY(pm_contact_find(&s->mesh, s->u, &s->contact, err));
    pm_contact_tell(&s->contact);
done:
    pm_config_release(&c);
    pm_model_free(m);
    pm_free(p);
    pm_free(f);
    pm_free(Jq);
    return status;
}

enum pm_status fesolve_run(const struct fesolve_opts *o, const struct pm_common *common,
                           struct pm_err *err)
{
    enum pm_status status;
    struct pm_state s = {0};
    struct pm_h5 *out = NULL;
    if (o->limit && (o->nguess > 0 || o->path != NULL))
        return pm_fail(err, PM_USAGE,
                       "option --limit starts from zero: not with --guess or --path");
    if (o->have_load + (o->npressure > 0) + (o->path != NULL) != 1)
        return pm_fail(err, PM_USAGE, "expected exactly one of --load, --pressure and --path");
    pm_threads_set((int)o->threads);
    PM_TRY(pm_material_check(&o->material, err));
    PM_TRY(pm_mesh_load(common->operands[0], o->record_failure && o->path == NULL, &s.mesh, err));
    if (s.mesh.failure[0] != '\0') {
        snprintf(s.failure, sizeof s.failure, "%s", s.mesh.failure);
        s.form = o->have_form ? o->form : s.mesh.pcase.form;
        s.load = o->have_load ? o->load : -1;
    } else {
        if (o->material.law != NULL || o->material.preset != NULL || o->material.kappa > 0)
            PM_TRY(pm_case_set_material(&s.mesh.pcase, &o->material, err));
        if (o->path != NULL) {
            status = fesolve_path(o, common, &s.mesh, err);
            goto done;
        }
        PM_TRY(choose_load(o, &s, err));
        status = solve(o, &s, err);
        if (status == PM_NUMERIC && o->record_failure) {
            snprintf(s.failure, sizeof s.failure, "fesolve: %.490s", err->text);
            pm_warn("%s", err->text);
            *err = (struct pm_err){0};
        } else if (status != PM_OK) {
            goto done;
        }
    }
    PM_TRY(pm_h5_create(common->output, "state", common, o->guess, &out, err));
    PM_TRY(pm_state_write(out, &s, err));
    status = pm_h5_commit(out, err);
    out = NULL;
done:
    pm_h5_close(out);
    pm_state_release(&s);
    return status;
}
