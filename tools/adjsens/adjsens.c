#include "tools/adjsens/adjsens.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/sens.h"
#include "common/geometry/closeness.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/restore.h"

/* The work file's row of the state's load. */
static enum pm_status find_row(const char *path, struct adjsens_point *pt, struct pm_err *err)
{
    const struct pm_work *w = &pt->work;
    const struct pm_state *s = &pt->state;
    for (pt->row = 0; pt->row < w->ng; pt->row++)
        if (w->form == s->form && w->load[pt->row] == s->load)
            break;
    if (pt->row == w->ng)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': it has no row for load %lld of the state's form", path,
                       (long long)s->load);
    for (int l = 0; l < 6; l++)
        if (w->nc != s->mesh.nc || w->U[6 * pt->row + l] != s->U[l])
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': its row for load %lld belongs to another state", path,
                           (long long)s->load);
    return PM_OK;
}

/* Factor of the exact tangent at the state, forces, Jacobian. */
static enum pm_status restore(struct adjsens_point *pt, struct pm_err *err)
{
    enum pm_status status;
    struct pm_state *s = &pt->state;
    ptrdiff_t nc = s->mesh.nc;
    double low;
    int definite;
    PM_TRY(pm_model_new(&s->mesh, s->element, &pt->m, err));
    PM_TRY(pm_config_new(pt->m, &pt->c, err));
    PM_TRY(pm_config_restore(pt->m, s, &pt->c, err));
    PM_TRY(PM_NEW(pt->p, nc, err));
    PM_TRY(PM_NEW(pt->f, 3 * pt->m->nn, err));
    PM_TRY(PM_NEW(pt->Jq, nc * pt->m->nq, err));
    PM_TRY(PM_NEW(pt->J, 6 * nc, err));
    for (ptrdiff_t r = 0; r < nc; r++)
        pt->p[r] = s->pressure[r] * pt->m->law.mu;
    pm_model_potential(pt->m, &pt->c, pt->p, pt->f, NULL, &low);
    PM_TRY(pm_model_factor(pt->m, &pt->c, pt->p, pt->f, NULL, &definite, err));
    if (!definite) {
        status = pm_fail(err, PM_NUMERIC,
                         "the tangent at the state is not positive definite: no gradient there");
        goto done;
    }
    PM_TRY(pm_jacobian(pt->m, &pt->c, pt->m->law.mu, pt->Jq, pt->J, err));
done:
    return status;
}

/* Bit i: the mesh has a symmetry plane across axis i, here through the origin. */
static unsigned planes_of(const struct pm_mesh *m)
{
    unsigned planes = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        if (m->tri_tag[f] <= PM_FACE_SYM_X)
            planes |= 1u << (PM_FACE_SYM_X - m->tri_tag[f]);
    return planes;
}

/* Largest part of the three axes that are not in `except`. */
static double largest(const double x[3], const double y[3], double size, unsigned except)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        if (!(except >> i & 1))
            most = fmax(most, fabs(x[i] - y[i]) / size);
    return most;
}

/* Relative defects of D under translation, scaling and rotation of the body [model 4.3]: exact
 * identities of the motions that keep the symmetry planes. */
static void identities(const struct adjsens_point *pt, const double *D, const double D_ref[3],
                       struct pm_sens *out)
{
    const struct pm_mesh *mesh = &pt->state.mesh;
    ptrdiff_t nc = mesh->nc;
    const double *a = pt->work.dw_dU + 6 * pt->row, *b = pt->work.dw_dJ + 6 * nc * pt->row,
                 *U = pt->state.U;
    double sum[3] = {D_ref[0], D_ref[1], D_ref[2]}, X[3], turn[3] = {0}, want[3] = {0}, scale = 0.0,
           size[3] = {0}, Euler = 0.0;
    for (ptrdiff_t n = 0; n <= mesh->nn; n++) {
        const double *x = n < mesh->nn ? mesh->x + 3 * n : mesh->reference_point,
                     *d = n < mesh->nn ? D + 3 * n : D_ref;
        memcpy(X, x, sizeof X);
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            sum[i] += n < mesh->nn ? d[i] : 0.0;
            scale += X[i] * d[i];
            turn[i] += X[j] * d[k] - X[k] * d[j]; /* D.(e_i x X) */
            size[0] += fabs(d[i]);
            size[1] += fabs(X[i] * d[i]);
            size[2] += fabs(X[j] * d[k]) + fabs(X[k] * d[j]);
        }
    }
    for (ptrdiff_t c = -1; c < nc; c++) /* U, then the columns of J */
        for (int l = 0; l < 6; l += 3)
            for (int i = 0; i < 3; i++) {
                int j = (i + 1) % 3, k = (i + 2) % 3;
                const double g[3] = {c < 0 ? a[l] : b[l * nc + c],
                                     c < 0 ? a[l + 1] : b[(l + 1) * nc + c],
                                     c < 0 ? a[l + 2] : b[(l + 2) * nc + c]};
                const double v[3] = {c < 0 ? U[l] : pt->J[l * nc + c],
                                     c < 0 ? U[l + 1] : pt->J[(l + 1) * nc + c],
                                     c < 0 ? U[l + 2] : pt->J[(l + 2) * nc + c]};
                want[i] += v[j] * g[k] - v[k] * g[j];
                Euler += l == 0 ? g[i] * v[i] : 0.0;
            }
    for (ptrdiff_t i = 0; i < 3 * mesh->nn && pt->near != NULL; i++)
        Euler += pt->near[i] * (mesh->x[i] + pt->state.u[i]);
    const unsigned planes = planes_of(mesh);
    unsigned turned = 0; /* turns about the normal of the only plane */
    for (unsigned i = 0; i < 3; i++)
        if ((planes & ~(1u << i)) != 0)
            turned |= 1u << i;
    out->identity_translation = largest(sum, (const double[3]){0}, size[0], planes);
    out->identity_scaling = fabs(scale - Euler) / size[1];
    out->identity_rotation = largest(turn, want, size[2], turned);
}

struct pm_adjoint_at adjsens_at(const struct adjsens_point *pt)
{
    return (struct pm_adjoint_at){
        .m = pt->m, .c = &pt->c, .p = pt->p, .f = pt->f, .Jq = pt->Jq, .scale = pt->m->law.mu};
}

enum pm_status adjsens_pull_back(struct adjsens_point *pt, enum pm_shape_form form, double *D,
                                 double *g, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_mesh *mesh = &pt->state.mesh;
    if (form == PM_SHAPE_DOMAIN) {
        if (pt->extension == NULL)
            PM_TRY(pm_extension_new(mesh, &pt->extension, err));
        PM_TRY(pm_extension_transpose(pt->extension, D, err));
    }
    pm_mesh_pull_back(mesh, D, g);
done:
    return status;
}

static int is_close(const struct adjsens_point *pt)
{
    return pt->work.dw_dG[pt->row] != 0 && pt->work.closeness_at[pt->row] > 0;
}

/* A guard within its limits has no part in the objective. */
static int without_weight(const struct adjsens_point *pt)
{
    const ptrdiff_t n = 6 * pt->state.mesh.nc;
    for (ptrdiff_t i = 0; i < 6; i++)
        if (pt->work.dw_dU[6 * pt->row + i] != 0)
            return 0;
    for (ptrdiff_t i = 0; i < n; i++)
        if (pt->work.dw_dJ[n * pt->row + i] != 0)
            return 0;
    return !is_close(pt);
}

/* The closeness of the state by parts: the objective and one function of each. */
static enum pm_status take_closeness(const struct adjsens_opts *o, struct adjsens_point *pt,
                                     struct pm_objective *w, double *near, struct pm_sens *out,
                                     struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t size = 3 * pt->m->nn;
    double G[PM_CLOSENESS_PARTS];
    if (o->form == PM_SHAPE_BOUNDARY)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "the body comes closer to itself than gap_min: the boundary form does not "
                       "know of that, expected gap_min = 0"));
    PM_TRY(PM_NEW(out->close_value, PM_CLOSENESS_PARTS, err));
    PM_TRY(PM_NEW(pt->near, size, err));
    PM_TRY(pm_closeness(&pt->state.mesh, pt->state.u, G, near, err));
    for (int p = 0; p < PM_CLOSENESS_PARTS; p++) {
        if (!(G[p] > 0))
            continue;
        out->close_value[out->nclose++] = G[p];
        w[out->nclose].x = near + size * p;
        for (ptrdiff_t i = 0; i < size; i++)
            pt->near[i] += pt->work.dw_dG[pt->row] * near[size * p + i];
    }
    w[0].x = pt->near;
done:
    return status;
}

static enum pm_status differentiate(const struct adjsens_opts *o, struct adjsens_point *pt,
                                    struct pm_sens *out, struct pm_err *err)
{
    enum { MOST = 1 + PM_CLOSENESS_PARTS };
    enum pm_status status;
    struct pm_mesh *mesh = &pt->state.mesh;
    const struct pm_adjoint_at at = adjsens_at(pt);
    struct pm_objective w[MOST] = {{.V = {0}}};
    const ptrdiff_t nc = mesh->nc, size = 3 * pt->m->nn;
    double *D = NULL, *near = NULL, D_ref[3 * MOST];
    PM_TRY(PM_NEW(out->gradient, 3 * mesh->N, err));
    for (ptrdiff_t l = 0; l < 6; l++) {
        w[0].U[l] = pt->work.dw_dU[6 * pt->row + l];
        for (ptrdiff_t r = 0; r < nc; r++)
            w[0].J[l][r] = pt->work.dw_dJ[6 * nc * pt->row + nc * l + r];
    }
    if (is_close(pt)) {
        PM_TRY(PM_NEW(near, PM_CLOSENESS_PARTS * size, err));
        PM_TRY(take_closeness(o, pt, w, near, out, err));
        PM_TRY(PM_NEW(out->close_gradient, out->nclose * 3 * mesh->N, err));
    }
    PM_TRY(PM_NEW(D, (1 + out->nclose) * size, err));
    PM_TRY(pm_adjoint(&at, 1 + out->nclose, w, o->form, D, D_ref, err));
    if (o->form == PM_SHAPE_DOMAIN) {
        identities(pt, D, D_ref, out);
        pm_log(1, "identities: translation %.1e, scaling %.1e, rotation %.1e",
               out->identity_translation, out->identity_scaling, out->identity_rotation);
    }
    PM_TRY(adjsens_pull_back(pt, o->form, D, out->gradient, err));
    for (ptrdiff_t k = 0; k < out->nclose; k++)
        PM_TRY(adjsens_pull_back(pt, o->form, D + size * (1 + k),
                                 out->close_gradient + 3 * mesh->N * k, err));
done:
    pm_free(near);
    pm_free(D);
    return status;
}

static void tell_cost(const struct adjsens_point *pt, clock_t start)
{
    const struct pm_cost *c = &pt->m->cost;
    double all = (double)(clock() - start) / CLOCKS_PER_SEC;
    pm_log(1,
           "%td unknowns, CPU s: ordering %.2f, assembly %.2f, factorisation %.2f, solves %.2f, "
           "all %.2f; without ordering and assembly %.2f factorisations",
           pt->m->nq, c->order, c->assemble, c->factor, c->solve, all,
           (all - c->order - c->assemble) / c->factor);
}

/* Everything that needs the factor of the state. */
static enum pm_status solve(const struct adjsens_opts *o, struct adjsens_point *pt, int weighted,
                            struct pm_sens *out, struct pm_err *err)
{
    enum pm_status status;
    const clock_t start = clock();
    PM_TRY(restore(pt, err));
    if (weighted)
        PM_TRY(differentiate(o, pt, out, err));
    PM_TRY(adjsens_entries(o, pt, out, err));
    tell_cost(pt, start);
    if (o->check)
        PM_TRY(adjsens_check(o, pt, out->gradient, err));
done:
    return status;
}

static void release(struct adjsens_point *pt)
{
    pm_extension_free(pt->extension);
    pm_model_free(pt->m);
    pm_config_release(&pt->c);
    pm_free(pt->p);
    pm_free(pt->f);
    pm_free(pt->Jq);
    pm_free(pt->J);
    pm_free(pt->near);
    pm_state_release(&pt->state);
    pm_work_release(&pt->work);
}

static enum pm_status check_usage(const struct adjsens_opts *o, const struct pm_common *c,
                                  struct pm_err *err)
{
    if (c->noperands < 2 && !o->each && !o->nodal)
        return pm_fail(err, PM_USAGE,
                       "got no WORK.h5, expected one: only --each and --nodal need none");
    if (c->noperands < 2 && o->check)
        return pm_fail(err, PM_USAGE, "--check needs WORK.h5");
    if (o->check && o->form == PM_SHAPE_BOUNDARY)
        return pm_fail(err, PM_USAGE,
                       "--check is of the domain form: the boundary form is not the derivative of "
                       "the discrete problem");
    return PM_OK;
}

static enum pm_status load(const struct adjsens_opts *o, const struct pm_common *common,
                           struct adjsens_point *pt, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_state_load(common->operands[0], 0, &pt->state, err));
    if (pt->state.mesh.N == 0 && (common->noperands > 1 || o->each))
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': its mesh was imported and has no control points, "
                       "expected one made from surfaces, or --nodal alone",
                       common->operands[0]));
    if (common->noperands > 1) {
        PM_TRY(pm_work_load(common->operands[1], 0, &pt->work, err));
        PM_TRY(find_row(common->operands[1], pt, err));
    }
done:
    return status;
}

enum pm_status adjsens_run(const struct adjsens_opts *o, const struct pm_common *common,
                           struct pm_err *err)
{
    enum pm_status status;
    struct adjsens_point pt = {.row = 0};
    struct pm_sens sens = {.N = 0};
    struct pm_h5 *out = NULL;
    PM_TRY(check_usage(o, common, err));
    PM_TRY(load(o, common, &pt, err));
    const int given = common->noperands > 1, weighted = given && !without_weight(&pt);
    if (given && !weighted && o->check)
        PM_TRY(pm_fail(err, PM_INPUT, "the objective does not depend on '%s': nothing to check",
                       common->operands[0]));
    if (given && !weighted)
        PM_TRY(PM_NEW(sens.gradient, 3 * pt.state.mesh.N, err));
    if (weighted || o->each || o->nodal)
        PM_TRY(solve(o, &pt, weighted, &sens, err));
    else
        pm_log(1, "the objective does not depend on this point: its gradient is zero");
    sens.form = pt.state.form;
    sens.load = pt.state.load;
    sens.shape_form = o->form;
    sens.N = pt.state.mesh.N;
    PM_TRY(pm_case_copy(&pt.state.mesh.pcase, &sens.pcase, err));
    PM_TRY(pm_h5_create(common->output, "sens", common, NULL, &out, err));
    PM_TRY(pm_sens_write(out, &sens, err));
    status = pm_h5_commit(out, err);
    out = NULL;
done:
    pm_h5_close(out);
    pm_sens_release(&sens);
    release(&pt);
    return status;
}
