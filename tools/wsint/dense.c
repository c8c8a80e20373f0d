/* The workspace from samples all over the boundary of the actuation box. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/actuation/branch.h"
#include "common/actuation/determinant.h"
#include "common/actuation/lattice.h"
#include "common/actuation/measure.h"
#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/workspace.h"
#include "common/mechanics/rotation.h"
#include "tools/wsint/design.h"

/* Samples and their images at the points of the lattice. */
struct net {
    struct pm_lattice l;
    int32_t *vertex; /* by id; -1: none (l.size) */
    double *J;       /* (nn x 6 x nc) */
};

/* The lattice of the samples: its interval is the smallest distance of a pressure from pmin. */
static enum pm_status find_lattice(const struct wsint_design *d, struct pm_lattice *l,
                                   struct pm_err *err)
{
    enum pm_status status;
    const struct pm_case *c = &d->pcase;
    const double range = c->pmax - c->pmin;
    double interval = range;

    for (ptrdiff_t i = 0; i < d->np; i++)
        for (ptrdiff_t r = 0; r < c->nchambers; r++) {
            const double above = d->points[i].pressure[r] - c->pmin;
            if (above > 1e-6 * range)
                interval = fmin(interval, above);
        }
    PM_TRY(pm_lattice_make(c, interval * (1 + 1e-6), l, err));
    for (ptrdiff_t i = 0; i < d->np; i++)
        if (pm_lattice_find(l, d->points[i].pressure) < 0)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "cannot use '%s': a sample is at none of the points of the boundary at "
                           "intervals of %.6g, expected those of wsint --boundary",
                           d->points[i].path, range / l->steps));
done:
    return status;
}

/* U(Pi p) = Qh U(p), J(Pi p) = Qh J Pi^T, Qh = diag(Q, det(Q) Q). */
static void image(const struct pm_case *c, ptrdiff_t g, const struct wsint_point *q, double *U,
                  double *J)
{
    const double *Q = c->symmetry.Q[g], axial = pm_det(3, Q);
    const ptrdiff_t nc = c->nchambers;

    for (int a = 0; a < 6; a++) {
        U[a] = 0;
        memset(J + nc * a, 0, (size_t)nc * sizeof *J);
        for (int b = 0; b < 3; b++) {
            const int row = (a < 3 ? 0 : 3) + b;
            const double f = Q[3 * (a % 3) + b] * (a < 3 ? 1 : axial);
            U[a] += f * q->U[row];
            for (ptrdiff_t r = 0; r < nc; r++)
                J[nc * a + c->symmetry.chamber[g][r]] += f * q->J[nc * row + r];
        }
    }
}

static enum pm_status missing(const struct net *net, ptrdiff_t id, struct pm_err *err)
{
    char text[64] = "";
    double p[PM_MAX_CHAMBERS];
    pm_lattice_pressure(&net->l, id, p);
    for (int r = 0, at = 0; r < net->l.n; r++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%s%.6g", r > 0 ? "," : "", p[r]);
    return pm_fail(err, PM_INPUT,
                   "no sample at p/mu = %s nor at an image of it, expected all points of wsint "
                   "--boundary %.6g",
                   text, (net->l.high - net->l.low) / net->l.steps);
}

static void locate(const struct pm_case *c, const struct pm_lattice *l, const double *U, double *x)
{
    struct pm_rotation rot;
    memset(x, 0, 3 * sizeof *x);
    pm_rotation_at(U + 3, 0, &rot);
    for (int i = 0; i < 3; i++) {
        if (l->path)
            x[i] = rot.R[3 * i + 2];
        else if (c->ndofs == 2)
            x[i] = c->dofs[0] == i || c->dofs[1] == i ? U[i] : 0;
        else
            x[i] = U[c->dofs[i]];
    }
}

static enum pm_status spread(const struct wsint_design *d, struct net *net, struct pm_workspace *w,
                             struct pm_err *err)
{
    enum pm_status status;
    const struct pm_case *c = &d->pcase;
    const struct pm_lattice *l = &net->l;

    PM_TRY(PM_NEW(net->vertex, l->size, err));
    for (ptrdiff_t id = 0; id < l->size; id++)
        net->vertex[id] = pm_lattice_has(l, id) ? (int32_t)w->nn++ : -1;
    w->nc = l->n;
    PM_TRY(PM_NEW(w->x, 3 * w->nn, err));
    PM_TRY(PM_NEW(w->U, 6 * w->nn, err));
    PM_TRY(PM_NEW(w->angle, w->nn, err));
    PM_TRY(PM_NEW(w->pressure, w->nc * w->nn, err));
    PM_TRY(PM_NEW(net->J, 6 * w->nc * w->nn, err));
    for (ptrdiff_t a = 0; a < w->nn; a++)
        w->angle[a] = -1; /* no sample yet */
    for (ptrdiff_t g = 0; g < c->symmetry.nops; g++)
        for (ptrdiff_t i = 0; i < d->np && pm_lattice_symmetry(c, g); i++) {
            const struct wsint_point *q = &d->points[i];
            const ptrdiff_t a =
                net->vertex[pm_lattice_image(c, l, g, pm_lattice_find(l, q->pressure))];
            if (w->angle[a] >= 0)
                continue;
            image(c, g, q, w->U + 6 * a, net->J + 6 * w->nc * a);
            w->angle[a] = pm_branch_tilt(w->U + 6 * a + 3);
            locate(c, l, w->U + 6 * a, w->x + 3 * a);
            w->intersections += q->intersections > 0;
        }
    for (ptrdiff_t id = 0; id < l->size; id++) {
        const ptrdiff_t a = net->vertex[id];
        if (a >= 0 && w->angle[a] < 0)
            PM_TRY(missing(net, id, err));
        if (a >= 0)
            pm_lattice_pressure(l, id, w->pressure + w->nc * a);
    }
done:
    return status;
}

/* The weight of point i among every `stride`-th. */
static double simpson(const struct pm_lattice *l, int stride, int i)
{
    const double h = stride * (l->high - l->low) / l->steps;
    return h / 3 * (i == 0 || i == l->steps ? 1 : i / stride % 2 ? 4 : 2);
}

/* The boundary form by Simpson's rule on every side. */
static enum pm_status integrate(const struct pm_case *c, const struct net *net,
                                const struct pm_workspace *w, int stride, double *value,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_lattice *l = &net->l;

    *value = 0;
    for (int s = 0; s < pm_lattice_sides(l); s++) {
        const struct pm_lattice_side side = pm_lattice_side(l, s);
        const struct pm_load load = {.face = side.face, .sign = side.sign};
        for (int i = 0; i <= l->steps; i += stride)
            for (int j = 0; j <= (side.axes > 1 ? l->steps : 0); j += stride) {
                double v, dU[6], dJ[6 * PM_MAX_CHAMBERS];
                const ptrdiff_t a =
                    net->vertex[side.origin + i * side.stride[0] + j * side.stride[1]];
                PM_TRY(pm_measure_point(c, PM_FORM_BOUNDARY, &load, w->U + 6 * a,
                                        net->J + 6 * w->nc * a, &v, dU, dJ, err));
                *value += simpson(l, stride, i) * (side.axes > 1 ? simpson(l, stride, j) : 1) * v;
            }
    }
done:
    return status;
}

/* Where the intervals come in fours, also by every other sample: that value is 16 times as far off.
 */
static enum pm_status measure(const struct pm_case *c, const struct net *net,
                              struct pm_workspace *w, struct pm_err *err)
{
    enum pm_status status;

    PM_TRY(integrate(c, net, w, 1, &w->value, err));
    if (w->orientation == 0)
        w->orientation = w->value < 0 ? -1 : 1;
    w->value *= w->orientation;
    w->value_coarse = NAN;
    if (net->l.steps % 4 == 0) {
        PM_TRY(integrate(c, net, w, 2, &w->value_coarse, err));
        w->value_coarse *= w->orientation;
    }
done:
    return status;
}

static enum pm_status connect(const struct net *net, struct pm_workspace *w, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_lattice *l = &net->l;
    const int sides = pm_lattice_sides(l);
    ptrdiff_t n = 0;

    w->npe = l->path ? 2 : l->n;
    w->ne = (ptrdiff_t)sides * l->steps * (w->npe == 3 ? 2 * l->steps : 1);
    PM_TRY(PM_NEW(w->cell, w->npe * w->ne, err));
    for (int s = 0; s < sides; s++) {
        const struct pm_lattice_side side = pm_lattice_side(l, s);
        const ptrdiff_t u = side.stride[0], v = side.stride[1];
        for (int i = 0; i < l->steps; i++)
            for (int j = 0; j < (w->npe == 3 ? l->steps : 1); j++) {
                const ptrdiff_t o = side.origin + i * u + j * v;
                const ptrdiff_t corner[6] = {o, o + u, o + u + v, o, o + u + v, o + v};
                for (int k = 0; k < (w->npe == 3 ? 6 : 2); k++)
                    w->cell[n++] = net->vertex[corner[k]];
            }
    }
done:
    return status;
}

/* Solid angle of the triangle (e_z, a, b), counted from +e_z (Van Oosterom, Strackee). */
static double solid_angle(const double *a, const double *b)
{
    const double triple = a[0] * b[1] - a[1] * b[0];
    return 2 * atan2(triple, 1 + a[2] + b[2] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The measure of what the cells enclose, where poses add: det(x_a, ..)/n! of each cell. */
static void measure_polygon(const struct pm_case *c, const struct net *net, struct pm_workspace *w)
{
    double sum = 0;

    w->value_polygon = NAN;
    for (ptrdiff_t e = 0; e < w->ne; e++) {
        double A[9];
        for (ptrdiff_t k = 0; k < w->npe; k++)
            for (int i = 0; i < (w->npe == 3 ? 3 : 2); i++)
                A[w->npe * k + i] =
                    net->l.path ? 0 : w->U[6 * w->cell[w->npe * e + k] + c->dofs[i]];
        if (net->l.path)
            sum += solid_angle(w->x + 3 * w->cell[2 * e], w->x + 3 * w->cell[2 * e + 1]);
        else
            sum += pm_det((int)w->npe, A) / (w->npe == 3 ? 6 : 2);
    }
    if (strchr(c->measure, 'T') != NULL || net->l.path)
        w->value_polygon = w->orientation * sum;
}

static int ascending(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static enum pm_status find_angles(const struct net *net, struct pm_workspace *w, struct pm_err *err)
{
    const ptrdiff_t center = net->l.path ? net->vertex[pm_lattice_center(&net->l)] : -1;
    ptrdiff_t n = 0;
    double *sorted = pm_calloc(w->nn, sizeof *sorted, err);

    if (sorted == NULL)
        return PM_SYSTEM;
    for (ptrdiff_t a = 0; a < w->nn; a++) {
        if (a == center)
            continue;
        sorted[n++] = w->angle[a];
        w->twist = fmax(w->twist, fabs(pm_branch_twist(w->U + 6 * a + 3)));
        for (int i = 0; i < 3; i++)
            w->rotation[i] = fmax(w->rotation[i], fabs(w->U[6 * a + 3 + i]));
    }
    qsort(sorted, (size_t)n, sizeof *sorted, ascending);
    w->tilt[0] = sorted[n - 1];
    w->tilt[1] = (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
    w->tilt[2] = sorted[0];
    pm_free(sorted);
    return PM_OK;
}

/* Turns of the path of 2R about the direction at the centre of the box: 0 is outside. */
static int64_t turns_about_center(const struct net *net, const struct pm_workspace *w)
{
    const double *z = w->x + 3 * net->vertex[pm_lattice_center(&net->l)];
    double sum = 0;

    for (ptrdiff_t e = 0; e < w->ne; e++) {
        const double *a = w->x + 3 * w->cell[2 * e], *b = w->x + 3 * w->cell[2 * e + 1];
        double across = 0, dots[3] = {0};
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            across += z[i] * (a[j] * b[k] - a[k] * b[j]);
            dots[0] += a[i] * b[i];
            dots[1] += a[i] * z[i];
            dots[2] += b[i] * z[i];
        }
        sum += atan2(across, dots[0] - dots[1] * dots[2]);
    }
    return (int64_t)lround(sum / (2 * 3.14159265358979323846));
}

static void check(const struct pm_case *c, const struct net *net, struct pm_workspace *w)
{
    w->min_det = INFINITY;
    w->max_det = -INFINITY;
    for (ptrdiff_t a = 0; a < w->nn; a++) {
        const double det = w->orientation * pm_measure_det(c, net->J + 6 * w->nc * a);
        w->min_det = fmin(w->min_det, det);
        w->max_det = fmax(w->max_det, det);
        w->sign_changes += det < 0;
    }
    for (ptrdiff_t k = 0; k < w->npe * w->ne; k++) {
        const ptrdiff_t a = w->cell[k], b = w->cell[k - k % w->npe + (k + 1) % w->npe];
        w->branch_jumps += pm_branch_jump(w->U + 6 * a + 3, w->U + 6 * b + 3);
    }
    if (w->sign_changes > 0)
        pm_warn("the workspace folds: det J has the wrong sign at %lld of %td samples (%.3g to "
                "%.3g), folded parts count negative",
                (long long)w->sign_changes, w->nn, w->min_det, w->max_det);
    if (w->branch_jumps > 0)
        pm_warn("the rotation vector leaves its branch between %lld pairs of neighbours",
                (long long)w->branch_jumps);
    if (w->intersections > 0)
        pm_warn("the body penetrates itself at %lld of %td samples", (long long)w->intersections,
                w->nn);
    if (net->l.path) {
        w->interior = turns_about_center(net, w);
        if (w->interior == 0)
            pm_warn("the direction at the centre of the actuation box lies outside its path");
    }
}

void wsint_show_workspace(const struct pm_workspace *w)
{
    const double degree = 180 / 3.14159265358979323846;
    printf("%s = %.6g %s (dense, interval %.4g, %td samples)", w->name, w->value, w->unit,
           w->interval, w->nn);
    if (!isnan(w->value_coarse))
        printf(", at twice the interval %.6g: error about %.2g %%", w->value_coarse,
               100 * fabs(w->value_coarse / w->value - 1) / 15);
    if (!isnan(w->value_polygon))
        printf(", of the %s %.6g", w->npe == 3 ? "polyhedron" : "polygon", w->value_polygon);
    printf("; pointing angle max %.1f, median %.1f, min %.1f; largest U4 %.1f, U5 %.1f, U6 %.1f, "
           "twist %.1f degrees\n",
           degree * w->tilt[0], degree * w->tilt[1], degree * w->tilt[2], degree * w->rotation[0],
           degree * w->rotation[1], degree * w->rotation[2], degree * w->twist);
}

enum pm_status wsint_dense(const struct pm_common *common, const char *sign_from,
                           double orientation, struct wsint_design *d, struct pm_err *err)
{
    enum pm_status status;
    struct net net = {.vertex = NULL};
    struct pm_workspace w = {.orientation = orientation};
    const struct pm_case *c = &d->pcase;
    struct pm_h5 *f = NULL;

    PM_TRY(find_lattice(d, &net.l, err));
    PM_TRY(spread(d, &net, &w, err));
    PM_TRY(measure(c, &net, &w, err));
    PM_TRY(connect(&net, &w, err));
    measure_polygon(c, &net, &w);
    PM_TRY(find_angles(&net, &w, err));
    check(c, &net, &w);
    w.interval = (net.l.high - net.l.low) / net.l.steps;
    snprintf(w.name, sizeof w.name, "%s", c->measure);
    snprintf(w.unit, sizeof w.unit, "%s", pm_measure_unit(c));
    PM_TRY(pm_case_copy(c, &w.pcase, err));
    PM_TRY(pm_h5_create(common->output, "workspace", common, (const char *const[]){sign_from, NULL},
                        &f, err));
    PM_TRY(pm_workspace_write(f, &w, err));
    status = pm_h5_commit(f, err);
    f = NULL;
    pm_log(1, "%s = %.6g %s at intervals of %.4g", w.name, w.value, w.unit, w.interval);
done:
    pm_h5_close(f);
    pm_workspace_release(&w);
    pm_free(net.vertex);
    pm_free(net.J);
    return status;
}
