/* random_shape SEED NOISE IN.h5 OUT.h5: the surfaces with a smooth random displacement of NOISE mm
 * root mean square, another one for each; none at the planes of base and tip. Symmetric as the case
 * is. Prints what pm_surfaces_measure sees: closest walls [mm] (inf beyond its range), largest
 * curvature [1/mm], the fault. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/geometry/check.h"
#include "common/geometry/symmetry.h"

enum { WAVES = 8 };
static const double TWO_PI = 6.283185307179586476925;
static const double SHORTEST = 15, LONGEST = 40; /* wave lengths [mm] */

/* Uniform in [0, 1): splitmix64. */
static double uniform(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

struct wave {
    double k[3], phase, amplitude[3];
};

static void random_waves(uint64_t *state, double noise, struct wave w[WAVES])
{
    for (int n = 0; n < WAVES; n++) {
        const double z = 2 * uniform(state) - 1, t = TWO_PI * uniform(state);
        const double length = SHORTEST + (LONGEST - SHORTEST) * uniform(state);
        const double k[3] = {sqrt(1 - z * z) * cos(t), sqrt(1 - z * z) * sin(t), z};
        w[n].phase = TWO_PI * uniform(state);
        for (int i = 0; i < 3; i++) {
            w[n].k[i] = k[i] * TWO_PI / length;
            /* uniform in +-a has variance a^2/3, the cosine 1/2, and there are three axes */
            w[n].amplitude[i] = noise * sqrt(2.0 / WAVES) * (2 * uniform(state) - 1);
        }
    }
}

static void displace(const struct wave w[WAVES], double height, double x[3])
{
    double d[3] = {0};
    const double t = fmin(x[2], height - x[2]) / (0.15 * height);
    const double window = t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
    for (int n = 0; n < WAVES; n++) {
        const double *k = w[n].k;
        const double c = cos(k[0] * x[0] + k[1] * x[1] + k[2] * x[2] + w[n].phase);
        for (int i = 0; i < 3; i++)
            d[i] += w[n].amplitude[i] * c;
    }
    for (int i = 0; i < 3; i++)
        x[i] += window * d[i];
}

static enum pm_status disturb(struct pm_surfaces *s, uint64_t seed, double noise,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *phi = NULL;
    struct wave w[WAVES];
    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        random_waves(&seed, noise, w);
        for (ptrdiff_t i = 0; i < s->s[k].n; i++)
            displace(w, s->pcase.height, s->s[k].phi + 3 * i);
    }
    pm_surfaces_gather(s, phi);
    pm_symmetrise_points(s, phi);
    pm_surfaces_scatter(s, phi);
done:
    pm_free(phi);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces s = {.ns = 0};
    struct pm_check check;
    struct pm_h5 *f = NULL;
    const struct pm_common common = {.tool = "random_shape", .command = "random_shape"};
    enum pm_status status = PM_OK;
    if (argc != 5)
        return PM_USAGE;
    PM_TRY(pm_surfaces_load(argv[3], &s, &err));
    PM_TRY(disturb(&s, strtoull(argv[1], NULL, 10), strtod(argv[2], NULL), &err));
    PM_TRY(pm_h5_create(argv[4], "surface", &common, NULL, &f, &err));
    PM_TRY(pm_surfaces_write(f, &s, &err));
    status = pm_h5_commit(f, &err);
    f = NULL;
    PM_TRY(status);
    s.pcase.wall_min = 1.5; /* samples half as far apart, finer ones take long */
    PM_TRY(pm_surfaces_measure(&s, &check, &err));
    printf("%.3f\t%.3f\t%s\n", check.wall.distance, check.curvature,
           check.fault[0] != '\0' ? check.fault : "-");
done:
    if (status != PM_OK)
        fprintf(stderr, "random_shape: %s\n", err.text);
    pm_h5_close(f);
    pm_surfaces_release(&s);
    return (int)status;
}
