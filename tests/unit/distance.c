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

static double across(const double *normal, const double *a, const double *b)
{
    return normal[0] * (b[0] - a[0]) + normal[1] * (b[1] - a[1]) + normal[2] * (b[2] - a[2]);
}

static double length(const double *a, const double *b)
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* The nearest sample on a surface, or on its own within 60 degrees of both normals. */
static struct pm_near brute(const struct pm_samples *m, const double *x, const double *normal,
                            ptrdiff_t i, int32_t other, double cutoff)
{
    struct pm_near best = {.i = (int32_t)i, .j = -1, .other = other, .distance = cutoff};
    const int32_t k = other < 0 ? m->surface[i] : other;
    const double side = other == PM_NEAR_INSIDE ? -1 : 1;

    for (ptrdiff_t j = m->first[k]; j < m->first[k + 1]; j++) {
        const double *a = &x[3 * i], *b = &x[3 * j], d = length(a, b);
        if (d < best.distance && (other >= 0 || (side * across(&normal[3 * i], a, b) > d / 2 &&
                                                 side * across(&normal[3 * j], b, a) > d / 2))) {
            best.j = (int32_t)j;
            best.distance = d;
        }
    }
    return best;
}

static void compare_near(const struct pm_samples *m, const double *phi, const double cutoff[2])
{
    struct pm_near *near = NULL;
    struct pm_err err = {0};
    double *x = NULL, *normal = NULL;
    unsigned char *from = NULL;
    ptrdiff_t n = 0, found = 0, same = 0, own = 0, order = 0;

    if (PM_NEW(x, 3 * m->n, &err) != PM_OK || PM_NEW(normal, 3 * m->n, &err) != PM_OK ||
        PM_NEW(from, m->n, &err) != PM_OK)
        return;
    for (ptrdiff_t i = 0; i < m->n; i++)
        from[i] = i % 3 > 0;
    pm_samples_all(m, phi, x, normal);
    ok(pm_samples_near(m, 3, x, normal, from, cutoff, 0, &near, &n, &err) == PM_OK, "near samples");
    for (ptrdiff_t i = 0; i < m->n; i++)
        for (int32_t other = PM_NEAR_INSIDE; from[i] && other < 3; other++) {
            const int hollow = other == (m->surface[i] > 0 ? PM_NEAR_INSIDE : PM_NEAR_OUTSIDE);
            if (other == m->surface[i])
                continue;
            const struct pm_near b = brute(m, x, normal, i, other, cutoff[hollow]);
            if (b.j < 0)
                continue;
            /* which of two that are equal but for rounding is free */
            same +=
                found < n && near[found].i == b.i && near[found].other == b.other &&
                fabs(near[found].distance - b.distance) < 1e-14 * b.distance &&
                fabs(length(&x[3 * i], &x[3 * near[found].j]) - b.distance) < 1e-14 * b.distance;
            own += other < 0;
            found++;
        }
    for (ptrdiff_t k = 1; k < n; k++)
        order += near[k - 1].i < near[k].i ||
                 (near[k - 1].i == near[k].i && near[k - 1].other < near[k].other);
    ok(own > 100 && found == n && same == n, "trees find the %td of brute force (%td, %td same)",
       found, n, same);
    ok(order == n - 1, "sorted by sample, then by what it faces");
    pm_free(near);
    pm_free(x);
    pm_free(normal);
    pm_free(from);
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
    compare_near(&m, phi, (const double[]){4.5, 7});
    /* the tube and the sphere of revolution: 14 - (6 + 4) at z = 20; between the chambers brute
     * force says */
    ok(pm_distance_nearest(&s, &m, 6, near, &err) == PM_OK, "nearest distances");
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
