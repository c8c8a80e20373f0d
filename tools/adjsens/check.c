/* adjsens --check: central differences of surface -> morph -> equilibrium -> measure. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/actuation/amplification.h"
#include "common/actuation/measure.h"
#include "common/base/memory.h"
#include "common/geometry/closeness.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/equilibrium.h"
#include "common/mechanics/restore.h"
#include "tools/adjsens/adjsens.h"

/* Largest relative errors that pass: in random directions, by one control point. */
static const double WANTED = 1e-6, WANTED_ALONE = 1e-5;

/* What one difference needs: the state's mesh with other node positions. */
struct probe {
    struct adjsens_point *pt;
    struct pm_load load;
    double sigma_weight; /* of the point's contribution */
    double closeness_slope;
    double *x0, *dx; /* node positions at the design and their rate along the direction (nn x 3) */
    double *u;       /* displacements, work (nn x 3) */
};

/* The objective at x0 + s dx, all other points as they are: solved from the state as guess. */
static enum pm_status evaluate(const struct probe *pr, double s, double *objective,
                               struct pm_err *err)
{
    enum pm_status status;
    struct adjsens_point *pt = pr->pt;
    struct pm_mesh *mesh = &pt->state.mesh;
    ptrdiff_t nc = mesh->nc;
    struct pm_model *m = NULL;
    struct pm_config c = {0};
    struct pm_solve_report report;
    struct pm_solve_options o = pm_solve_default;
    double *f = NULL, *V = NULL, *Jq = NULL, *J = NULL, *dJ = NULL, dU[6], w, most,
           G[PM_CLOSENESS_PARTS];
    double *own = pt->work.J + 6 * nc * pt->row;
    o.tolerance = 2e-10; /* a little above the rounding floor of the residual */
    for (ptrdiff_t k = 0; k < 3 * mesh->nn; k++)
        mesh->x[k] = pr->x0[k] + s * pr->dx[k];
    PM_TRY(pm_model_new(mesh, pt->state.element, &m, err));
    PM_TRY(pm_config_new(m, &c, err));
    pm_config_copy(m, &pt->c, &c);
    PM_TRY(PM_NEW(f, 3 * m->nn, err));
    PM_TRY(PM_NEW(V, nc, err));
    PM_TRY(PM_NEW(Jq, nc * m->nq, err));
    PM_TRY(PM_NEW(J, 6 * nc, err));
    PM_TRY(PM_NEW(dJ, 6 * nc, err));
    PM_TRY(pm_equilibrium(m, pt->p, &o, &(struct pm_guess){.at = pt->p}, &c, V, f, &report, err));
    PM_TRY(pm_jacobian(m, &c, m->law.mu, Jq, J, err));
    PM_TRY(pm_measure_point(&mesh->pcase, (enum pm_form)pt->state.form, &pr->load, c.U, J, &w, dU,
                            dJ, err));
    const double value = pt->work.value - pt->work.w[pt->row] + pr->sigma_weight * w;
    memcpy(dJ, own, (size_t)(6 * nc) * sizeof *dJ);
    memcpy(own, J, (size_t)(6 * nc) * sizeof *own);
    pm_config_displacement(m, &c, pr->u);
    PM_TRY(pm_closeness(mesh, pr->u, G, NULL, err));
    *objective = value * pm_amplification(&mesh->pcase, pt->work.ng, pt->work.J, &most, NULL) *
                 exp(pr->closeness_slope * (pm_closeness_sum(G) - pt->work.closeness_at[pt->row])) *
                 pm_closeness_factor(pt->work.closeness);
    memcpy(own, dJ, (size_t)(6 * nc) * sizeof *own);
done:
    memcpy(mesh->x, pr->x0, 3 * (size_t)mesh->nn * sizeof *mesh->x);
    pm_model_free(m);
    pm_config_release(&c);
    pm_free(f);
    pm_free(V);
    pm_free(Jq);
    pm_free(J);
    pm_free(dJ);
    return status;
}

/* Uniform in [0, 1) by a 64-bit congruential generator (Knuth's MMIX constants). */
static double uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

/* Random direction uphill, so that its derivative is no small difference of large terms: which = 1
 * chambers, 2 exterior, 3 both; largest displacement 1. Control points
 * of the fixed rims do not move. */
static void random_direction(const struct pm_mesh *mesh, const uint8_t *part, const double *g,
                             int which, uint64_t *seed, double *d)
{
    double most = 0.0;
    for (ptrdiff_t k = 0; k < mesh->N; k++) {
        double size = 0.0;
        for (int i = 0; i < 3; i++) {
            double v = copysign(uniform(seed), g[3 * k + i]);
            d[3 * k + i] = (part[k] & which) != 0 ? v : 0.0;
            size += d[3 * k + i] * d[3 * k + i];
        }
        most = fmax(most, sqrt(size));
    }
    for (ptrdiff_t k = 0; k < 3 * mesh->N && most > 0.0; k++)
        d[k] /= most;
}

/* part[m]: 1 chamber control point, 2 exterior, 0 moves a node of the base or tip plane (a rim:
 * fixed). */
static void classify(const struct pm_mesh *mesh, uint8_t *part)
{
    for (ptrdiff_t a = 0; a < mesh->nn; a++)
        for (int64_t k = mesh->wptr[a]; k < mesh->wptr[a + 1]; k++)
            if (mesh->surface[a] >= 0)
                part[mesh->wcol[k]] = mesh->surface[a] > 0 ? 1 : 2;
    for (ptrdiff_t f = 0; f < mesh->nf; f++)
        for (int a = 0; a < 6 && mesh->tri_tag[f] < 0; a++) {
            int32_t node = mesh->tri[6 * f + a];
            for (int64_t k = mesh->wptr[node]; k < mesh->wptr[node + 1]; k++)
                part[mesh->wcol[k]] = 0;
        }
}

/* Rate of the node positions along a control point direction: W d on surface nodes, extended. */
static enum pm_status node_rates(struct adjsens_point *pt, const double *d, double *dx,
                                 struct pm_err *err)
{
    const struct pm_mesh *mesh = &pt->state.mesh;
    memset(dx, 0, 3 * (size_t)mesh->nn * sizeof *dx);
    for (ptrdiff_t a = 0; a < mesh->nn; a++)
        for (int64_t k = mesh->wptr[a]; k < mesh->wptr[a + 1]; k++)
            for (int i = 0; i < 3; i++)
                dx[3 * a + i] += mesh->wval[k] * d[3 * (ptrdiff_t)mesh->wcol[k] + i];
    return pm_extension_apply(pt->extension, dx, err);
}

/* Sweep of step sizes in the direction d: prints each and the plateau; *worst takes the smallest
 * relative error over `bound`. */
static enum pm_status sweep(struct probe *pr, const char *label, const double *g, const double *d,
                            double radius, double bound, double *worst, struct pm_err *err)
{
    enum { STEPS = 4 };
    enum pm_status status;
    double best = INFINITY, at = 0.0, exact = 0.0, before = 0.0;
    for (ptrdiff_t k = 0; k < 3 * pr->pt->state.mesh.N; k++)
        exact += g[k] * d[k];
    PM_TRY(node_rates(pr->pt, d, pr->dx, err));
    for (int k = 0; k < STEPS; k++, radius /= 4) {
        double up, down, fd, e;
        PM_TRY(evaluate(pr, radius, &up, err));
        PM_TRY(evaluate(pr, -radius, &down, err));
        fd = (up - down) / (2 * radius);
        /* with the step before: without the error of second order (Richardson) */
        e = fabs((k > 0 ? fd + (fd - before) / 15 : fd) - exact) / fabs(exact);
        before = fd;
        printf("%-14s step %.2e  adjoint %+.10e  differences %+.10e  relative error %.2e, "
               "extrapolated %.2e\n",
               label, radius, exact, fd, fabs(fd - exact) / fabs(exact), e);
        at = e < best ? radius : at;
        best = fmin(best, e);
    }
    printf("%-14s plateau at %.2e: relative error %.2e (wanted %.0e)\n", label, at, best, bound);
    *worst = fmax(*worst, best / bound);
done:
    return status;
}

/* Direction of one control point, chosen among those of a surface that may move. */
static int single_direction(const struct pm_mesh *mesh, const uint8_t *part, ptrdiff_t low,
                            ptrdiff_t high, uint64_t *seed, double *d)
{
    memset(d, 0, 3 * (size_t)mesh->N * sizeof *d);
    for (int attempt = 0; attempt < 1000; attempt++) {
        ptrdiff_t k = low + (ptrdiff_t)(uniform(seed) * (double)(high - low));
        if (part[k] == 0)
            continue;
        for (int i = 0; i < 3; i++)
            d[3 * k + i] = 2.0 * uniform(seed) - 1.0;
        return (int)k;
    }
    return -1;
}

static enum pm_status check_points(const struct adjsens_opts *o, struct probe *pr,
                                   const uint8_t *part, const double *g, uint64_t *seed, double *d,
                                   double *worst, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_mesh *mesh = &pr->pt->state.mesh;
    ptrdiff_t low = 0;
    for (int32_t surface = 0; surface <= mesh->nc; surface++) {
        ptrdiff_t high = low; /* control points stand by surface */
        for (ptrdiff_t a = 0; a < mesh->nn; a++)
            for (int64_t k = mesh->wptr[a]; k < mesh->wptr[a + 1] && mesh->surface[a] == surface;
                 k++)
                high = mesh->wcol[k] + 1 > high ? mesh->wcol[k] + 1 : high;
        for (long i = 0; i < o->points; i++) {
            char label[40];
            int k = single_direction(mesh, part, low, high, seed, d);
            if (k < 0)
                break;
            snprintf(label, sizeof label, "surface %d:%td", (int)surface, k - low);
            PM_TRY(sweep(pr, label, g, d, o->radius, WANTED_ALONE, worst, err));
        }
        low = high;
    }
done:
    return status;
}

static enum pm_status prepare(struct adjsens_point *pt, struct probe *pr, struct pm_err *err)
{
    enum pm_status status;
    struct pm_load *set = NULL;
    ptrdiff_t n;
    PM_TRY(pm_load_set(&pt->state.mesh.pcase, (enum pm_form)pt->state.form, &set, &n, err));
    if (pt->state.load < 0 || pt->state.load >= n) {
        status = pm_fail(err, PM_INPUT, "the state's load %lld is not in its Gauss set",
                         (long long)pt->state.load);
        goto done;
    }
    pr->load = set[pt->state.load];
    pr->sigma_weight = pt->work.orientation * pr->load.weight;
    pr->closeness_slope = pm_closeness_slope(pr->load.multiplicity);
    PM_TRY(PM_NEW(pr->u, 3 * pt->state.mesh.nn, err));
    PM_TRY(PM_NEW(pr->x0, 3 * pt->state.mesh.nn, err));
    PM_TRY(PM_NEW(pr->dx, 3 * pt->state.mesh.nn, err));
    memcpy(pr->x0, pt->state.mesh.x, 3 * (size_t)pt->state.mesh.nn * sizeof *pr->x0);
done:
    pm_free(set);
    return status;
}

enum pm_status adjsens_check(const struct adjsens_opts *o, struct adjsens_point *pt,
                             const double *g, struct pm_err *err)
{
    static const char *const label[] = {NULL, "chambers", "exterior", "both"};
    enum pm_status status;
    const struct pm_mesh *mesh = &pt->state.mesh;
    struct probe pr = {.pt = pt};
    uint8_t *part = NULL;
    double *d = NULL, worst = 0.0;
    uint64_t seed = (uint64_t)o->seed;
    PM_TRY(PM_NEW(part, mesh->N, err));
    PM_TRY(PM_NEW(d, 3 * mesh->N, err));
    PM_TRY(prepare(pt, &pr, err));
    classify(mesh, part);
    for (int which = 1; which <= 3; which++) {
        random_direction(mesh, part, g, which, &seed, d);
        PM_TRY(sweep(&pr, label[which], g, d, o->radius, WANTED, &worst, err));
    }
    PM_TRY(check_points(o, &pr, part, g, &seed, d, &worst, err));
    if (!(worst <= 1.0))
        status =
            pm_fail(err, PM_NUMERIC,
                    "the gradient differs from differences by %.2g times what is allowed", worst);
done:
    pm_free(part);
    pm_free(d);
    pm_free(pr.x0);
    pm_free(pr.dx);
    pm_free(pr.u);
    return status;
}
