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
#define PI    3.14159265358979323846

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

/* Of the direction from which the turn of a chamber at `center` counts. */
static double radial(const double center[3])
{
    return hypot(center[0], center[1]) > 1e-9 ? atan2(center[1], center[0]) : 0;
}

double pm_chamber_angle(const struct pm_chamber *c, double z)
{
    return radial(c->center) + c->turn + c->twist * z / c->length;
}

/* The chamber under operation g: a mirror and a flip of z each reverse what they must. */
static void chamber_image(const struct pm_symmetry *s, ptrdiff_t g, const struct pm_chamber *c,
                          struct pm_chamber *y)
{
    const double *Q = s->Q[g], a = pm_chamber_angle(c, 0);
    const double axis[2] = {Q[0] * cos(a) + Q[1] * sin(a), Q[3] * cos(a) + Q[4] * sin(a)};
    *y = *c;
    image(s, g, c->center, y->center);
    y->twist *= (Q[0] * Q[4] - Q[1] * Q[3]) * Q[8];
    y->turn = remainder(atan2(axis[1], axis[0]) - radial(y->center), PI);
    if (y->turn <= -PI / 2 + 1e-12)
        y->turn += PI;
}

static int same_shape(const struct pm_chamber *a, const struct pm_chamber *b)
{
    const int round = a->section[0] == a->section[1];
    return a->shape == b->shape && a->radius == b->radius && a->length == b->length &&
           a->amplitude == b->amplitude && a->pitch == b->pitch && a->spacing == b->spacing &&
           a->cells == b->cells && a->thickness == b->thickness && a->width == b->width &&
           a->depth == b->depth && a->channel == b->channel && a->section[0] == b->section[0] &&
           a->section[1] == b->section[1] &&
           (round ||
            (fabs(remainder(a->turn - b->turn, PI)) < 1e-9 && fabs(a->twist - b->twist) < 1e-9));
}

enum pm_status pm_case_images(struct pm_case *c, const char *name, struct pm_err *err)
{
    struct pm_symmetry *s = &c->symmetry;
    ptrdiff_t listed = c->nchambers;
    double x[3];
    for (ptrdiff_t r = 0; r < listed; r++) {
        for (ptrdiff_t g = 0; g < s->nops; g++) {
            struct pm_chamber y;
            chamber_image(s, g, &c->chamber[r], &y);
            int k = chamber_at(c, y.center);
            if (k >= 0 && !same_shape(&c->chamber[k], &y))
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': chamber %d is an image of chamber %td under "
                               "the symmetry, expected the same shape, turn and twist",
                               name, k + 1, r + 1);
            if (k >= 0)
                continue;
            if (c->nchambers == PM_MAX_CHAMBERS)
                return pm_fail(err, PM_INPUT,
                               "cannot use '%s': more than %d chambers with their images", name,
                               (int)PM_MAX_CHAMBERS);
            c->chamber[c->nchambers++] = y;
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
