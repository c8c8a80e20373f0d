#include "tools/wsint/wsint.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/measure.h"
#include "common/base/log.h"
#include "common/base/memory.h"

struct design {
    struct pm_case pcase;
    ptrdiff_t nn;
    double *x;                  /* reference node positions of the first state (nn x 3) */
    struct wsint_point *points; /* (np) */
    ptrdiff_t np;
    char failure[512]; /* of a state, "" if all are equilibria */
};

static void design_release(struct design *d)
{
    pm_case_release(&d->pcase);
    pm_free(d->x);
    pm_free(d->points);
}

/* Everything after the first state must belong to the same case and the same mesh. */
static enum pm_status add_state(struct design *d, ptrdiff_t i, const char *path, struct pm_state *s,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_mesh *m = &s->mesh;
    struct wsint_point *q = &d->points[i];

    if (d->pcase.text == NULL)
        PM_TRY(pm_case_copy(&m->pcase, &d->pcase, err));
    if (strcmp(d->pcase.text, m->pcase.text) != 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': its case differs from that of the other states", path));
    if (s->failure[0] != '\0') {
        if (d->failure[0] == '\0')
            memcpy(d->failure, s->failure, sizeof d->failure);
        goto done;
    }
    if (m->nc != d->pcase.nchambers)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': it has %td chambers, expected %td", path,
                       m->nc, d->pcase.nchambers));
    if (d->x == NULL) {
        d->nn = m->nn;
        d->x = s->mesh.x;
        s->mesh.x = NULL;
    } else if (d->nn != m->nn || memcmp(d->x, m->x, (size_t)(3 * m->nn) * sizeof(double)) != 0) {
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': its mesh differs from that of the other states", path));
    }
    q->path = path;
    memcpy(q->pressure, s->pressure, (size_t)m->nc * sizeof(double));
    memcpy(q->U, s->U, sizeof q->U);
    memcpy(q->J, s->J, (size_t)(6 * m->nc) * sizeof(double));
    q->intersections = s->contact.intersections;
    q->gap = s->contact.gap;
done:
    return status;
}

static enum pm_status read_states(const struct wsint_opts *opts, const struct pm_common *common,
                                  struct design *d, struct pm_err *err)
{
    enum pm_status status;
    struct pm_state s = {0};

    d->np = common->noperands;
    PM_TRY(PM_NEW(d->points, d->np, err));
    for (ptrdiff_t i = 0; i < d->np; i++) {
        PM_TRY(pm_state_load(common->operands[i], opts->record_failure, &s, err));
        PM_TRY(add_state(d, i, common->operands[i], &s, err));
        pm_state_release(&s);
        s = (struct pm_state){0};
    }
done:
    pm_state_release(&s);
    return status;
}

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
static void check_folds(const struct design *d, struct pm_work *w)
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

/* Contact is not modelled: states that penetrate themselves are not what the robot does. */
static void check_contact(const struct design *d)
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

/* The chosen form into *work, the other one (if given) as its quadrature error. */
static enum pm_status integrate(const struct design *d, enum pm_form form, struct pm_work *work,
                                struct pm_err *err)
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
    pm_log(1, "%s = %.6g %s from %td points (%s form), det J %.3g to %.3g%s", w->name, w->value,
           w->unit, w->ng, pm_form_name((enum pm_form)w->form), w->min_det, w->max_det, error);
}

static enum pm_status show(const struct pm_common *common, struct pm_err *err)
{
    enum pm_status status;
    struct pm_work w = {.ng = 0};

    if (common->noperands != 1 || common->output != NULL)
        PM_TRY(pm_fail(err, PM_USAGE, "--show takes one work file and no output"));
    PM_TRY(pm_work_load(common->operands[0], 0, &w, err));
    printf("%s = %.6g %s (%s form, %td points)", w.name, w.value, w.unit,
           pm_form_name((enum pm_form)w.form), w.ng);
    if (w.quadrature_error >= 0)
        printf(", by the other form %.6g, quadrature error %.2g %%", w.value_other,
               100 * w.quadrature_error);
    printf(", det J %.3g to %.3g\n", w.min_det, w.max_det);
done:
    pm_work_release(&w);
    return status;
}

static enum pm_status print_points(const struct wsint_opts *opts, const struct pm_common *common,
                                   struct pm_err *err)
{
    enum pm_status status;
    struct pm_case c = {0};
    struct pm_load *loads = NULL;
    ptrdiff_t n;
    enum pm_form form;

    if (common->noperands != 1 || common->output != NULL)
        PM_TRY(pm_fail(err, PM_USAGE, "--points takes one case file and no output"));
    PM_TRY(pm_case_load(common->operands[0], &c, err));
    form = c.form;
    if (opts->form != NULL)
        PM_TRY(pm_form_parse(opts->form, &form, err));
    if (opts->measure != NULL)
        PM_TRY(pm_measure_select(&c, opts->measure, err));
    PM_TRY(pm_load_set(&c, form, &loads, &n, err));
    printf("point\tmultiplicity\tweight\tface\tsign");
    for (ptrdiff_t r = 0; r < c.nchambers; r++)
        printf("\tp%td", r + 1);
    for (ptrdiff_t g = 0; g < n; g++) {
        printf("\n%td\t%d\t%.9g\t%d\t%d", g, loads[g].multiplicity, loads[g].weight,
               loads[g].face + 1, loads[g].sign);
        for (ptrdiff_t r = 0; r < c.nchambers; r++)
            printf("\t%.9g", loads[g].p[r]);
    }
    putchar('\n');
done:
    pm_free(loads);
    pm_case_release(&c);
    return status;
}

enum pm_status wsint_run(const struct wsint_opts *opts, const struct pm_common *common,
                         struct pm_err *err)
{
    enum pm_status status;
    struct design d = {0};
    struct pm_work work = {0};
    struct pm_h5 *f = NULL;
    enum pm_form form;

    if (opts->show)
        return show(common, err);
    if (opts->points)
        return print_points(opts, common, err);
    if (common->output == NULL)
        return pm_fail(err, PM_USAGE, "no output, expected -o FILE");
    PM_TRY(read_states(opts, common, &d, err));
    form = d.pcase.form;
    if (opts->form != NULL)
        PM_TRY(pm_form_parse(opts->form, &form, err));
    if (opts->measure != NULL)
        PM_TRY(pm_measure_select(&d.pcase, opts->measure, err));
    PM_TRY(pm_measure_check(&d.pcase, form, err));
    if (opts->sign_from != NULL)
        PM_TRY(read_orientation(opts->sign_from, d.pcase.measure, &work.orientation, err));
    work.form = form;
    memcpy(work.failure, d.failure, sizeof work.failure);
    snprintf(work.name, sizeof work.name, "%s", d.pcase.measure);
    snprintf(work.unit, sizeof work.unit, "%s", pm_measure_unit(&d.pcase));
    if (work.failure[0] == '\0') {
        PM_TRY(integrate(&d, form, &work, err));
        check_folds(&d, &work);
        check_contact(&d);
    }
    PM_TRY(pm_case_copy(&d.pcase, &work.pcase, err));
    PM_TRY(pm_h5_create(common->output, "work", common,
                        (const char *const[]){opts->sign_from, NULL}, &f, err));
    PM_TRY(pm_work_write(f, &work, err));
    status = pm_h5_commit(f, err);
    f = NULL;
    summarise(&work);
done:
    pm_h5_close(f);
    pm_work_release(&work);
    design_release(&d);
    return status;
}
