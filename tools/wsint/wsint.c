#include "tools/wsint/wsint.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/branch.h"
#include "common/actuation/measure.h"
#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/provenance.h"
#include "common/files/workspace.h"
#include "tools/wsint/design.h"

static enum pm_status read_orientation(const char *path, const char *measure, double *orientation,
                                       struct pm_err *err)
{
    enum pm_status status;
    struct pm_work w = {0};

    PM_TRY(pm_work_load(path, 0, &w, err));
    if (strcmp(w.name, measure) != 0)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': its measure is %s, expected %s", path,
                       w.name, measure));
    *orientation = w.orientation;
done:
    pm_work_release(&w);
    return status;
}

/* Folds: det J (selected rows) must keep the sign sigma at every point of both forms. */
static void check_folds(const struct wsint_design *d, struct pm_work *w)
{
    w->min_det = INFINITY;
    w->max_det = -INFINITY;
    for (ptrdiff_t i = 0; i < d->np; i++) {
        const double det = w->orientation * pm_measure_det(&d->pcase, d->points[i].J);
        w->min_det = fmin(w->min_det, det);
        w->max_det = fmax(w->max_det, det);
        w->sign_changes += det < 0;
    }
    if (w->sign_changes > 0)
        pm_warn(
            "the workspace folds: det J has the wrong sign at %lld of %td points (%.3g to %.3g), "
            "folded parts count negative",
            (long long)w->sign_changes, d->np, w->min_det, w->max_det);
}

/* The point at the nearest other pressures. */
static ptrdiff_t neighbour(const struct wsint_design *d, ptrdiff_t i)
{
    ptrdiff_t best = i;
    double least = INFINITY;
    for (ptrdiff_t j = 0; j < d->np; j++) {
        double sum = 0;
        for (ptrdiff_t r = 0; r < d->pcase.nchambers; r++) {
            const double gap = d->points[i].pressure[r] - d->points[j].pressure[r];
            sum += gap * gap;
        }
        if (j != i && sum < least) {
            least = sum;
            best = j;
        }
    }
    return best;
}

/* Rotation vectors must stay on one branch, 2R away from the pole of its potential. */
static void check_rotations(const struct wsint_design *d, struct pm_work *w)
{
    const double near_turn = 0.9 * 3.14159265358979323846;
    for (ptrdiff_t i = 0; i < d->np; i++) {
        const double *t = d->points[i].U + 3;
        const double eta = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
        w->max_rotation = fmax(w->max_rotation, eta);
        w->max_tilt = fmax(w->max_tilt, pm_branch_tilt(t));
        w->branch_jumps += pm_branch_jump(d->points[neighbour(d, i)].U + 3, t);
    }
    if (w->branch_jumps > 0)
        pm_warn("the rotation vector at %lld of %td points lies on another branch than at the "
                "nearest pressures",
                (long long)w->branch_jumps, d->np);
    if (w->max_tilt > near_turn && strcmp(w->name, "2R") == 0)
        pm_warn("the end-effector points up to %.1f degrees away from +z: measure 2R is singular "
                "at 180",
                w->max_tilt * 180 / 3.14159265358979323846);
}

/* Contact is not modelled: states that penetrate themselves are not what the robot does. */
static void check_contact(const struct wsint_design *d)
{
    ptrdiff_t n = 0, worst = 0;
    for (ptrdiff_t i = 0; i < d->np; i++) {
        n += d->points[i].intersections > 0;
        if (d->points[i].intersections > d->points[worst].intersections)
            worst = i;
    }
    if (n > 0)
        pm_warn("the body penetrates itself in %td of %td states, with %lld pairs of faces in '%s'",
                n, d->np, (long long)d->points[worst].intersections, d->points[worst].path);
}

/* The measures of runs that went on there were up to 2.8 times their dense values. */
static void check_stability(const struct pm_case *c, const struct pm_work *w)
{
    if (c->amplification_max > 0 && w->amplification > c->amplification_max)
        pm_warn(
            "amplification %.3g, above amplification_max = %g: close to a loss of stability %ld "
            "points per axis may not measure the workspace (make workspace does)",
            w->amplification, c->amplification_max, c->points);
}

/* The chosen form into *work, the other one (if given) as its quadrature error. */
static enum pm_status integrate(const struct wsint_design *d, enum pm_form form,
                                struct pm_work *work, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const enum pm_form across = form == PM_FORM_BOUNDARY ? PM_FORM_VOLUME : PM_FORM_BOUNDARY;
    struct pm_work second = {.orientation = 0};
    struct wsint_set set = {.form = form}, other = {.form = across};

    PM_TRY(wsint_match(&d->pcase, d->points, d->np, &set, err));
    if (pm_measure_has_form(&d->pcase, across))
        PM_TRY(wsint_match(&d->pcase, d->points, d->np, &other, err));
    for (ptrdiff_t i = 0; i < d->np; i++)
        if (!d->points[i].used)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "cannot use '%s': its pressures are at no Gauss point of measure %s",
                           d->points[i].path, d->pcase.measure));
    if (set.ng == 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "no state at a point of the %s form, expected every point once",
                       pm_form_name(form)));
    PM_TRY(wsint_integrate(&d->pcase, d->points, &set, work, err));
    work->quadrature_error = -1;
    if (other.ng > 0) {
        second.orientation = work->orientation;
        PM_TRY(wsint_integrate(&d->pcase, d->points, &other, &second, err));
        work->value_other = second.value;
        if (work->value != 0)
            work->quadrature_error = fabs(work->value - second.value) / fabs(work->value);
    }
done:
    wsint_set_release(&set);
    wsint_set_release(&other);
    pm_work_release(&second);
    return status;
}

static void summarise(const struct pm_work *w)
{
    char error[64] = "";
    if (w->failure[0] != '\0') {
        pm_log(1, "failure recorded: %s", w->failure);
        return;
    }
    if (w->quadrature_error >= 0)
        snprintf(error, sizeof error, ", quadrature error %.2g", w->quadrature_error);
    pm_log(1,
           "%s = %.6g %s from %td points (%s form), det J %.3g to %.3g, amplification %.3g, "
           "objective %.6g%s",
           w->name, w->value, w->unit, w->ng, pm_form_name((enum pm_form)w->form), w->min_det,
           w->max_det, w->amplification, w->objective, error);
}

static enum pm_status show(const struct pm_common *common, struct pm_err *err)
{
    enum pm_status status;
    struct pm_work w = {.ng = 0};
    struct pm_workspace dense = {.nn = 0};
    char *kind = NULL, *history = NULL, *command = NULL;

    if (common->noperands != 1 || common->output != NULL)
        PM_TRY(pm_fail(err, PM_USAGE, "--show takes one work or workspace file and no output"));
    PM_TRY(pm_h5_ancestry(common->operands[0], &kind, &history, &command, err));
    if (kind != NULL && strcmp(kind, "workspace") == 0) {
        PM_TRY(pm_workspace_load(common->operands[0], &dense, err));
        wsint_show_workspace(&dense);
        goto done;
    }
    PM_TRY(pm_work_load(common->operands[0], 0, &w, err));
    printf("%s = %.6g %s (%s form, %td points)", w.name, w.value, w.unit,
           pm_form_name((enum pm_form)w.form), w.ng);
    if (w.quadrature_error >= 0)
        printf(", by the other form %.6g, quadrature error %.2g %%", w.value_other,
               100 * w.quadrature_error);
    printf(", det J %.3g to %.3g\n", w.min_det, w.max_det);
done:
    pm_free(kind);
    pm_free(history);
    pm_free(command);
    pm_workspace_release(&dense);
    pm_work_release(&w);
    return status;
}

enum pm_status wsint_apply(const struct wsint_opts *opts, struct pm_case *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    if (opts->form != NULL)
        PM_TRY(pm_form_parse(opts->form, &c->form, err));
    if (opts->measure != NULL)
        PM_TRY(pm_measure_select(c, opts->measure, err));
    if (opts->per_axis > 0)
        c->points = opts->per_axis;
    if (opts->full)
        c->full_set = 1;
done:
    return status;
}

static enum pm_status run(const struct wsint_opts *opts, const struct pm_common *common,
                          struct wsint_design *d, struct pm_work *work, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    const enum pm_form form = d->pcase.form;

    work->form = form;
    memcpy(work->failure, d->failure, sizeof work->failure);
    snprintf(work->name, sizeof work->name, "%s", d->pcase.measure);
    snprintf(work->unit, sizeof work->unit, "%s", pm_measure_unit(&d->pcase));
    if (work->failure[0] == '\0') {
        PM_TRY(integrate(d, form, work, err));
        check_folds(d, work);
        check_rotations(d, work);
        check_contact(d);
        check_stability(&d->pcase, work);
    }
    PM_TRY(pm_case_copy(&d->pcase, &work->pcase, err));
    PM_TRY(pm_h5_create(common->output, "work", common,
                        (const char *const[]){opts->sign_from, NULL}, &f, err));
    PM_TRY(pm_work_write(f, work, err));
    status = pm_h5_commit(f, err);
    f = NULL;
    summarise(work);
done:
    pm_h5_close(f);
    return status;
}

enum pm_status wsint_run(const struct wsint_opts *opts, const struct pm_common *common,
                         struct pm_err *err)
{
    enum pm_status status;
    struct wsint_design d = {0};
    struct pm_work work = {0};

    if (opts->show)
        return show(common, err);
    if (opts->points)
        return wsint_print_points(opts, common, err);
    if (opts->boundary > 0)
        return wsint_print_boundary(opts, common, err);
    if (common->output == NULL)
        return pm_fail(err, PM_USAGE, "no output, expected -o FILE");
    PM_TRY(wsint_design_read(common, opts->record_failure && !opts->dense, &d, err));
    PM_TRY(wsint_apply(opts, &d.pcase, err));
    if (opts->sign_from != NULL)
        PM_TRY(read_orientation(opts->sign_from, d.pcase.measure, &work.orientation, err));
    if (opts->dense) {
        PM_TRY(wsint_dense(common, opts->sign_from, work.orientation, &d, err));
    } else {
        PM_TRY(pm_measure_check(&d.pcase, d.pcase.form, err));
        PM_TRY(run(opts, common, &d, &work, err));
    }
done:
    pm_work_release(&work);
    wsint_design_release(&d);
    return status;
}
