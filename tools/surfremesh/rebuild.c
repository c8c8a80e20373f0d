#include "tools/surfremesh/rebuild.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/fit.h"
#include "common/geometry/samples.h"
#include "common/geometry/symmetry.h"
#include "tools/surfremesh/chamber.h"
#include "tools/surfremesh/exterior.h"

static const double CV_MAX = 0.25, SPACING_OFF = 0.15, UNEVEN_MAX = 2.0;

static enum pm_status plan_chamber(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    const struct pm_surfaces *s = r->from;
    struct pm_spacing now;
    enum pm_status status = pm_spacing_of(&s->s[k], &now, err);
    double wanted = r->o->spacing > 0 ? r->o->spacing : s->pcase.chamber[k - 1].spacing;

    if (status != PM_OK)
        return status;
    if (r->o->points > 0)
        wanted = sqrt(now.area / (sqrt(0.75) * (double)r->o->points));
    r->spacing[k] = wanted;
    r->report->spacing_before[k] = now.cv;
    r->redo[k] = r->o->spacing > 0 || r->o->points > 0 || now.cv > CV_MAX ||
                 fabs(now.mean / wanted - 1) > SPACING_OFF;
    return PM_OK;
}

enum pm_status rebuild_plan(struct rebuild *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surfaces *s = r->from;
    ptrdiff_t g;

    PM_TRY(pm_exterior_unevenness(&s->s[0], &r->report->spacing_before[0], err));
    r->redo[0] = r->report->spacing_before[0] > UNEVEN_MAX;
    for (ptrdiff_t k = 1; k < s->ns; k++)
        PM_TRY(plan_chamber(r, k, err));
    for (ptrdiff_t k = 1; k < s->ns; k++) { /* the first of an orbit decides */
        ptrdiff_t source = 1 + pm_symmetry_source(&s->pcase.symmetry, k - 1, &g);
        r->redo[k] = r->redo[source];
        r->spacing[k] = r->spacing[source];
    }
done:
    return status;
}

static enum pm_status copy_surface(const struct pm_surface *from, struct pm_surface *to,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;

    *to = (struct pm_surface){
        .type = from->type, .n = from->n, .nu = from->nu, .nv = from->nv, .nt = from->nt};
    PM_TRY(PM_NEW(to->phi, 3 * to->n, err));
    PM_TRY(PM_NEW(to->free, 3 * to->n, err));
    PM_TRY(PM_NEW(to->Phi, 3 * to->n, err));
    PM_TRY(PM_NEW(to->d0, to->n, err));
    PM_TRY(PM_NEW(to->tri, 3 * to->nt, err));
    memcpy(to->phi, from->phi, 3 * (size_t)to->n * sizeof *to->phi);
    memcpy(to->free, from->free, 3 * (size_t)to->n);
    memcpy(to->Phi, from->Phi, 3 * (size_t)to->n * sizeof *to->Phi);
    memcpy(to->d0, from->d0, (size_t)to->n * sizeof *to->d0);
    memcpy(to->tri, from->tri, 3 * (size_t)to->nt * sizeof *to->tri);
done:
    return status;
}

/* New parameters; places still those of the old surfaces. */
static enum pm_status reseed(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surfaces *s = r->from;
    const struct pm_symmetry *y = &s->pcase.symmetry;

    PM_TRY(pm_case_copy(&s->pcase, &to->pcase, err));
    to->ns = s->ns;
    PM_TRY(PM_NEW(to->s, to->ns, err));
    PM_TRY(PM_NEW(to->offset, to->ns + 1, err));
    memcpy(to->reference_point, s->reference_point, sizeof to->reference_point);
    for (ptrdiff_t k = 0; k < to->ns; k++) {
        ptrdiff_t g = 0, source = k > 0 ? 1 + pm_symmetry_source(y, k - 1, &g) : 0;
        if (k == 0 || !r->redo[k])
            PM_TRY(copy_surface(&s->s[k], &to->s[k], err));
        else if (source < k)
            PM_TRY(pm_symmetry_image(y, g, &to->s[source], &to->s[k], err));
        else
            PM_TRY(pm_chamber_remesh(s, k, r->spacing[k], &to->s[k], err));
        to->offset[k + 1] = to->offset[k] + to->s[k].n;
    }
    pm_free(r->shift);
    PM_TRY(PM_NEW(r->shift, 2 * s->s[0].n, err));
    if (r->redo[0])
        PM_TRY(pm_exterior_relax(&s->s[0], r->shift, err));
    /* images of new control points agree to the rounding of f_old */
    PM_TRY(pm_symmetry_find(to, 1e-6 * s->pcase.height, err));
    PM_TRY(pm_symmetrise_reference(to, err));
done:
    return status;
}

enum pm_status rebuild_start(const struct rebuild *r, ptrdiff_t k, const struct pm_map *old,
                             const double S[3], struct pm_basis *work, double out[3],
                             struct pm_err *err)
{
    memcpy(out, S, 3 * sizeof *out);
    return k > 0 ? PM_OK : pm_exterior_start(old, r->shift, S, work, out, err);
}

static enum pm_status fit(const struct rebuild *r, struct pm_surfaces *to,
                          const struct pm_samples *m, ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *from = &r->from->s[k];
    struct pm_surface *f = &to->s[k];
    struct pm_map *old = NULL, *map = NULL;
    struct pm_basis work = {0};
    uint8_t *fixed = NULL;
    ptrdiff_t first = m->first[k], nq = m->first[k + 1] - first;
    double *x = NULL, S[3], error[2];

    PM_TRY(pm_map_new(from, &old, err));
    PM_TRY(pm_map_new(f, &map, err));
    PM_TRY(PM_NEW(x, 3 * nq, err));
    PM_TRY(PM_NEW(fixed, 3 * f->n, err));
    for (ptrdiff_t i = 0; i < 3 * f->n; i++)
        fixed[i] = !f->free[i];
    for (ptrdiff_t q = 0; q < nq; q++) {
        PM_TRY(rebuild_start(r, k, old, &m->S[3 * (first + q)], &work, S, err));
        PM_TRY(pm_map_point(old, from->phi, S, &work, &x[3 * q], NULL, NULL, err));
    }
    const struct pm_fit job = {.nq = nq,
                               .S = &m->S[3 * first],
                               .weight = &m->area[first],
                               .target = x,
                               .alpha = k == 0 ? 1e-3 : r->o->alpha,
                               .iterations = (int)r->o->iterations,
                               .fixed = fixed};
    PM_TRY(pm_fit_points(map, f->n, &job, f->phi, error, err));
done:
    pm_map_free(old);
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    pm_free(fixed);
    return status;
}

enum pm_status rebuild_surfaces(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_samples m = {0};
    double *phi = NULL;

    PM_TRY(reseed(r, to, err));
    PM_TRY(pm_samples_new(to, HUGE_VAL, 2, &m, err));
    for (ptrdiff_t k = 0; k < to->ns; k++)
        if (r->redo[k])
            PM_TRY(fit(r, to, &m, k, err));
    PM_TRY(PM_NEW(phi, 3 * to->offset[to->ns], err));
    pm_surfaces_gather(to, phi);
    pm_symmetrise_points(to, phi);
    pm_surfaces_scatter(to, phi);
done:
    pm_samples_release(&m);
    pm_free(phi);
    return status;
}
