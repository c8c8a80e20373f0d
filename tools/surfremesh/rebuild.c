#include "tools/surfremesh/rebuild.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/record.h"
#include "common/geometry/distance.h"
#include "common/geometry/fit.h"
#include "common/geometry/symmetry.h"
#include "tools/surfremesh/chamber.h"
#include "tools/surfremesh/exterior.h"

static void drop_made(struct rebuild *r, ptrdiff_t k)
{
    pm_surface_release(&r->made[k]);
    pm_free(r->carried[k]);
    r->carried[k] = NULL;
}

void rebuild_release(struct rebuild *r)
{
    for (ptrdiff_t k = 0; k <= PM_MAX_CHAMBERS; k++)
        drop_made(r, k);
}

/* Samples of one surface, for its fit. */
struct target {
    ptrdiff_t nq;
    double *S;   /* new parameters (nq x 3) */
    double *old; /* where they lie on the old surface (nq x 3) */
    double *x;   /* the old surface there (nq x 3) [mm] */
    double *weight;
};

static void target_release(struct target *t)
{
    pm_free(t->S);
    pm_free(t->old);
    pm_free(t->x);
    pm_free(t->weight);
}

enum { FIT_CUTS = 2 };

/* The paper matches the control points alone, the others four samples a triangle by their area. */
static enum pm_status aim(const struct rebuild *r, const struct pm_samples *m, ptrdiff_t k,
                          const struct pm_map *old, struct target *t, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int paper = r->method[k] == SURFREMESH_PAPER;
    const struct pm_surface *f = &r->made[k];
    const double *carried = r->carried[k] != NULL ? r->carried[k] : f->Phi;
    struct pm_basis work = {0};

    t->nq = paper ? f->n : m->n;
    PM_TRY(pm_copy_array(&t->S, paper ? f->Phi : m->S, 3 * t->nq, sizeof *t->S, err));
    PM_TRY(PM_NEW(t->old, 3 * t->nq, err));
    PM_TRY(PM_NEW(t->x, 3 * t->nq, err));
    PM_TRY(PM_NEW(t->weight, t->nq, err));
    if (paper)
        memcpy(t->old, carried, 3 * (size_t)t->nq * sizeof *carried);
    else
        pm_samples_parameters(f, carried, FIT_CUTS, t->old);
    for (ptrdiff_t q = 0; q < t->nq; q++) {
        t->weight[q] = paper ? 1 : m->area[q];
        PM_TRY(pm_map_point(old, r->from->s[k].phi, &t->old[3 * q], &work, &t->x[3 * q], NULL, NULL,
                            err));
    }
done:
    pm_basis_release(&work);
    return status;
}

/* The targets become the feet of the fitted surface on the old one: where a sample lies along it
 * is free. */
static enum pm_status slide(const struct pm_surface *from, const struct pm_map *old,
                            const struct pm_surface *f, const struct pm_map *map, struct target *t,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis work = {0};

    for (ptrdiff_t q = 0; q < t->nq; q++) {
        double x[3], d;
        PM_TRY(pm_map_point(map, f->phi, &t->S[3 * q], &work, x, NULL, NULL, err));
        PM_TRY(pm_distance_project(old, from->type, from->phi, x, &work, &t->old[3 * q],
                                   &t->x[3 * q], &d, err));
    }
done:
    pm_basis_release(&work);
    return status;
}

static enum pm_status fit(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    enum { SLIDES = 2 };
    enum pm_status status = PM_OK;
    const struct pm_surface *from = &r->from->s[k];
    const int paper = r->method[k] == SURFREMESH_PAPER;
    struct pm_surface *f = &r->made[k];
    ptrdiff_t offset[2] = {0, f->n};
    const struct pm_surfaces alone = {.ns = 1, .s = f, .offset = offset};
    struct pm_samples m = {0};
    struct pm_map *old = NULL, *map = NULL;
    struct target t = {0};
    struct pm_fitter *fitter = NULL;
    uint8_t *fixed = NULL;
    double error[2];

    PM_TRY(pm_map_new(from, &old, err));
    PM_TRY(pm_map_new(f, &map, err));
    PM_TRY(PM_NEW(fixed, 3 * f->n, err));
    for (ptrdiff_t i = 0; i < 3 * f->n; i++)
        fixed[i] = !f->free[i];
    PM_TRY(pm_samples_new(&alone, HUGE_VAL, FIT_CUTS, &m, err));
    PM_TRY(aim(r, &m, k, old, &t, err));
    const long iterations = r->o->iterations > 0 ? r->o->iterations : paper ? 1 : 20;
    const struct pm_fit job = {.nq = t.nq,
                               .S = t.S,
                               .weight = t.weight,
                               .alpha = k == 0 ? 1e-3 : r->o->alpha,
                               .fixed = fixed};
    PM_TRY(pm_fitter_new(map, f->n, &job, &fitter, err));
    PM_TRY(pm_fitter_solve(fitter, t.x, (int)iterations, f->phi, error, err));
    for (int i = 0; i < SLIDES && !paper && r->carried[k] != NULL; i++) {
        PM_TRY(slide(from, old, f, map, &t, err));
        PM_TRY(pm_fitter_solve(fitter, t.x, (int)iterations, f->phi, error, err));
    }
done:
    pm_map_free(old);
    pm_map_free(map);
    pm_samples_release(&m);
    target_release(&t);
    pm_fitter_free(fitter);
    pm_free(fixed);
    return status;
}

enum pm_status rebuild_surface(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_surfaces *s = r->from;

    drop_made(r, k);
    if (k == 0)
        PM_TRY(pm_exterior_spread(&s->s[0], s->pcase.height, r->nu, r->nv, &r->made[0],
                                  &r->carried[0], err));
    else
        PM_TRY(
            pm_chamber_remesh(s, k, r->method[k], r->spacing[k], &r->made[k], &r->carried[k], err));
    PM_TRY(fit(r, k, err));
done:
    return status;
}

enum pm_status rebuild_join(const struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surfaces *s = r->from;
    const struct pm_symmetry *y = &s->pcase.symmetry;
    double *phi = NULL;

    pm_surfaces_release(to);
    PM_TRY(pm_case_copy(&s->pcase, &to->pcase, err));
    to->ns = s->ns;
    PM_TRY(PM_NEW(to->s, to->ns, err));
    PM_TRY(PM_NEW(to->offset, to->ns + 1, err));
    memcpy(to->reference_point, s->reference_point, sizeof to->reference_point);
    for (ptrdiff_t k = 0; k < to->ns; k++) {
        const ptrdiff_t source = r->source[k];
        if (r->redo[k] && source < k)
            PM_TRY(pm_symmetry_image(y, r->by[k], &to->s[source], &to->s[k], err));
        else
            PM_TRY(pm_surface_copy(r->redo[k] ? &r->made[k] : &s->s[k], &to->s[k], err));
        to->offset[k + 1] = to->offset[k] + to->s[k].n;
    }
    /* images of new control points agree to the rounding of the fit */
    PM_TRY(pm_symmetry_find(to, 1e-6 * s->pcase.height, err));
    PM_TRY(pm_symmetrise_reference(to, err));
    PM_TRY(PM_NEW(phi, 3 * to->offset[to->ns], err));
    pm_surfaces_gather(to, phi);
    pm_symmetrise_points(to, phi);
    pm_surfaces_scatter(to, phi);
done:
    pm_free(phi);
    return status;
}
