#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"
#include "common/geometry/curvature.h"
#include "common/geometry/remesh.h"
#include "tools/surfremesh/compare.h"
#include "tools/surfremesh/exterior.h"
#include "tools/surfremesh/rebuild.h"
#include "tools/surfremesh/spacing.h"

static const double DISTANCE_MAX = 0.3, VOLUME_OFF = 0.005, CV_GOOD = 0.2, UNEVEN_GOOD = 2;

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

int rebuild_misses(const struct rebuild *r, ptrdiff_t k)
{
    return !(r->report->max[k] <= DISTANCE_MAX &&
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

enum pm_status rebuild_judge_robot(struct rebuild *r, const struct pm_surfaces *to,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_check *before = &r->before;
    struct pm_check after;
    double wall = to->pcase.wall_min;

    r->report->reason[0] = '\0';
    r->blame[0] = r->blame[1] = -1;
    PM_TRY(pm_surfaces_measure(to, &after, err));
    if (after.fault[0] != '\0')
        object(r, "%s", after.fault);
    if (after.wall.distance < fmin(wall, before->wall.distance - 0.02 * wall)) {
        r->blame[0] = r->source[after.wall.a];
        r->blame[1] = r->source[after.wall.b];
        object(r, "wall between surfaces %d and %d shrinks from %.3f to %.3f at (%.4g, %.4g, %.4g)",
               after.wall.a, after.wall.b, before->wall.distance, after.wall.distance,
               after.wall.x[0], after.wall.x[1], after.wall.x[2]);
    }
    if (after.cap < fmin(to->pcase.cap_min, before->cap - 0.02 * wall))
        object(r, "distance from the end planes shrinks from %.3f to %.3f mm", before->cap,
               after.cap);
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
