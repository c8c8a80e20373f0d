#include "common/actuation/measure.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/determinant.h"
#include "common/actuation/pointing.h"

/* How a measure integrates: over which kinds of DoFs, with which density and field. */
enum field { EUCLIDEAN, ROTATIONS, POSES, POINTING };

static const struct kind {
    const char *name, *unit, *dofs;
    enum field field;
    int translations, rotations; /* selected DoFs of each kind */
    int chambers;
    int has_volume; /* the volume form exists */
    int rows[6];    /* DoFs unless the case names others, 0-based */
} KINDS[] = {
    {"2T", "mm2", "two translations", EUCLIDEAN, 2, 0, 2, 1, {0, 2}},
    {"3T", "mm3", "U1,U2,U3", EUCLIDEAN, 3, 0, 3, 1, {0, 1, 2}},
    {"1R2T", "mm2 rad", "two translations and one rotation", EUCLIDEAN, 2, 1, 3, 1, {0, 2, 4}},
    {"3R", "1", "U4,U5,U6", ROTATIONS, 0, 3, 3, 1, {3, 4, 5}},
    {"3R3T", "mm3", "U1,..,U6", POSES, 3, 3, 6, 1, {0, 1, 2, 3, 4, 5}},
    {"2R", "sr", "U4,U5,U6", POINTING, 0, 3, 3, 0, {3, 4, 5}},
};

static const char NAMES[] = "2T, 3T, 1R2T, 2R, 3R or 3R3T";

static const struct kind *find_kind(const struct pm_case *c)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        if (strcmp(KINDS[k].name, c->measure) == 0)
            return &KINDS[k];
    return NULL;
}

enum pm_status pm_measure_check(const struct pm_case *c, enum pm_form form, struct pm_err *err)
{
    const struct kind *k = find_kind(c);
    int translations = 0, rotations = 0, ascending = 1;

    if (k == NULL)
        return pm_fail(err, PM_INPUT, "%s measure '%s' in the case, expected %s",
                       c->measure[0] == '\0' ? "no" : "unknown", c->measure, NAMES);
    for (int i = 0; i < c->ndofs; i++) {
        translations += c->dofs[i] < 3;
        rotations += c->dofs[i] >= 3;
        ascending = ascending && (i == 0 || c->dofs[i] > c->dofs[i - 1]);
    }
    if (translations != k->translations || rotations != k->rotations || !ascending)
        return pm_fail(
            err, PM_INPUT,
            "measure %s got %d translations and %d rotations, expected %s in ascending order",
            k->name, translations, rotations, k->dofs);
    if (c->nchambers != k->chambers)
        return pm_fail(err, PM_INPUT, "measure %s got %td chambers, expected %d", k->name,
                       c->nchambers, k->chambers);
    if (form == PM_FORM_VOLUME && !k->has_volume)
        return pm_fail(err, PM_INPUT, "measure %s has no volume form, expected boundary", k->name);
    return PM_OK;
}

int pm_measure_has_form(const struct pm_case *c, enum pm_form form)
{
    const struct kind *k = find_kind(c);
    return k != NULL && (form == PM_FORM_BOUNDARY || k->has_volume);
}

enum pm_status pm_measure_select(struct pm_case *c, const char *name, struct pm_err *err)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
        if (strcmp(KINDS[k].name, name) != 0)
            continue;
        snprintf(c->measure, sizeof c->measure, "%s", name);
        c->ndofs = KINDS[k].translations + KINDS[k].rotations;
        memcpy(c->dofs, KINDS[k].rows, sizeof c->dofs);
        return PM_OK;
    }
    return pm_fail(err, PM_USAGE, "unknown measure '%s', expected %s", name, NAMES);
}

const char *pm_measure_unit(const struct pm_case *c)
{
    const struct kind *k = find_kind(c);
    return k != NULL ? k->unit : "";
}

double pm_measure_det(const struct pm_case *c, const double *J)
{
    const struct kind *k = find_kind(c);
    const int n = c->ndofs, nc = (int)c->nchambers;
    double A[36];

    if (k == NULL || k->field == POINTING || n != nc)
        return 0;
    for (int i = 0; i < n; i++)
        memcpy(A + n * i, J + nc * c->dofs[i], (size_t)n * sizeof *A);
    return pm_det(n, A);
}

/* h = 2 (eta - sin eta)/eta^3 and dh/ds, sinc^2(eta/2) = om and dom/ds, s = eta^2. The series ends
 * below rounding for s <= 1. */
static void rotation_functions(double s, double *h, double *dh, double *om, double *dom)
{
    if (s <= 1) {
        double a = 2.0 / 6, b = 1; /* 2 (-1)^k/(2k+3)!, 2 (-1)^k/(2k+2)! */
        *h = *dh = *om = *dom = 0;
        for (int k = 0; k < 12; k++) {
            const double power = pow(s, k), slope = k > 0 ? k * pow(s, k - 1) : 0;
            *h += a * power;
            *dh += a * slope;
            *om += b * power;
            *dom += b * slope;
            a /= -(double)((2 * k + 4) * (2 * k + 5));
            b /= -(double)((2 * k + 3) * (2 * k + 4));
        }
        return;
    }
    const double eta = sqrt(s);
    *h = 2 * (eta - sin(eta)) / (s * eta);
    *dh = ((1 - cos(eta)) / s - 1.5 * *h) / s;
    *om = 2 * (1 - cos(eta)) / s;
    *dom = (sin(eta) / eta - *om) / s;
}

/* Density of the measure at U and its gradient over the selected DoFs (n). */
static double density(const struct pm_case *c, const struct kind *k, const double *U, double *grad)
{
    double h, dh, om, dom;
    memset(grad, 0, 6 * sizeof *grad);
    if (k->field == EUCLIDEAN)
        return 1;
    rotation_functions(U[3] * U[3] + U[4] * U[4] + U[5] * U[5], &h, &dh, &om, &dom);
    for (int i = 0; i < c->ndofs; i++)
        grad[i] = c->dofs[i] < 3 ? 0 : dom * 2 * U[c->dofs[i]] / 8;
    return om / 8;
}

/* F(U) with div F = n * density over the selected DoFs, and DF (n x n). */
static void field(const struct pm_case *c, const struct kind *k, const double *U, double *F,
                  double *DF)
{
    const int n = c->ndofs;
    double h, dh, om, dom;

    memset(DF, 0, 36 * sizeof *DF);
    if (k->field == EUCLIDEAN) {
        for (int i = 0; i < n; i++) {
            F[i] = U[c->dofs[i]];
            DF[n * i + i] = 1;
        }
        return;
    }
    rotation_functions(U[3] * U[3] + U[4] * U[4] + U[5] * U[5], &h, &dh, &om, &dom);
    /* poses: lambda = 0, the choice that does not depend on the origin of the translations */
    const double scale = n / 8.0;
    for (int i = 0; i < n; i++) {
        const int a = c->dofs[i];
        F[i] = a < 3 ? 0 : scale * h * U[a];
        for (int j = 0; j < n; j++) {
            const int b = c->dofs[j];
            if (a >= 3 && b >= 3)
                DF[n * i + j] = scale * ((i == j) * h + 2 * dh * U[a] * U[b]);
        }
    }
}

/* w = (sign/n) det(J with column `face` replaced by F). */
static double boundary_form(const struct pm_case *c, const struct kind *k,
                            const struct pm_load *load, const double *U, const double *J,
                            double *dw_dU, double *dw_dJ)
{
    const int n = c->ndofs, r = load->face;
    const double scale = (double)load->sign / n;
    double F[6], DF[36], A[36] = {0}, cof[36];

    field(c, k, U, F, DF);
    for (int i = 0; i < n; i++)
        for (int s = 0; s < n; s++)
            A[n * i + s] = s == r ? F[i] : J[n * c->dofs[i] + s];
    pm_cofactors(n, A, cof);
    for (int i = 0; i < n; i++)
        for (int s = 0; s < n; s++) {
            if (s != r)
                dw_dJ[n * c->dofs[i] + s] = scale * cof[n * i + s];
            dw_dU[c->dofs[i]] += scale * DF[n * s + i] * cof[n * s + r];
        }
    return scale * pm_det(n, A);
}

/* w = density * det J. */
static double volume_form(const struct pm_case *c, const struct kind *k, const double *U,
                          const double *J, double *dw_dU, double *dw_dJ)
{
    const int n = c->ndofs;
    double A[36] = {0}, cof[36], grad[6];

    for (int i = 0; i < n; i++)
        memcpy(A + n * i, J + n * c->dofs[i], (size_t)n * sizeof *A);
    pm_cofactors(n, A, cof);
    const double rho = density(c, k, U, grad), det = pm_det(n, A);
    for (int i = 0; i < n; i++) {
        dw_dU[c->dofs[i]] = grad[i] * det;
        for (int s = 0; s < n; s++)
            dw_dJ[n * c->dofs[i] + s] = rho * cof[n * i + s];
    }
    return rho * det;
}

enum pm_status pm_measure_point(const struct pm_case *c, enum pm_form form,
                                const struct pm_load *load, const double U[6], const double *J,
                                double *w, double dw_dU[6], double *dw_dJ, struct pm_err *err)
{
    const enum pm_status status = pm_measure_check(c, form, err);
    const struct kind *k = find_kind(c);

    if (status != PM_OK)
        return status;
    memset(dw_dU, 0, 6 * sizeof *dw_dU);
    memset(dw_dJ, 0, (size_t)(6 * c->nchambers) * sizeof *dw_dJ);
    if (k->field == POINTING)
        return pm_pointing_point(load, (int)c->nchambers, U, J, w, dw_dU, dw_dJ, err);
    *w = form == PM_FORM_VOLUME ? volume_form(c, k, U, J, dw_dU, dw_dJ)
                                : boundary_form(c, k, load, U, J, dw_dU, dw_dJ);
    return PM_OK;
}
