#include "tools/surfgen/surfgen.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/distance.h"
#include "common/geometry/fit.h"
#include "common/geometry/samples.h"
#include "common/geometry/symmetry.h"
#include "common/geometry/tube.h"
#include "tools/surfgen/body.h"
#include "tools/surfgen/chamber.h"
#include "tools/surfgen/design.h"
#include "tools/surfgen/files.h"

/* Shares of the spacing: a shape that its control points miss by more is doubtful, or not it. */
static const double WARNED = 0.1, REFUSED = 0.5;

/* What the surfaces are made from. */
struct plan {
    const struct pm_case *c;
    const struct surfgen_files *files;
    struct pm_surfgen_report *fit;
    struct pm_outline *outline;
    struct pm_profile profile[PM_MAX_CHAMBERS];
};

/* Points per ring: even, and a multiple of 12 where an operation other than a mirror or flip keeps
 * the chamber. */
static ptrdiff_t ring_multiple(const struct pm_symmetry *y, ptrdiff_t k)
{
    for (ptrdiff_t g = 0; g < y->nops; g++)
        if (y->chamber[g][k] == k && y->Q[g][1] != 0)
            return 12;
    return 2;
}

/* Surface k from its file: fitted already. */
static enum pm_status give(const struct plan *p, ptrdiff_t k, struct pm_surface *s,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_misfit misfit;

    PM_TRY(pm_files_surface(p->c, p->files, k, s, &misfit, err));
    p->fit->mean[k] = misfit.mean;
    p->fit->max[k] = misfit.max;
    pm_log(1,
           "surface %td: %td control points, distance from the wanted surface mean %.4f max %.4f "
           "mm at (%.4g, %.4g, %.4g)",
           k, s->n, misfit.mean, misfit.max, misfit.at[0], misfit.at[1], misfit.at[2]);
done:
    return status;
}

/* Surface k + 1: the image of an earlier chamber where there is one. */
static enum pm_status seed_chamber(const struct plan *p, ptrdiff_t k, struct pm_surfaces *s,
                                   struct pm_err *err)
{
    const struct pm_symmetry *y = &p->c->symmetry;
    ptrdiff_t g, r = pm_symmetry_source(y, k, &g);

    if (r < k)
        return pm_symmetry_image(y, g, &s->s[r + 1], &s->s[k + 1], err);
    if (pm_files_has(p->c, k + 1))
        return give(p, k + 1, &s->s[k + 1], err);
    return pm_chamber_seed(&p->c->chamber[k], &p->profile[k], ring_multiple(y, k), &s->s[k + 1],
                           err);
}

static enum pm_status seed(struct plan *p, struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_case *c = p->c;

    PM_TRY(pm_case_copy(c, &s->pcase, err));
    s->ns = 1 + c->nchambers;
    PM_TRY(PM_NEW(s->s, s->ns, err));
    PM_TRY(PM_NEW(s->offset, s->ns + 1, err));
    if (pm_files_has(c, 0)) {
        PM_TRY(give(p, 0, &s->s[0], err));
    } else {
        PM_TRY(pm_outline_new(c, &p->outline, err));
        PM_TRY(pm_body_seed(c, p->outline, &s->s[0], err));
    }
    for (ptrdiff_t k = 0; k < c->nchambers; k++) {
        if (!pm_files_has(c, k + 1))
            PM_TRY(pm_profile_new(&c->chamber[k], &p->profile[k], err));
        PM_TRY(seed_chamber(p, k, s, err));
    }
    for (ptrdiff_t k = 0; k < s->ns; k++)
        s->offset[k + 1] = s->offset[k] + s->s[k].n;
    PM_TRY(pm_symmetry_find(s, 1e-6 * c->height, err));
    for (ptrdiff_t k = 1; k < s->ns; k++)
        PM_TRY(pm_map_support(s->s[k].n, s->s[k].Phi, PM_MAP_NEIGHBOURS, s->s[k].d0, err));
    PM_TRY(pm_symmetrise_reference(s, err));
    s->reference_point[2] = c->height;
done:
    return status;
}

static void target(const struct plan *p, ptrdiff_t k, const double S[3], double x[3])
{
    if (k == 0) {
        pm_body_point(p->outline, S, x);
        return;
    }
    pm_profile_point(&p->profile[k - 1], S, x);
    for (int j = 0; j < 3; j++)
        x[j] += p->c->chamber[k - 1].center[j];
}

/* Distance of the wanted surface k from the fitted one: area-weighted mean and largest, at points
 * that the fit has not seen, and the mean spacing of its control points. */
static enum pm_status measure(const struct plan *p, ptrdiff_t k, struct pm_surface *f, double at[3],
                              double *spacing, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t offset[2] = {0, f->n};
    const struct pm_surfaces alone = {.ns = 1, .s = f, .offset = offset};
    struct pm_samples m = {0};
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double area = 0, sum = 0, *most = &p->fit->max[k];

    PM_TRY(pm_map_new(f, &map, err));
    PM_TRY(pm_samples_new(&alone, INFINITY, 3, &m, err));
    for (ptrdiff_t q = 0; q < m.n; q++) {
        double x[3], r[3], S[3], distance;
        memcpy(S, &m.S[3 * q], sizeof S);
        target(p, k, S, x);
        PM_TRY(pm_distance_project(map, f->type, f->phi, x, &work, S, r, &distance, err));
        area += m.area[q];
        sum += m.area[q] * distance;
        if (distance <= *most)
            continue;
        *most = distance;
        memcpy(at, x, sizeof x);
    }
    p->fit->mean[k] = sum / area;
    *spacing = sqrt(2 / sqrt(3) * area / (double)f->n); /* of as many equilateral triangles */
done:
    pm_basis_release(&work);
    pm_map_free(map);
    pm_samples_release(&m);
    return status;
}

/* Fits surface k to its shape. The heights of the exterior's rims are exact already, and those of
 * all rows where z is linear in v. */
static enum pm_status fit(const struct plan *p, struct pm_surfaces *s, const struct pm_samples *m,
                          ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surface *f = &s->s[k];
    ptrdiff_t first = m->first[k], nq = m->first[k + 1] - first;
    struct pm_map *map = NULL;
    uint8_t *fixed = NULL;
    double *x = NULL, *weight = NULL, rms[2];

    PM_TRY(pm_map_new(f, &map, err));
    PM_TRY(PM_NEW(x, 3 * nq, err));
    PM_TRY(PM_NEW(weight, nq, err));
    PM_TRY(PM_NEW(fixed, 3 * f->n, err));
    for (ptrdiff_t q = 0; q < nq; q++)
        target(p, k, &m->S[3 * (first + q)], &x[3 * q]);
    for (ptrdiff_t q = 0; q < nq;
         q++) /* not the area: regularisation would win where it is small */
        weight[q] = 1;
    for (ptrdiff_t i = 0; i < f->n; i++)
        fixed[3 * i + 2] =
            k == 0 && (pm_outline_is_level(p->outline) || i < f->nu || i >= f->n - f->nu);
    const struct pm_fit job = {
        .nq = nq,
        .S = &m->S[3 * first],
        .weight = weight,
        .target = x,
        .alpha = k == 0 ? 1e-3 : 0.1,
        .iterations = 5, /* more would fit closer, and ripple: curvature 0.9 instead of 0.7 /mm */
        .fixed = fixed};
    PM_TRY(pm_fit_points(map, f->n, &job, f->phi, rms, err));
done:
    pm_map_free(map);
    pm_free(x);
    pm_free(weight);
    pm_free(fixed);
    return status;
}

/* Fits surface k, or copies the fit of which it is an image; states and judges the error. */
static enum pm_status shape(const struct plan *p, struct pm_surfaces *s, const struct pm_samples *m,
                            ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_symmetry *y = &p->c->symmetry;
    struct pm_surface *f = &s->s[k];
    ptrdiff_t g, r = k > 0 ? pm_symmetry_source(y, k - 1, &g) + 1 : 0;
    double at[3] = {0}, *max = p->fit->max, *mean = p->fit->mean, spacing;

    if (r < k) {
        pm_symmetry_points(y, g, f->n, s->s[r].phi, f->phi);
        mean[k] = mean[r];
        max[k] = max[r];
        return PM_OK;
    }
    if (pm_files_has(p->c, k))
        return PM_OK;
    PM_TRY(fit(p, s, m, k, err));
    PM_TRY(measure(p, k, f, at, &spacing, err));
    pm_log(1,
           "surface %td: %td control points, distance from the wanted surface mean %.4f max "
           "%.4f mm",
           k, f->n, mean[k], max[k]);
    if (max[k] > REFUSED * spacing)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "surface %td misses its shape by %.3g mm at (%.4g, %.4g, %.4g), expected at "
                       "most half the spacing %.3g of its control points",
                       k, max[k], at[0], at[1], at[2], spacing));
    if (max[k] > WARNED * spacing)
        pm_warn("surface %td misses its shape by %.3g mm at (%.4g, %.4g, %.4g), more than a tenth "
                "of the spacing %.3g",
                k, max[k], at[0], at[1], at[2], spacing);
done:
    return status;
}

/* A design is taken for what it is: an optimised wall may be 2 % thinner than it should. */
static enum pm_status examine(const struct pm_surfaces *s, int design, struct pm_check *check,
                              struct pm_err *err)
{
    struct pm_err thin = {.status = PM_OK};
    enum pm_status status;

    if (!design)
        return pm_surfaces_check(s, check, err);
    PM_TRY(pm_surfaces_measure(s, check, err));
    if (pm_surfaces_check(s, check, &thin) != PM_OK)
        pm_warn("%s", thin.text);
done:
    return status;
}

static enum pm_status finish(struct pm_surfaces *s, int design, struct pm_check *check,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *phi = NULL;

    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    pm_surfaces_gather(s, phi);
    pm_symmetrise_points(s, phi);
    pm_surfaces_scatter(s, phi);
    PM_TRY(examine(s, design, check, err));
    pm_log(1, "least wall %.3f between surfaces %d and %d at (%.4g, %.4g, %.4g), least cap %.3f mm",
           check->wall.distance, check->wall.a, check->wall.b, check->wall.x[0], check->wall.x[1],
           check->wall.x[2], check->cap);
    pm_log(1,
           "largest curvature %.3f /mm at (%.4g, %.4g, %.4g), least cover %.2f, symmetry defect "
           "%.1e mm",
           check->curvature, check->curvature_x[0], check->curvature_x[1], check->curvature_x[2],
           check->coverage, pm_symmetry_defect(s, phi));
    if (check->curvature > s->pcase.curvature_max)
        pm_warn("largest curvature %.3g /mm at (%.4g, %.4g, %.4g) is above curvature_max %g",
                check->curvature, check->curvature_x[0], check->curvature_x[1],
                check->curvature_x[2], s->pcase.curvature_max);
done:
    pm_free(phi);
    return status;
}

enum pm_status pm_surfgen(const struct pm_case *c, struct pm_surfaces *s,
                          struct pm_surfgen_report *report, struct pm_err *err)
{
    const struct surfgen_files none = {0};

    return pm_surfgen_from(c, &none, s, report, err);
}

enum pm_status pm_surfgen_from(const struct pm_case *c, const struct surfgen_files *files,
                               struct pm_surfaces *s, struct pm_surfgen_report *report,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct plan p = {.c = c, .files = files, .fit = report};
    struct pm_samples m = {0};
    double longest[2];

    memset(s, 0, sizeof *s);
    memset(report, 0, sizeof *report);
    PM_TRY(pm_files_check(c, files, err));
    if (files->design != NULL) {
        PM_TRY(pm_design_load(files->design, c, s, err));
        PM_TRY(finish(s, 1, &report->check, err));
        goto done;
    }
    PM_TRY(seed(&p, s, err));
    PM_TRY(pm_samples_new(s, INFINITY, 2, &m, err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(shape(&p, s, &m, k, err));
    PM_TRY(pm_tube_edges(&s->s[0], s->s[0].spacing, longest, err));
    PM_TRY(finish(s, 0, &report->check, err));
done:
    pm_outline_free(p.outline);
    for (ptrdiff_t k = 0; k < PM_MAX_CHAMBERS; k++)
        pm_profile_release(&p.profile[k]);
    pm_samples_release(&m);
    if (status != PM_OK)
        pm_surfaces_release(s);
    return status;
}

enum pm_status surfgen_run(const struct surfgen_files *files, const struct pm_common *common,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;
    struct pm_h5 *f = NULL;
    const char *extra[PM_MAX_CHAMBERS + 3] = {NULL};
    int n = 0;

    PM_TRY(pm_case_load(common->operands[0], &c, err));
    PM_TRY(pm_surfgen_from(&c, files, &s, &fit, err));
    if (files->design != NULL)
        extra[n++] = files->design;
    if (files->body != NULL)
        extra[n++] = files->body;
    for (int k = 0; k < PM_MAX_CHAMBERS; k++)
        if (files->chamber[k] != NULL)
            extra[n++] = files->chamber[k];
    PM_TRY(pm_h5_create(common->output, "surface", common, extra, &f, err));
    PM_TRY(pm_surfaces_write(f, &s, err));
    PM_TRY(pm_h5_put(f, "/fit/mean", &s.ns, fit.mean, err));
    PM_TRY(pm_h5_put(f, "/fit/max", &s.ns, fit.max, err));
    status = pm_h5_commit(f, err);
    f = NULL;
done:
    pm_h5_close(f);
    pm_surfaces_release(&s);
    pm_case_release(&c);
    return status;
}
