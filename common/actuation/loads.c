#include "common/actuation/loads.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "common/actuation/determinant.h"
#include "common/actuation/measure.h"
#include "common/actuation/weight.h"
#include "common/base/memory.h"

enum { MAX_POINTS = 100000, MANY_CHAMBERS = 4, MAX_GUARDS = PM_MAX_CHAMBERS + 1 };

/* One point of a full set in integers: place 1..m of each axis, 0 = pmin, m + 1 = pmax. */
struct point {
    int place[PM_MAX_CHAMBERS];
    int face, sign;
};

static const struct pm_edge PATH[6] = {{1, 1, 0},  {0, -1, 1}, {2, 1, 1},
                                       {1, -1, 2}, {0, 1, 2},  {2, -1, 0}};

struct pm_edge pm_load_edge(int e)
{
    return PATH[e];
}

const char *pm_form_name(enum pm_form form)
{
    return form == PM_FORM_VOLUME ? "volume" : "boundary";
}

enum pm_status pm_form_parse(const char *text, enum pm_form *form, struct pm_err *err)
{
    for (int f = PM_FORM_BOUNDARY; f <= PM_FORM_VOLUME; f++)
        if (strcmp(text, pm_form_name((enum pm_form)f)) == 0) {
            *form = (enum pm_form)f;
            return PM_OK;
        }
    return pm_fail(err, PM_USAGE, "unknown form '%s', expected boundary or volume", text);
}

static int is_pointing(const struct pm_case *c)
{
    return strcmp(c->measure, "2R") == 0;
}

/* det of Qh = diag(Q, det(Q) Q) restricted to the DoFs sel; 0 if Qh mixes them with others. */
static double selected_det(const double *Q, const int *sel, int n)
{
    const double axial = pm_det(3, Q);
    double A[36];

    for (int i = 0; i < n; i++) {
        double norm = 0;
        for (int j = 0; j < n; j++) {
            const int a = sel[i], b = sel[j];
            const double q = Q[3 * (a % 3) + b % 3] * (a < 3 ? 1 : axial);
            A[n * i + j] = a / 3 == b / 3 ? q : 0;
            norm += A[n * i + j] * A[n * i + j];
        }
        if (fabs(norm - 1) >
            1e-9) /* rows of an orthogonal Qh have norm 1 unless entries fell outside sel */
            return 0;
    }
    return pm_det(n, A);
}

static double permutation_det(const int *to, int n)
{
    int inversions = 0;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            inversions += to[i] > to[j];
    return inversions % 2 ? -1 : 1;
}

int pm_load_symmetry(const struct pm_case *c, ptrdiff_t g)
{
    const double *Q = c->symmetry.Q[g], *t = c->symmetry.t[g];
    const int base_kept = fabs(Q[8] - 1) < 1e-9 && fabs(t[2]) < 1e-9;
    const double perm = permutation_det(c->symmetry.chamber[g], (int)c->nchambers);
    const double space = is_pointing(c) ? pm_det(3, Q) : selected_det(Q, c->dofs, c->ndofs);
    const int even = strcmp(c->measure, "manifold") == 0 ? fabs(space) > 0.5 : space * perm > 0.5;
    return base_kept && even && pm_weight_keeps(&c->weight, Q);
}

/* The full set, one point after the other. */
static struct point full_point(const struct pm_case *c, enum pm_form form, ptrdiff_t index)
{
    const int n = (int)c->nchambers, m = (int)c->points;
    struct point q = {.face = -1, .sign = 1};

    if (is_pointing(c)) {
        const ptrdiff_t edge = index / m;
        q.face = PATH[edge].varying;
        q.sign = PATH[edge].sign;
        q.place[PATH[edge].high] = m + 1;
        q.place[q.face] = 1 + (int)(index % m);
        return q;
    }
    if (form == PM_FORM_BOUNDARY) {
        ptrdiff_t each = 1;
        for (int k = 1; k < n; k++)
            each *= m;
        q.face = (int)(index / each) / 2;
        q.sign = (index / each) % 2 ? 1 : -1;
        q.place[q.face] = q.sign > 0 ? m + 1 : 0;
    }
    for (int r = n - 1; r >= 0; r--)
        if (r != q.face) {
            q.place[r] = 1 + (int)(index % m);
            index /= m;
        }
    return q;
}

static ptrdiff_t full_size(const struct pm_case *c, enum pm_form form)
{
    const int axes = (int)c->nchambers - (form == PM_FORM_BOUNDARY ? 1 : 0);
    double size = form == PM_FORM_BOUNDARY ? 2 * (double)c->nchambers : 1;

    if (is_pointing(c))
        return 6 * c->points;
    for (int k = 0; k < axes; k++)
        size *= (double)c->points;
    return size <= MAX_POINTS ? (ptrdiff_t)size : -1;
}

/* Where point q of the full set stands in it: the inverse of full_point. */
static ptrdiff_t index_of(const struct pm_case *c, const struct point *q)
{
    const int n = (int)c->nchambers, m = (int)c->points;
    ptrdiff_t index = 0;

    if (is_pointing(c)) {
        for (int e = 0; e < 6; e++)
            if (PATH[e].varying == q->face && q->place[PATH[e].high] == m + 1)
                return e * m + q->place[q->face] - 1;
        return -1;
    }
    if (q->face >= 0)
        index = 2 * q->face + (q->place[q->face] > 0);
    for (int r = 0; r < n; r++)
        if (r != q->face)
            index = index * m + q->place[r] - 1;
    return index;
}

/* Marks the orbit of the point `index` as seen and returns its size. */
static int take_orbit(const struct pm_case *c, enum pm_form form, ptrdiff_t index,
                      unsigned char *seen)
{
    const struct point q = full_point(c, form, index);
    int size = 1;

    seen[index] = 1;
    for (ptrdiff_t g = 1; g < c->symmetry.nops && !c->full_set; g++) {
        if (!pm_load_symmetry(c, g))
            continue;
        const int *to = c->symmetry.chamber[g];
        struct point image = q;
        image.face = q.face < 0 ? -1 : to[q.face];
        for (ptrdiff_t r = 0; r < c->nchambers; r++)
            image.place[to[r]] = q.place[r];
        const ptrdiff_t k = index_of(c, &image);
        if (k >= 0 && !seen[k]) {
            seen[k] = 1;
            size++;
        }
    }
    return size;
}

static struct pm_load make_load(const struct pm_case *c, const struct point *q, int multiplicity,
                                const gsl_integration_glfixed_table *rule)
{
    struct pm_load l = {.face = q->face,
                        .sign = q->sign,
                        .multiplicity = multiplicity,
                        .weight = (double)multiplicity};

    for (ptrdiff_t r = 0; r < c->nchambers; r++) {
        const int k = q->place[r];
        double weight = 1;
        if (k == 0 || k == c->points + 1)
            l.p[r] = k == 0 ? c->pmin : c->pmax;
        else
            gsl_integration_glfixed_point(c->pmin, c->pmax, (size_t)(k - 1), &l.p[r], &weight,
                                          rule);
        l.weight *= weight;
    }
    return l;
}

/* Marks the images of the corner with the chambers `on` (bits) at pmax as seen; returns how many.
 */
static int take_corners(const struct pm_case *c, unsigned on, unsigned char *seen)
{
    int size = 0;

    for (ptrdiff_t g = 0; g < c->symmetry.nops && (g == 0 || !c->full_set); g++) {
        unsigned image = 0;
        if (g > 0 && !pm_load_symmetry(c, g))
            continue;
        for (ptrdiff_t r = 0; r < c->nchambers; r++)
            image |= (on >> r & 1) << c->symmetry.chamber[g][r];
        size += !seen[image];
        seen[image] = 1;
    }
    return size;
}

/* The guards of the case, behind the points; returns their number. */
static ptrdiff_t add_guards(const struct pm_case *c, enum pm_form form, struct pm_load *set)
{
    const unsigned all = (1U << c->nchambers) - 1;
    unsigned char seen[1 << PM_MAX_CHAMBERS] = {0};
    ptrdiff_t n = 0;

    if (form != c->form || !(c->amplification_max > 0 || c->gap_min > 0))
        return 0;
    for (unsigned on = c->gap_min > 0 ? 1 : all; on <= all; on++) {
        const int alone = (on & (on - 1)) == 0;
        if (seen[on] || (c->nchambers >= MANY_CHAMBERS && !alone && on != all))
            continue;
        struct pm_load *l = set + n++;
        *l = (struct pm_load){.face = form == PM_FORM_BOUNDARY ? 0 : -1,
                              .sign = 1,
                              .multiplicity = take_corners(c, on, seen)};
        for (ptrdiff_t r = 0; r < c->nchambers; r++)
            l->p[r] = on >> r & 1 ? c->pmax : c->pmin;
    }
    return n;
}

enum pm_status pm_load_set(const struct pm_case *c, enum pm_form form, struct pm_load **loads,
                           ptrdiff_t *n, struct pm_err *err)
{
    enum pm_status status;
    gsl_integration_glfixed_table *rule = NULL;
    unsigned char *seen = NULL;
    struct pm_load *set = NULL;
    ptrdiff_t size, count = 0;

    PM_TRY(pm_measure_check(c, form, err));
    size = full_size(c, form);
    if (c->points < 1 || size < 0)
        PM_TRY(pm_fail(
            err, PM_INPUT,
            "cannot use %ld Gauss points per axis for %td chambers, expected 1 to %d points in all",
            c->points, c->nchambers, MAX_POINTS));
    rule = gsl_integration_glfixed_table_alloc((size_t)c->points);
    if (rule == NULL)
        PM_TRY(pm_fail(err, PM_SYSTEM, "out of memory"));
    PM_TRY(PM_NEW(seen, size, err));
    PM_TRY(PM_NEW(set, size + MAX_GUARDS, err));
    for (ptrdiff_t i = 0; i < size; i++) {
        if (seen[i])
            continue;
        const struct point q = full_point(c, form, i);
        set[count++] = make_load(c, &q, take_orbit(c, form, i, seen), rule);
    }
    count += add_guards(c, form, set + count);
    *loads = set;
    *n = count;
    set = NULL;
done:
    pm_free(set);
    pm_free(seen);
    if (rule != NULL)
        gsl_integration_glfixed_table_free(rule);
    return status;
}
