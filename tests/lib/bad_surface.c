/* bad_surface WHAT IN.h5 OUT.h5: surfaces of two chambers spoilt for tests of tetmesh. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/files/surfaces.h"

static void shift(struct pm_surface *s, double dx)
{
    for (ptrdiff_t i = 0; i < s->n; i++)
        s->phi[3 * i] += dx;
}

/* b becomes a at half its size. */
static void nest(const struct pm_surface *a, struct pm_surface *b)
{
    double mean[3] = {0};
    for (ptrdiff_t i = 0; i < 3 * a->n; i++)
        mean[i % 3] += a->phi[i] / (double)a->n;
    for (ptrdiff_t i = 0; i < 3 * a->n; i++)
        b->phi[i] = mean[i % 3] + 0.5 * (a->phi[i] - mean[i % 3]);
    memcpy(b->Phi, a->Phi, (size_t)(3 * a->n) * sizeof *b->Phi);
    memcpy(b->d0, a->d0, (size_t)a->n * sizeof *b->d0);
    memcpy(b->tri, a->tri, (size_t)(3 * a->nt) * sizeof *b->tri);
}

/* The wall at the largest x is pushed in and out again through the one opposite to it. */
static void pinch(struct pm_surface *s)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (ptrdiff_t a = 0; a < s->n; a++) {
        low = fmin(low, s->phi[3 * a]);
        high = fmax(high, s->phi[3 * a]);
    }
    for (ptrdiff_t a = 0; a < s->n; a++) {
        const double part = (s->phi[3 * a] - low) / (high - low);
        s->phi[3 * a] -= 1.5 * (high - low) * pow(part, 6);
    }
}

static void turn(struct pm_surface *s)
{
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        const int32_t a = s->tri[3 * t];
        s->tri[3 * t] = s->tri[3 * t + 1];
        s->tri[3 * t + 1] = a;
    }
}

/* The first chamber along x [mm]: -4.37 bring it to the second one. */
static const struct {
    const char *name;
    double dx;
} shifts[] = {{"outside", 100}, {"pierce", 6},   {"overlap", -8},
              {"graze", -4.4},  {"near", -4.36}, {"thin", -4.3}};

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces s = {.ns = 0};
    struct pm_h5 *f = NULL;
    const struct pm_common common = {.tool = "bad_surface", .command = "bad_surface"};
    enum pm_status status = PM_OK;
    if (argc != 4)
        return PM_USAGE;
    PM_TRY(pm_surfaces_load(argv[2], &s, &err));
    for (size_t k = 0; k < sizeof shifts / sizeof shifts[0]; k++)
        if (strcmp(argv[1], shifts[k].name) == 0)
            shift(&s.s[1], shifts[k].dx);
    if (strcmp(argv[1], "both") == 0) {
        shift(&s.s[1], -8);
        shift(&s.s[2], 8);
    } else if (strcmp(argv[1], "nested") == 0)
        nest(&s.s[1], &s.s[2]);
    else if (strcmp(argv[1], "turned") == 0)
        turn(&s.s[1]);
    else if (strcmp(argv[1], "pinched") == 0)
        pinch(&s.s[1]);
    PM_TRY(pm_h5_create(argv[3], "surface", &common, NULL, &f, &err));
    PM_TRY(pm_surfaces_write(f, &s, &err));
    status = pm_h5_commit(f, &err);
    f = NULL;
done:
    if (status != PM_OK)
        fprintf(stderr, "bad_surface: %s\n", err.text);
    pm_h5_close(f);
    pm_surfaces_release(&s);
    return (int)status;
}
