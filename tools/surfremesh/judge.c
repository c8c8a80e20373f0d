#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/check.h"
#include "common/geometry/remesh.h"
#include "tools/surfremesh/chamber.h"
#include "tools/surfremesh/exterior.h"
#include "tools/surfremesh/rebuild.h"

static const double DISTANCE_MAX = 0.3, VOLUME_OFF = 0.005, CV_GOOD = 0.2;

/* The first objection stays. */
__attribute__((format(printf, 2, 3))) static void object(struct surfremesh_report *report,
                                                         const char *format, ...)
{
    va_list args;

    if (report->reason[0] != '\0')
        return;
    va_start(args, format);
    vsnprintf(report->reason, sizeof report->reason, format, args);
    va_end(args);
}

/* Distance of samples of the new surface k from the old one, and the ratio of the volumes. */
static enum pm_status compare(struct rebuild *r, const struct pm_surfaces *to,
                              const struct pm_samples *m, const struct pm_samples *before,
                              ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct surfremesh_report *report = r->report;
    const struct pm_surface *old = &r->from->s[k];
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *phi = NULL, *was = NULL, total = 0;

    PM_TRY(PM_NEW(phi, 3 * to->offset[to->ns], err));
    PM_TRY(PM_NEW(was, 3 * r->from->offset[to->ns], err));
    pm_surfaces_gather(to, phi);
    pm_surfaces_gather(r->from, was);
    PM_TRY(pm_map_new(old, &map, err));
    for (ptrdiff_t i = m->first[k]; i < m->first[k + 1]; i++) {
        double x[3], S[3], foot[3], d;
        pm_samples_at(m, i, phi, x, NULL, NULL);
        PM_TRY(rebuild_start(r, k, map, &m->S[3 * i], &work, S, err));
        PM_TRY(pm_distance_project(map, old->type, old->phi, x, &work, S, foot, &d, err));
        report->max[k] = fmax(report->max[k], d);
        report->mean[k] += d * m->area[i];
        total += m->area[i];
    }
    report->mean[k] /= total;
    report->volume_ratio[k] = pm_samples_volume(m, phi, k) / pm_samples_volume(before, was, k);
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(phi);
    pm_free(was);
    return status;
}

int rebuild_misses(const struct rebuild *r, ptrdiff_t k)
{
    return !(r->report->max[k] <= DISTANCE_MAX &&
             fabs(r->report->volume_ratio[k] - 1) <= VOLUME_OFF);
}

static void judge_surface(struct rebuild *r, const struct pm_surfaces *to, ptrdiff_t k)
{
    struct surfremesh_report *p = r->report;
    const struct pm_surface *f = &to->s[k];

    for (ptrdiff_t t = 0; t < f->nt; t++) {
        const int32_t *v = &f->tri[3 * t];
        if (!(pm_parameter_orientation(f->type, &f->Phi[3 * (ptrdiff_t)v[0]],
                                       &f->Phi[3 * (ptrdiff_t)v[1]],
                                       &f->Phi[3 * (ptrdiff_t)v[2]]) > 0))
            object(p,
                   "surface %td: triangle %td of its new control points is folded in the parameter",
                   k, t);
    }
    if (!(p->max[k] <= DISTANCE_MAX))
        object(p, "surface %td: new surface lies up to %.3f mm off the old one, expected <= %g", k,
               p->max[k], DISTANCE_MAX);
    if (!(fabs(p->volume_ratio[k] - 1) <= VOLUME_OFF))
        object(p, "surface %td: enclosed volume changes by %.2f %%, expected <= %g %%", k,
               100 * (p->volume_ratio[k] - 1), 100 * VOLUME_OFF);
    if (!(p->spacing_after[k] <= fmax(p->spacing_before[k], CV_GOOD)))
        object(p, "surface %td: variation of the spacing grows from %.3f to %.3f", k,
               p->spacing_before[k], p->spacing_after[k]);
}

static enum pm_status judge_robot(struct rebuild *r, const struct pm_surfaces *to,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_check before, after;
    double wall = to->pcase.wall_min;

    PM_TRY(pm_surfaces_measure(r->from, &before, err));
    PM_TRY(pm_surfaces_measure(to, &after, err));
    if (after.fault[0] != '\0')
        object(r->report, "%s", after.fault);
    if (after.wall.distance < fmin(wall, before.wall.distance - 0.02 * wall))
        object(r->report,
               "wall between surfaces %d and %d shrinks from %.3f to %.3f at (%.4g, %.4g, %.4g)",
               after.wall.a, after.wall.b, before.wall.distance, after.wall.distance,
               after.wall.x[0], after.wall.x[1], after.wall.x[2]);
    if (after.cap < fmin(to->pcase.cap_min, before.cap - 0.02 * wall))
        object(r->report, "distance from the end planes shrinks from %.3f to %.3f mm", before.cap,
               after.cap);
done:
    return status;
}

enum pm_status rebuild_judge(struct rebuild *r, const struct pm_surfaces *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_samples m = {0}, before = {0};
    struct surfremesh_report *p = r->report;

    PM_TRY(pm_samples_new(to, HUGE_VAL, 3, &m, err));
    PM_TRY(pm_samples_new(r->from, HUGE_VAL, 3, &before, err));
    for (ptrdiff_t k = 0; k < to->ns; k++) {
        struct pm_spacing now;
        p->spacing_after[k] = p->spacing_before[k];
        p->volume_ratio[k] = 1;
        p->mean[k] = p->max[k] = 0;
        if (!r->redo[k])
            continue;
        PM_TRY(compare(r, to, &m, &before, k, err));
        if (k == 0) {
            PM_TRY(pm_exterior_unevenness(&to->s[0], &p->spacing_after[0], err));
        } else {
            PM_TRY(pm_spacing_of(&to->s[k], &now, err));
            p->spacing_after[k] = now.cv;
        }
        judge_surface(r, to, k);
    }
    PM_TRY(judge_robot(r, to, err));
done:
    pm_samples_release(&m);
    pm_samples_release(&before);
    return status;
}
