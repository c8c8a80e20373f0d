#include "tools/surfremesh/surfremesh.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/penalty.h"
#include "tools/surfremesh/rebuild.h"

enum pm_status surfremesh_report_init(struct surfremesh_report *r, ptrdiff_t ns, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    memset(r, 0, sizeof *r);
    PM_TRY(PM_NEW(r->spacing_before, ns, err));
    PM_TRY(PM_NEW(r->spacing_after, ns, err));
    PM_TRY(PM_NEW(r->mean, ns, err));
    PM_TRY(PM_NEW(r->max, ns, err));
    PM_TRY(PM_NEW(r->volume_ratio, ns, err));
    PM_TRY(PM_NEW(r->bend, ns, err));
done:
    return status;
}

void surfremesh_report_release(struct surfremesh_report *r)
{
    pm_free(r->spacing_before);
    pm_free(r->spacing_after);
    pm_free(r->mean);
    pm_free(r->max);
    pm_free(r->volume_ratio);
    pm_free(r->bend);
    memset(r, 0, sizeof *r);
}

/* The report on surface k, the first of its orbit, and its images as they were. */
static void report_kept(struct rebuild *r, ptrdiff_t k)
{
    struct surfremesh_report *p = r->report;

    for (ptrdiff_t i = 0; i < r->from->ns; i++) {
        if (r->source[i] != k)
            continue;
        r->redo[i] = 0;
        p->spacing_after[i] = p->spacing_before[i];
        p->mean[i] = p->max[i] = 0;
        p->volume_ratio[i] = 1;
        p->bend[i] = 1;
    }
}

static void report_renewed(const struct rebuild *r, ptrdiff_t k)
{
    const struct surfremesh_report *p = r->report;

    pm_log(1,
           "surface %td: %td control points for %td, spacing variation %.3f -> %.3f, distance mean "
           "%.4f max %.4f mm, volume %+.3f %%, curvature %.3f",
           k, r->made[k].n, r->from->s[k].n, p->spacing_before[k], p->spacing_after[k], p->mean[k],
           p->max[k], 100 * (p->volume_ratio[k] - 1), p->bend[k]);
}

/* Leaves it as it was, for the present reason. */
static void keep(struct rebuild *r, ptrdiff_t k, char *why)
{
    memcpy(why, r->report->reason, sizeof r->report->reason);
    pm_warn("surface %td kept: %s", k, why);
    report_kept(r, k);
}

static int any_left(const struct rebuild *r)
{
    int any = 0;

    for (ptrdiff_t k = 0; k < r->from->ns; k++)
        any |= r->redo[k];
    return any;
}

static int is_asked(const struct rebuild *r)
{
    return r->o->spacing > 0 || r->o->points > 0;
}

/* Closer control points for surface k, unless the options or the surface fix their number. */
static int refine(struct rebuild *r, ptrdiff_t k)
{
    if (k == 0 ? r->from->s[0].spacing[0] <= 0 : is_asked(r))
        return 0;
    if (k == 0) {
        r->nu += 12;
        r->nv += r->nv / 7;
    }
    r->spacing[k] *= 0.85;
    return 1;
}

/* A mesher or a map that fails refuses the result, PM_SYSTEM ends the tool. */
static enum pm_status refuse(struct rebuild *r, enum pm_status status, const struct pm_err *why,
                             struct pm_err *err)
{
    if (status == PM_SYSTEM)
        *err = *why;
    else if (status != PM_OK)
        snprintf(r->report->reason, sizeof r->report->reason, "%.255s", why->text);
    return status == PM_SYSTEM ? status : PM_OK;
}

/* Surface k, the first of its orbit; tried again with closer control points where it misses its old
 * form. The reason says why it is not acceptable. */
static enum pm_status renew(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    enum { ATTEMPTS = 6 };
    enum pm_status status;
    const struct surfremesh_report *p = r->report;

    for (int i = 1;; i++) {
        struct pm_err why = {0};
        status = rebuild_surface(r, k, &why);
        if (status == PM_OK)
            status = rebuild_judge_surface(r, k, &why);
        const int judged = status == PM_OK;
        PM_TRY(refuse(r, status, &why, err));
        if (judged)
            report_renewed(r, k);
        if (p->reason[0] == '\0' || !judged || i == ATTEMPTS || !rebuild_misses(r, k) ||
            !refine(r, k))
            break;
    }
done:
    return status;
}

static enum pm_status join(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    struct pm_err why = {0};
    enum pm_status status = rebuild_join(r, to, &why);

    r->blame[0] = r->blame[1] = -1;
    r->report->reason[0] = '\0';
    if (status == PM_OK)
        status = rebuild_polish(r, to, &why);
    for (ptrdiff_t k = 0; status == PM_OK && k < r->from->ns && r->report->reason[0] == '\0'; k++)
        if (r->redo[k] && r->source[k] == k) {
            status = rebuild_judge_surface(r, k, &why);
            r->blame[0] = r->blame[1] = r->report->reason[0] != '\0' ? k : -1;
            report_renewed(r, k);
        }
    if (status == PM_OK && r->report->reason[0] == '\0')
        status = rebuild_judge_robot(r, to, &why);
    return refuse(r, status, &why, err);
}

/* Is it to blame, and new? */
static int is_suspect(const struct rebuild *r, ptrdiff_t k)
{
    return r->redo[k] && r->source[k] == k &&
           (r->blame[0] < 0 || r->blame[0] == k || r->blame[1] == k);
}

/* Of the surfaces to blame the one furthest off, -1: none. */
static ptrdiff_t worst_suspect(const struct rebuild *r)
{
    ptrdiff_t worst = -1;

    for (ptrdiff_t k = 0; k < r->from->ns; k++)
        if (is_suspect(r, k) && (worst < 0 || r->report->max[k] > r->report->max[worst]))
            worst = k;
    return worst;
}

/* All that can be accepted together: the surface to blame gets closer control points, then it is
 * kept, with why. */
static enum pm_status reconcile(struct rebuild *r, struct pm_surfaces *to, char *why,
                                struct pm_err *err)
{
    enum { RENEWALS = 4 };
    enum pm_status status = PM_OK;

    for (int i = 0; any_left(r); i++) {
        PM_TRY(join(r, to, err));
        const ptrdiff_t k = worst_suspect(r);
        if (r->report->reason[0] == '\0' || is_asked(r) || k < 0)
            break;
        const int again = i < RENEWALS && refine(r, k);
        if (again)
            PM_TRY(renew(r, k, err));
        if (!again || r->report->reason[0] != '\0')
            keep(r, k, why);
    }
done:
    return status;
}

/* Every orbit by itself, then together. */
static enum pm_status renew_all(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct surfremesh_report *p = r->report;
    char why[sizeof p->reason] = "";

    for (ptrdiff_t k = 0; k < r->from->ns; k++) {
        if (!r->redo[k] || r->source[k] < k)
            continue;
        PM_TRY(renew(r, k, err));
        p->refused = p->reason[0] != '\0';
        if (p->refused && is_asked(r))
            goto done;
        if (p->refused)
            keep(r, k, why);
    }
    PM_TRY(reconcile(r, to, why, err));
    p->refused = !any_left(r) || p->reason[0] != '\0';
    if (why[0] != '\0')
        memcpy(p->reason, why, sizeof why);
done:
    return status;
}

enum pm_status pm_surfremesh(const struct pm_surfaces *from, const struct surfremesh_opts *o,
                             struct pm_surfaces *to, struct surfremesh_report *report,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct rebuild r = {.from = from, .o = o, .report = report};

    memset(to, 0, sizeof *to);
    PM_TRY(rebuild_plan(&r, err));
    const int any = any_left(&r);
    for (ptrdiff_t k = 0; k < from->ns; k++)
        if (!r.redo[k] && r.source[k] == k)
            report_kept(&r, k);
    if (any) {
        PM_TRY(pm_penalty_survey(from, r.before.curvature, r.before.wall, err));
        PM_TRY(renew_all(&r, to, err));
    } else {
        pm_log(1, "control points are even, nothing to do");
    }
    report->kept = !any || report->refused;
    if (report->kept) {
        pm_surfaces_release(to);
        for (ptrdiff_t k = 0; k < from->ns; k++)
            if (r.source[k] == k)
                report_kept(&r, k);
    }
done:
    rebuild_release(&r);
    if (status != PM_OK)
        pm_surfaces_release(to);
    return status;
}

static enum pm_status write(struct pm_h5 *f, const struct pm_surfaces *s,
                            const struct surfremesh_report *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t n = s->ns;

    PM_TRY(pm_surfaces_write(f, s, err));
    PM_TRY(pm_h5_put_int(f, "/reconstruction/kept", r->kept, err));
    PM_TRY(pm_h5_put_text(f, "/reconstruction/reason", r->reason, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/spacing_before", &n, r->spacing_before, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/spacing_after", &n, r->spacing_after, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/distance_mean", &n, r->mean, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/distance_max", &n, r->max, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/volume_ratio", &n, r->volume_ratio, err));
    PM_TRY(pm_h5_put(f, "/reconstruction/curvature", &n, r->bend, err));
done:
    return status;
}

enum pm_status surfremesh_run(struct surfremesh_opts *o, const struct pm_common *common,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surfaces from = {0}, to = {0};
    struct surfremesh_report report = {0};
    struct pm_h5 *f = NULL;
    const char *name = common->operands[0];

    PM_TRY(pm_surfaces_load(name, &from, err));
    PM_TRY(surfremesh_report_init(&report, from.ns, err));
    PM_TRY(pm_surfremesh(&from, o, &to, &report, err));
    if (report.refused && !o->or_keep)
        PM_TRY(pm_fail(err, PM_NUMERIC, "cannot redistribute the control points of '%s': %s", name,
                       report.reason));
    if (report.refused)
        pm_warn("surfaces kept: %s", report.reason);
    PM_TRY(pm_h5_create(common->output, "surface", common, NULL, &f, err));
    PM_TRY(write(f, report.kept ? &from : &to, &report, err));
    status = pm_h5_commit(f, err);
    f = NULL;
done:
    pm_h5_close(f);
    surfremesh_report_release(&report);
    pm_surfaces_release(&from);
    pm_surfaces_release(&to);
    return status;
}
