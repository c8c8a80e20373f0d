/* The symmetry group of a case and the images of its chambers. */
#include <math.h>
#include <string.h>

#include "common/files/case_complete.h"
#include "common/files/schema.h"

struct generator {
    const char *word;
    double Q[9];
    int flips; /* z -> H - z */
};

#define SIN60 0.86602540378443864676

static const struct generator generators[] = {
    {"mirror-x", {-1, 0, 0, 0, 1, 0, 0, 0, 1}, 0},
    {"mirror-y", {1, 0, 0, 0, -1, 0, 0, 0, 1}, 0},
    {"c3", {-0.5, -SIN60, 0, SIN60, -0.5, 0, 0, 0, 1}, 0},
    {"c2-x", {1, 0, 0, 0, -1, 0, 0, 0, -1}, 1},
};

/* Products of the generators have entries 0, 1/2, sin 60, 1 up to sign: exact again after rounding.
 */
static double snap(double v)
{
    static const double exact[] = {0, 0.5, SIN60, 1};
    for (size_t i = 0; i < sizeof exact / sizeof exact[0]; i++)
        if (fabs(fabs(v) - exact[i]) < 1e-9)
            return exact[i] == 0 ? 0 : copysign(exact[i], v);
    return v;
}

static void multiply(const double A[9], const double B[9], double C[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            C[3 * i + j] =
                snap(A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j]);
}

/* Adds Q unless it is there; 0 where the group outgrows its table. */
static int add(struct pm_symmetry *s, const double Q[9], double H)
{
    for (ptrdiff_t g = 0; g < s->nops; g++)
        if (memcmp(s->Q[g], Q, sizeof s->Q[g]) == 0)
            return 1;
    if (s->nops == PM_MAX_OPS)
        return 0;
    memcpy(s->Q[s->nops], Q, sizeof s->Q[0]);
    s->t[s->nops][2] = Q[8] < 0 ? H : 0;
    s->nops++;
    return 1;
}

enum pm_status pm_case_group(const char *group, double H, struct pm_symmetry *s, const char *name,
                             struct pm_err *err)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const struct generator *used[PM_MAX_OPS];
    int n = 0;
    *s = (struct pm_symmetry){.nops = 0};
    add(s, identity, H);
    for (const char *p = group + strspn(group, " "); *p != '\0'; p += strspn(p, " ")) {
        size_t length = strcspn(p, " "), i = 0, count = sizeof generators / sizeof generators[0];
        while (i < count && (strlen(generators[i].word) != length ||
                             strncmp(generators[i].word, p, length) != 0))
            i++;
        if (i < count && n < PM_MAX_OPS)
            used[n++] = &generators[i];
        else if (length != 4 || strncmp(p, "none", 4) != 0)
            return pm_fail(err, PM_INPUT,
                           "cannot use '%s': key 'group' has '%.*s', expected words out of "
                           "none mirror-x mirror-y c3 c2-x",
                           name, (int)length, p);
        p += length;
    }
    for (ptrdiff_t g = 0; g < s->nops; g++) {
        for (int k = 0; k < n; k++) {
            double Q[9];
            multiply(used[k]->Q, s->Q[g], Q);
            if (!add(s, Q, H))
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': key 'group' = '%s' generates more than %d "
                               "operations",
                               name, group, (int)PM_MAX_OPS);
        }
    }
    return PM_OK;
}

static void image(const struct pm_symmetry *s, ptrdiff_t g, const double x[3], double y[3])
{
    const double *Q = s->Q[g];
    for (int i = 0; i < 3; i++)
        y[i] = Q[3 * i] * x[0] + Q[3 * i + 1] * x[1] + Q[3 * i + 2] * x[2] + s->t[g][i];
}

/* The chamber centred at x, -1 if there is none. */
static int chamber_at(const struct pm_case *c, const double x[3])
{
    for (int r = 0; r < c->nchambers; r++) {
        const double *y = c->chamber[r].center;
        if (fmax(fmax(fabs(x[0] - y[0]), fabs(x[1] - y[1])), fabs(x[2] - y[2])) < 1e-9 * c->height)
            return r;
    }
    return -1;
}

static int same_shape(const struct pm_chamber *a, const struct pm_chamber *b)
{
    return a->shape == b->shape && a->radius == b->radius && a->length == b->length &&
           a->amplitude == b->amplitude && a->pitch == b->pitch && a->spacing == b->spacing;
}

enum pm_status pm_case_images(struct pm_case *c, const char *name, struct pm_err *err)
{
    struct pm_symmetry *s = &c->symmetry;
    ptrdiff_t listed = c->nchambers;
    double x[3];
    for (ptrdiff_t r = 0; r < listed; r++) {
        for (ptrdiff_t g = 0; g < s->nops; g++) {
            image(s, g, c->chamber[r].center, x);
            int k = chamber_at(c, x);
            if (k >= 0 && !same_shape(&c->chamber[k], &c->chamber[r]))
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': chamber %d is an image of chamber %td under "
                               "the symmetry, expected the same shape",
                               name, k + 1, r + 1);
            if (k >= 0)
                continue;
            if (c->nchambers == PM_MAX_CHAMBERS)
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': more than %d chambers with their images", name,
                               (int)PM_MAX_CHAMBERS);
            c->chamber[c->nchambers] = c->chamber[r];
            memcpy(c->chamber[c->nchambers++].center, x, sizeof x);
        }
    }
    for (ptrdiff_t g = 0; g < s->nops; g++) {
        for (ptrdiff_t r = 0; r < c->nchambers; r++) {
            image(s, g, c->chamber[r].center, x);
            s->chamber[g][r] = chamber_at(c, x);
        }
    }
    return PM_OK;
}
