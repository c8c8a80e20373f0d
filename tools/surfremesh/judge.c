#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "common/base/memory.h"
#include "common/geometry/check.h"
#include "common/geometry/collide.h"
#include "common/geometry/curvature.h"
#include "common/geometry/penalty.h"
#include "common/geometry/remesh.h"
#include "tools/surfremesh/compare.h"
#include "tools/surfremesh/exterior.h"
#include "tools/surfremesh/rebuild.h"
#include "tools/surfremesh/spacing.h"

static const double DISTANCE_MAX = 0.3, VOLUME_OFF = 0.005, CV_GOOD = 0.2, UNEVEN_GOOD = 2;
static const double CURVATURE_OVER = 0.25, WALL_UNDER = 0.015;
/* Of wall_min: exterior, chambers. Seen of one exterior: 0.006 mm changed a measure by 0.53 %,
 * 0.003 mm by 0.15 %. */
static const double MEAN_OFF[2] = {1.0 / 500, 1.0 / 250};

/* The first objection stays. */
__attribute__((format(printf, 2, 3))) static void object(struct rebuild *r, const char *format, ...)
{
    struct surfremesh_report *report = r->report;
    va_list args;

    if (report->reason[0] != '\0')
        return;
    va_start(args, format);
    vsnprintf(report->reason, sizeof report->reason, format, args);
    va_end(args);
}

/* Unasked renewals may not move the measure: it goes with the cube of the walls and more. */
static double mean_max(const struct rebuild *r, ptrdiff_t k)
{
    const int asked = r->o->spacing > 0 || r->o->points > 0;
    return asked ? DISTANCE_MAX : MEAN_OFF[k > 0] * r->from->pcase.wall_min;
}

int rebuild_misses(const struct rebuild *r, ptrdiff_t k)
{
    return !(r->report->max[k] <= DISTANCE_MAX && r->report->mean[k] <= mean_max(r, k) &&
             fabs(r->report->volume_ratio[k] - 1) <= VOLUME_OFF);
}

static double sharpest(const struct pm_samples *m, const double *phi)
{
    double most = 0, r_a[6], r_ab[9];
    struct pm_curvature c;

    for (ptrdiff_t i = 0; i < m->n; i++) {
        pm_samples_at(m, i, phi, NULL, r_a, r_ab);
        pm_curvature_at(r_a, r_ab, &c);
        most = fmax(most, sqrt(c.Q));
    }
    return most;
}

static void judge(struct rebuild *r, ptrdiff_t k)
{
    struct surfremesh_report *p = r->report;
    const struct pm_surface *f = &r->made[k];
    const int drifts = r->method[k] == SURFREMESH_PAPER;

    for (ptrdiff_t t = 0; t < f->nt; t++) {
        const int32_t *v = &f->tri[3 * t];
        if (!(pm_parameter_orientation(f->type, &f->Phi[3 * (ptrdiff_t)v[0]],
                                       &f->Phi[3 * (ptrdiff_t)v[1]],
                                       &f->Phi[3 * (ptrdiff_t)v[2]]) > 0))
            object(r,
                   "surface %td: triangle %td of its new control points is folded in the parameter",
                   k, t);
    }
    if (!drifts && !(p->max[k] <= DISTANCE_MAX))
        object(r, "surface %td: new surface lies up to %.3f mm off the old one, expected <= %g", k,
               p->max[k], DISTANCE_MAX);
    if (!drifts && !(p->mean[k] <= mean_max(r, k)))
        object(
            r,
            "surface %td: new surface lies %.4f mm off the old one in the mean, expected <= %.4f",
            k, p->mean[k], mean_max(r, k));
    if (!drifts && !(fabs(p->volume_ratio[k] - 1) <= VOLUME_OFF))
        object(r, "surface %td: enclosed volume changes by %.2f %%, expected <= %g %%", k,
               100 * (p->volume_ratio[k] - 1), 100 * VOLUME_OFF);
    if (!drifts &&
        !(p->spacing_after[k] <= fmax(p->spacing_before[k], k == 0 ? UNEVEN_GOOD : CV_GOOD)))
        object(r, "surface %td: variation of the spacing grows from %.3f to %.3f", k,
               p->spacing_before[k], p->spacing_after[k]);
}

/* The triangles of the control points' places pierce each other. */
static enum pm_status judge_embedding(struct rebuild *r, const struct pm_surface *f, ptrdiff_t k,
                                      struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    struct pm_contact c;
    double *x = NULL;

    PM_TRY(PM_NEW(x, 3 * f->n, err));
    PM_TRY(pm_map_new(f, &map, err));
    for (ptrdiff_t i = 0; i < f->n; i++)
        PM_TRY(pm_map_point(map, f->phi, &f->Phi[3 * i], &work, &x[3 * i], NULL, NULL, err));
    PM_TRY(pm_collide_pierce(x, f->nt, f->tri, &c, err));
    if (c.a >= 0)
        object(r, "surface %td: passes through itself at (%.4g, %.4g, %.4g)", k, c.at[0], c.at[1],
               c.at[2]);
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    return status;
}

static void blame(struct rebuild *r, ptrdiff_t a, ptrdiff_t b)
{
    if (r->report->reason[0] != '\0')
        return;
    r->blame[0] = r->source[a];
    r->blame[1] = r->source[b];
}

static void judge_breach(struct rebuild *r, const struct rebuild_breach *now)
{
    const ptrdiff_t ns = r->from->ns;

    for (ptrdiff_t k = 0; k < ns; k++) {
        if (!(now->curvature[k] > fmax(CURVATURE_OVER, r->before.curvature[k])))
            continue;
        blame(r, k, k);
        object(r, "surface %td: curvature would be %.3g above its limit, the old one's is %.3g", k,
               now->curvature[k], r->before.curvature[k]);
    }
    for (ptrdiff_t k = 0; k < ns * ns; k++) {
        const ptrdiff_t a = k / ns, b = k % ns;
        if (!(now->wall[k] > fmax(WALL_UNDER, r->before.wall[k])))
            continue;
        blame(r, a, b);
        if (a == b)
            object(r, "surface %td: its own walls would be %.3g too thin, the old ones are %.3g", a,
                   now->wall[k], r->before.wall[k]);
        else
            object(r,
                   "wall between surfaces %td and %td would be %.3g too thin, the old one is %.3g",
                   a, b, now->wall[k], r->before.wall[k]);
    }
}

enum pm_status rebuild_judge_robot(struct rebuild *r, const struct pm_surfaces *to,
                                   struct pm_err *err)
{
    enum pm_status status;
    struct pm_check check;
    struct rebuild_breach now;

    r->report->reason[0] = '\0';
    r->blame[0] = r->blame[1] = -1;
    PM_TRY(pm_surfaces_measure(to, &check, err));
    if (check.fault[0] != '\0')
        object(r, "%s", check.fault);
    PM_TRY(pm_penalty_survey(to, now.curvature, now.wall, err));
    judge_breach(r, &now);
done:
    return status;
}

static enum pm_status measure(const struct rebuild *r, const struct pm_surface *f, ptrdiff_t k,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *was = &r->from->s[k];
    struct surfremesh_report *p = r->report;
    struct compare_side now = {0}, before = {0};
    struct pm_spacing spacing;
    double *S = NULL;

    PM_TRY(compare_side_init(&now, f, err));
    PM_TRY(compare_side_init(&before, was, err));
    PM_TRY(PM_NEW(S, 3 * now.m.n, err));
    pm_samples_parameters(f, r->carried[k] != NULL ? r->carried[k] : f->Phi, COMPARE_CUTS, S);
    PM_TRY(compare_surfaces(&before, &now, S, &p->mean[k], &p->max[k], err));
    p->volume_ratio[k] =
        pm_samples_volume(&now.m, f->phi, 0) / pm_samples_volume(&before.m, was->phi, 0);
    p->bend[k] = sharpest(&now.m, f->phi) /
                 fmax(r->from->pcase.curvature_max, sharpest(&before.m, was->phi));
    if (k == 0) {
        PM_TRY(pm_exterior_unevenness(f, &p->spacing_after[0], err));
    } else {
        PM_TRY(pm_spacing_of(f, &spacing, err));
        p->spacing_after[k] = spacing.cv;
    }
done:
    compare_side_release(&now);
    compare_side_release(&before);
    pm_free(S);
    return status;
}

enum pm_status rebuild_judge_surface(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status;
    struct surfremesh_report *p = r->report;

    p->reason[0] = '\0';
    PM_TRY(measure(r, &r->made[k], k, err));
    judge(r, k);
    PM_TRY(judge_embedding(r, &r->made[k], k, err));
    for (ptrdiff_t image = k + 1; image < r->from->ns; image++) {
        if (r->source[image] != k)
            continue;
        p->spacing_after[image] = p->spacing_after[k];
        p->volume_ratio[image] = p->volume_ratio[k];
        p->mean[image] = p->mean[k];
        p->max[image] = p->max[k];
        p->bend[image] = p->bend[k];
    }
done:
    return status;
}
