#include "common/actuation/measure.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/determinant.h"
#include "common/actuation/pointing.h"
#include "common/actuation/weight.h"

/* How a measure integrates: over which kinds of DoFs, with which density and field. */
enum field { EUCLIDEAN, ROTATIONS, POSES, POINTING, MANIFOLD };

static const struct kind {
    const char *name, *unit, *dofs;
    enum field field;
    int translations, rotations; /* selected DoFs of each kind; manifold: any */
    int chambers;
    int forms;   /* bit f: form f exists */
    int rows[6]; /* DoFs unless the case names others, 0-based */
} KINDS[] = {
    {"2T", "mm2", "two translations", EUCLIDEAN, 2, 0, 2, 3, {0, 2}},
    {"3T", "mm3", "U1,U2,U3", EUCLIDEAN, 3, 0, 3, 3, {0, 1, 2}},
    {"1R2T", "mm2 rad", "two translations and one rotation", EUCLIDEAN, 2, 1, 3, 3, {0, 2, 4}},
    {"3R", "1", "U4,U5,U6", ROTATIONS, 0, 3, 3, 3, {3, 4, 5}},
    {"3R3T", "mm3", "U1,..,U6", POSES, 3, 3, 6, 3, {0, 1, 2, 3, 4, 5}},
    {"2R", "sr", "U4,U5,U6", POINTING, 0, 3, 3, 1, {3, 4, 5}},
    {"manifold", "", "any", MANIFOLD, 0, 0, 0, 2, {0}},
};

static const char NAMES[] = "2T, 3T, 1R2T, 2R, 3R, 3R3T or manifold";

static const struct kind *find_kind(const struct pm_case *c)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        if (strcmp(KINDS[k].name, c->measure) == 0)
            return &KINDS[k];
    return NULL;
}

static void count_dofs(const struct pm_case *c, int *translations, int *rotations)
{
    *translations = *rotations = 0;
    for (int i = 0; i < c->ndofs; i++) {
        *translations += c->dofs[i] < 3;
        *rotations += c->dofs[i] >= 3;
    }
}

static enum pm_status check_manifold(const struct pm_case *c, struct pm_err *err)
{
    int translations, rotations;
    count_dofs(c, &translations, &rotations);
    if (c->nchambers < 1 || c->nchambers > c->ndofs)
        return pm_fail(err, PM_INPUT,
                       "measure manifold got %td chambers and %d DoFs, expected 1 to %d chambers; "
                       "with more chambers than DoFs poses repeat, and no measure counts them once",
                       c->nchambers, c->ndofs, c->ndofs);
    if (translations > 0 && rotations > 0 && !(c->lever > 0))
        return pm_fail(err, PM_INPUT,
                       "measure manifold over translations and rotations needs the key 'lever' "
                       "[mm], the arc of a rotation by 1 rad");
    return PM_OK;
}

static enum pm_status check_kind(const struct pm_case *c, const struct kind *k, struct pm_err *err)
{
    int translations, rotations, ascending = 1;
    count_dofs(c, &translations, &rotations);
    for (int i = 1; i < c->ndofs; i++)
        ascending = ascending && c->dofs[i] > c->dofs[i - 1];
    if (translations != k->translations || rotations != k->rotations || !ascending)
        return pm_fail(
            err, PM_INPUT,
            "measure %s got %d translations and %d rotations, expected %s in ascending order",
            k->name, translations, rotations, k->dofs);
    if (c->nchambers != k->chambers)
        return pm_fail(err, PM_INPUT, "measure %s got %td chambers, expected %d", k->name,
                       c->nchambers, k->chambers);
    return PM_OK;
}

enum pm_status pm_measure_check(const struct pm_case *c, enum pm_form form, struct pm_err *err)
{
    enum pm_status status;
    const struct kind *k = find_kind(c);

    if (k == NULL)
        return pm_fail(err, PM_INPUT, "%s measure '%s' in the case, expected %s",
                       c->measure[0] == '\0' ? "no" : "unknown", c->measure, NAMES);
    PM_TRY(k->field == MANIFOLD ? check_manifold(c, err) : check_kind(c, k, err));
    if (!pm_measure_has_form(c, form))
        PM_TRY(pm_fail(err, PM_INPUT, "measure %s%s%s has no %s form, expected %s", k->name,
                       c->weight.kind != PM_WEIGHT_NONE ? " with a weight" : "",
                       c->taylor ? " by the taylor field" : "", pm_form_name(form),
                       form == PM_FORM_VOLUME ? "boundary" : "volume"));
    if (c->taylor && k->field != ROTATIONS)
        PM_TRY(pm_fail(err, PM_INPUT, "measure %s has no taylor field, expected 3R", k->name));
    if (c->weight.kind != PM_WEIGHT_NONE && k->field == POINTING)
        PM_TRY(pm_fail(err, PM_INPUT, "measure 2R takes no weight, expected weight = none"));
done:
    return status;
}

int pm_measure_has_form(const struct pm_case *c, enum pm_form form)
{
    const struct kind *k = find_kind(c);
    if (k == NULL || (k->forms >> form & 1) == 0)
        return 0;
    return form == PM_FORM_VOLUME ? !c->taylor
                                  : c->weight.kind == PM_WEIGHT_NONE || k->field == POINTING;
}

enum pm_status pm_measure_select(struct pm_case *c, const char *name, struct pm_err *err)
{
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
        if (strcmp(KINDS[k].name, name) != 0)
            continue;
        snprintf(c->measure, sizeof c->measure, "%s", name);
        if (KINDS[k].field != MANIFOLD) {
            c->ndofs = KINDS[k].translations + KINDS[k].rotations;
            memcpy(c->dofs, KINDS[k].rows, sizeof c->dofs);
        }
        return PM_OK;
    }
    return pm_fail(err, PM_USAGE, "unknown measure '%s', expected %s", name, NAMES);
}

const char *pm_measure_unit(const struct pm_case *c)
{
    static const char *const lengths[] = {"1", "mm", "mm2", "mm3", "mm4", "mm5", "mm6"};
    static const char *const angles[] = {"1", "rad", "rad2", "rad3"};
    const struct kind *k = find_kind(c);
    int translations, rotations;

    if (k == NULL || k->field != MANIFOLD)
        return k != NULL ? k->unit : "";
    count_dofs(c, &translations, &rotations);
    return translations > 0 ? lengths[c->nchambers] : angles[c->nchambers];
}

/* Selected rows of J, those of rotations times the lever where translations are among them. */
static void select_rows(const struct pm_case *c, const double *J, double *A, double *scale)
{
    const int nc = (int)c->nchambers;
    int translations, rotations;

    count_dofs(c, &translations, &rotations);
    for (int i = 0; i < c->ndofs; i++) {
        scale[i] = c->dofs[i] >= 3 && translations > 0 ? c->lever : 1;
        for (int r = 0; r < nc; r++)
            A[nc * i + r] = scale[i] * J[nc * c->dofs[i] + r];
    }
}

/* G = A^T A (nc x nc). */
static void gram(int m, int nc, const double *A, double *G)
{
    for (int r = 0; r < nc; r++)
        for (int s = 0; s < nc; s++) {
            G[nc * r + s] = 0;
            for (int i = 0; i < m; i++)
                G[nc * r + s] += A[nc * i + r] * A[nc * i + s];
        }
}

double pm_measure_det(const struct pm_case *c, const double *J)
{
    const struct kind *k = find_kind(c);
    const int n = c->ndofs, nc = (int)c->nchambers;
    double A[36], G[36], scale[6];

    if (k == NULL || k->field == POINTING || (k->field == MANIFOLD ? nc > n : nc != n))
        return 0;
    if (k->field == MANIFOLD) {
        select_rows(c, J, A, scale);
        gram(n, nc, A, G);
        return sqrt(fmax(0, pm_det(nc, G)));
    }
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
    const double square = U[3] * U[3] + U[4] * U[4] + U[5] * U[5];
    if (c->taylor) { /* U_i (1 - (|theta|^2 - 2 U_i^2/3)/12)/8 */
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                const double t = U[c->dofs[i]];
                F[i] = t * (1 - (square - t * t * 2 / 3) / 12) / 8;
                DF[n * i + j] = (i == j ? 1 - square / 12 : -t * U[c->dofs[j]] / 6) / 8;
            }
        return;
    }
    rotation_functions(square, &h, &dh, &om, &dom);
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

/* w = sqrt det G, G = A^T A, A the selected rows of J: dw/dA = A cof(G)/w. */
static enum pm_status manifold(const struct pm_case *c, const double *J, double *w, double *dw_dJ,
                               struct pm_err *err)
{
    const int n = c->ndofs, nc = (int)c->nchambers;
    double A[36], G[36], cof[36], scale[6], size = 1;

    select_rows(c, J, A, scale);
    gram(n, nc, A, G);
    for (int r = 0; r < nc; r++)
        size *= sqrt(G[nc * r + r]);
    *w = sqrt(fmax(0, pm_det(nc, G)));
    if (!(*w > 1e-7 * size)) /* the square is rounding of the products in G */
        return pm_fail(err, PM_NUMERIC,
                       "the columns of J are dependent (sqrt det J'J = %.3g of %.3g), where "
                       "measure manifold has no derivative",
                       *w, size);
    pm_cofactors(nc, G, cof);
    for (int i = 0; i < n; i++)
        for (int r = 0; r < nc; r++) {
            double sum = 0;
            for (int s = 0; s < nc; s++)
                sum += A[nc * i + s] * cof[nc * s + r];
            dw_dJ[nc * c->dofs[i] + r] = scale[i] * sum / *w;
        }
    return PM_OK;
}

/* w times the weight at U. */
static void apply_weight(const struct pm_case *c, const double U[6], double *w, double *dw_dU,
                         double *dw_dJ)
{
    double grad[6];
    const double rho = pm_weight_at(&c->weight, U, grad);

    for (int i = 0; i < 6; i++)
        dw_dU[i] = rho * dw_dU[i] + *w * grad[i];
    for (ptrdiff_t i = 0; i < 6 * c->nchambers; i++)
        dw_dJ[i] *= rho;
    *w *= rho;
}

enum pm_status pm_measure_point(const struct pm_case *c, enum pm_form form,
                                const struct pm_load *load, const double U[6], const double *J,
                                double *w, double dw_dU[6], double *dw_dJ, struct pm_err *err)
{
    enum pm_status status = pm_measure_check(c, form, err);
    const struct kind *k = find_kind(c);

    if (status != PM_OK)
        return status;
    memset(dw_dU, 0, 6 * sizeof *dw_dU);
    memset(dw_dJ, 0, (size_t)(6 * c->nchambers) * sizeof *dw_dJ);
    if (k->field == POINTING)
        return pm_pointing_point(load, (int)c->nchambers, U, J, w, dw_dU, dw_dJ, err);
    if (form == PM_FORM_BOUNDARY) {
        *w = boundary_form(c, k, load, U, J, dw_dU, dw_dJ);
        return PM_OK;
    }
    if (k->field == MANIFOLD)
        status = manifold(c, J, w, dw_dJ, err);
    else
        *w = volume_form(c, k, U, J, dw_dU, dw_dJ);
    if (status == PM_OK)
        apply_weight(c, U, w, dw_dU, dw_dJ);
    return status;
}
