/* Samples, close pairs, distances, volumes, fit: against closed forms and brute force. */
#include "common/geometry/distance.h"

#include "common/base/memory.h"
#include "common/geometry/fit.h"
#include "tests/robot.h"
#include "tests/tap.h"

static const double PI = 3.14159265358979323846;

/* Fits chamber k to the ellipsoid centre + diag(axes) S, at four samples a triangle. */
static enum pm_status fit_ellipsoid(struct pm_surfaces *s, ptrdiff_t k,
                                    const struct robot_chamber *c, int iterations, double error[2],
                                    struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_samples m = {0};
    struct pm_map *map = NULL;
    double *x = NULL;

    PM_TRY(pm_samples_new(s, HUGE_VAL, 2, &m, err));
    PM_TRY(PM_NEW(x, 3 * m.n, err));
    for (ptrdiff_t q = 0; q < 3 * m.n; q++)
        x[q] = c->center[q % 3] + c->axes[q % 3] * m.S[q];
    PM_TRY(pm_map_new(&s->s[k], &map, err));
    const struct pm_fit fit = {.nq = m.first[k + 1] - m.first[k],
                               .S = &m.S[3 * m.first[k]],
                               .weight = &m.area[m.first[k]],
                               .target = &x[3 * m.first[k]],
                               .alpha = 0.1,
                               .iterations = iterations};
    PM_TRY(pm_fit_points(map, s->s[k].n, &fit, s->s[k].phi, error, err));
done:
    pm_samples_release(&m);
    pm_map_free(map);
    pm_free(x);
    return status;
}

static void compare_pairs(const struct pm_samples *m, const double *x, double cutoff)
{
    struct pm_pair *pair = NULL;
    struct pm_err err = {0};
    ptrdiff_t n = 0, brute = 0, same = 0;

    ok(pm_samples_pairs(m, x, cutoff, HUGE_VAL, &pair, &n, &err) == PM_OK,
       "pairs on distinct surfaces");
    for (ptrdiff_t i = 0; i < m->n; i++)
        for (ptrdiff_t j = i + 1; j < m->n; j++) {
            double d[3] = {x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1],
                           x[3 * i + 2] - x[3 * j + 2]};
            if (m->surface[i] == m->surface[j] ||
                !(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < cutoff * cutoff))
                continue;
            if (brute < n && pair[brute].i == i && pair[brute].j == j)
                same++;
            brute++;
        }
    ok(n > 100 && n == brute && same == n, "cell grid finds the %td pairs of brute force (%td)",
       brute, n);
    pm_free(pair);
    /* opposite sides of the flattest chamber are 6 mm apart: one surface with itself */
    ok(pm_samples_pairs(m, x, 7, 8, &pair, &n, &err) == PM_OK, "pairs on one surface");
    same = 0;
    for (ptrdiff_t k = 0; k < n; k++)
        same += m->surface[pair[k].i] == m->surface[pair[k].j];
    ok(same > 0, "a flat chamber is close to itself");
    pm_free(pair);
}

int main(void)
{
    struct pm_err err = {0};
    struct pm_surfaces s = {0};
    struct pm_samples m = {0};
    struct pm_approach near[9];
    struct robot_chamber c[2] = {{{-6, 0, 20}, {4, 4, 12}, 0}, {{6, 1, 20}, {3, 6, 11}, 0}};
    double once[2], error[2], *phi = NULL, *x = NULL, wall;

    if (robot_init(&s, 14, 40, 2, c, &err) != PM_OK ||
        fit_ellipsoid(&s, 1, &c[0], 1, once, &err) != PM_OK ||
        fit_ellipsoid(&s, 1, &c[0], 20, error, &err) != PM_OK)
        return tap_bail("%s", err.text);
    ok(error[0] < 0.5 * once[0], "iterating halves the error of the fit (rms %.4f, once %.4f mm)",
       error[0], once[0]);
    if (fit_ellipsoid(&s, 2, &c[1], 20, error, &err) != PM_OK ||
        pm_samples_new(&s, 1.0, 1, &m, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[3], &err) != PM_OK || PM_NEW(x, 3 * m.n, &err) != PM_OK)
        return tap_bail("%s", err.text);
    ok(error[1] < 0.15, "fit of an ellipsoid, largest error %.4f mm", error[1]);
    pm_surfaces_gather(&s, phi);
    pm_samples_all(&m, phi, x, NULL);
    /* map error of 642 points: about 1e-2 mm */
    near_rel("volume of a fitted ellipsoid", pm_samples_volume(&m, phi, 1), 4 * PI / 3 * 4 * 4 * 12,
             3e-3);
    near_rel("volume of the tube", pm_samples_volume(&m, phi, 0), PI * 14 * 14 * 40, 2e-3);
    near_rel("area of the tube", pm_samples_area(&m, phi, 0), 2 * PI * 14 * 40, 1e-3);
    compare_pairs(&m, x, 4.5);
    /* the tube and the sphere of revolution: 14 - (6 + 4) at z = 20; between the chambers brute
     * force says */
    ok(pm_distance_nearest(&s, &m, 6, HUGE_VAL, near, &err) == PM_OK, "nearest distances");
    near_abs("wall between chamber and tube", near[1].distance, 4, 0.05);
    wall = HUGE_VAL;
    for (ptrdiff_t i = m.first[1]; i < m.first[2]; i++)
        for (ptrdiff_t j = m.first[2]; j < m.first[3]; j++)
            wall = fmin(wall, hypot(hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1]),
                                    x[3 * i + 2] - x[3 * j + 2]));
    /* samples overestimate by up to spacing^2 / 4 d each side */
    ok(near[5].distance <= wall && near[5].distance > wall - 0.1,
       "wall between chambers %.4f, samples %.4f mm", near[5].distance, wall);
    pm_samples_release(&m);
    pm_surfaces_release(&s);
    pm_free(phi);
    pm_free(x);
    return tap_done();
}
