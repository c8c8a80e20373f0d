#include "tools/surfremesh/surfremesh.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
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
    memset(r, 0, sizeof *r);
}

static void keep(struct surfremesh_report *report, ptrdiff_t ns)
{
    report->kept = 1;
    for (ptrdiff_t k = 0; k < ns; k++) {
        report->spacing_after[k] = report->spacing_before[k];
        report->mean[k] = report->max[k] = 0;
        report->volume_ratio[k] = 1;
    }
}

/* A surface whose result misses its old form is tried again with closer control points, unless the
 * options fix their number. Returns whether there is one. */
static int refine(struct rebuild *r)
{
    int any = 0;

    if (r->redo[0] && rebuild_misses(r, 0) && r->from->s[0].spacing[0] > 0) {
        r->nu += 12;
        r->nv += r->nv / 7;
        any = 1;
    }
    for (ptrdiff_t k = 1; k < r->from->ns; k++)
        if (r->redo[k] && rebuild_misses(r, k) && r->o->spacing <= 0 && r->o->points <= 0) {
            r->spacing[k] *= 0.85;
            any = 1;
        }
    return any;
}

/* Leaves the surface to blame, with its images, as it was; the others may still be acceptable.
 * Returns whether any is left. */
static int drop(struct rebuild *r)
{
    int any = 0;

    if (r->blame < 0)
        return 0;
    for (ptrdiff_t k = 0; k < r->from->ns; k++) {
        if (r->source[k] == r->source[r->blame])
            r->redo[k] = 0;
        any |= r->redo[k];
    }
    return any;
}

/* One attempt; a mesher or a map that fails refuses the result, PM_SYSTEM ends the tool. */
static enum pm_status attempt(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    struct surfremesh_report *report = r->report;
    struct pm_err why = {0};
    enum pm_status status;

    pm_surfaces_release(to);
    report->reason[0] = '\0';
    status = rebuild_surfaces(r, to, &why);
    if (status == PM_OK)
        status = rebuild_judge(r, to, &why);
    if (status == PM_SYSTEM) {
        *err = why;
        return status;
    }
    if (status != PM_OK)
        snprintf(report->reason, sizeof report->reason, "%.255s", why.text);
    for (ptrdiff_t k = 0; status == PM_OK && k < to->ns; k++)
        if (r->redo[k])
            pm_log(1,
                   "surface %td: %td control points for %td, spacing variation %.3f -> %.3f, "
                   "distance mean %.4f "
                   "max %.4f mm, volume %+.3f %%",
                   k, to->s[k].n, r->from->s[k].n, report->spacing_before[k],
                   report->spacing_after[k], report->mean[k], report->max[k],
                   100 * (report->volume_ratio[k] - 1));
    return PM_OK;
}

/* Attempts with closer control points, then without the surface that fails. */
static enum pm_status attempts(struct rebuild *r, struct pm_surfaces *to, struct pm_err *err)
{
    enum { ATTEMPTS = 3 };
    enum pm_status status = PM_OK;
    struct surfremesh_report *report = r->report;
    char dropped[sizeof report->reason] = "";

    for (int i = 0;; i++) {
        PM_TRY(attempt(r, to, err));
        report->refused = report->reason[0] != '\0';
        if (!report->refused)
            break;
        if (i + 1 < ATTEMPTS && to->s != NULL && refine(r))
            continue;
        if (r->o->spacing > 0 || r->o->points > 0)
            break;
        memcpy(dropped, report->reason, sizeof dropped);
        if (!drop(r))
            break;
        pm_warn("surface kept: %s", dropped);
        i = -1;
    }
    if (!report->refused)
        memcpy(report->reason, dropped, sizeof dropped);
done:
    return status;
}

enum pm_status pm_surfremesh(const struct pm_surfaces *from, const struct surfremesh_opts *o,
                             struct pm_surfaces *to, struct surfremesh_report *report,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct rebuild r = {.from = from, .o = o, .report = report};
    int any = 0;

    memset(to, 0, sizeof *to);
    PM_TRY(rebuild_plan(&r, err));
    for (ptrdiff_t k = 0; k < from->ns; k++)
        any |= r.redo[k];
    if (any) {
        PM_TRY(pm_surfaces_measure(from, &r.before, err));
        PM_TRY(attempts(&r, to, err));
    } else {
        pm_log(1, "control points are even, nothing to do");
    }
    if (!any || report->refused) {
        pm_surfaces_release(to);
        keep(report, from->ns);
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
