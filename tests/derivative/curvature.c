/* Curvature of an ellipsoid in closed form, poles included; variations of curvature and area
 * against differences [model 6.2]. */
#include "common/geometry/curvature.h"

#include "common/base/memory.h"
#include "common/geometry/samples.h"
#include "tests/robot.h"
#include "tests/tap.h"

/* r = diag(a) S: r_a = diag(a) t_a, r_ab = -delta_ab diag(a) S. */
static void ellipsoid(const double S[3])
{
    const double a[3] = {2, 3, 5};
    double t[6], r_a[6], r_ab[9] = {0}, w = 0, sum = 0, n[3], p[3];
    struct pm_curvature c;

    pm_map_tangents(PM_SURFACE_SPHERE, S, t);
    for (int i = 0; i < 3; i++) {
        r_a[i] = a[i] * t[i];
        r_a[3 + i] = a[i] * t[3 + i];
        r_ab[i] = r_ab[6 + i] = -a[i] * S[i];
        p[i] = a[i] * S[i];
        n[i] = S[i] / a[i];
        w += n[i] * n[i]; /* sum x_i^2 / a_i^4 */
        sum += p[i] * p[i];
    }
    pm_curvature_at(r_a, r_ab, &c);
    double K = 1 / (900 * w * w), H = -(38 - sum) / (2 * 900 * pow(w, 1.5));
    near_rel("ellipsoid: Gauss curvature", c.K, K, 1e-13);
    near_rel("ellipsoid: mean curvature", c.H, H, 1e-13);
    near_rel("ellipsoid: c1^2 + c2^2", c.Q, 4 * H * H - 2 * K, 1e-12);
    for (int i = 0; i < 3; i++)
        n[i] /= sqrt(w);
    near_array("ellipsoid: outward normal", c.n, n, 3, 1e-14);
}

/* A wavy chamber in a wavy tube, moved along a smooth field; central differences with step 1e-5 mm
 * leave about 1e-10 of truncation and 1e-10 of rounding. */
static void variations(void)
{
    struct pm_err err = {0};
    struct pm_surfaces s = {0};
    struct pm_samples m = {0};
    const struct robot_chamber ball = {{0, 0, 20}, {6, 5, 12}, 0.2};
    double *phi = NULL, *d = NULL, worst[3] = {0}, scale[3] = {0};
    const double h = 1e-5;

    if (robot_init(&s, 12, 40, 1, &ball, &err) != PM_OK ||
        pm_samples_new(&s, 4, 1, &m, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[s.ns], &err) != PM_OK ||
        PM_NEW(d, 3 * s.offset[s.ns], &err) != PM_OK) {
        ok(0, "%s", err.text);
        return;
    }
    pm_surfaces_gather(&s, phi);
    for (ptrdiff_t i = 0; i < 3 * s.offset[s.ns]; i++) {
        phi[i] += 0.3 * sin(0.9 * (double)i);
        d[i] = cos(1.3 * (double)i);
    }
    for (ptrdiff_t i = 0; i < m.n; i += 7) {
        double r_a[6], r_ab[9], d_a[6], d_ab[9], up_a[6], up_ab[9], Q_a[6], Q_ab[9], A_a[6], dQ = 0,
                                                                                             dA = 0;
        struct pm_curvature up, down, here;
        pm_samples_at(&m, i, phi, NULL, r_a, r_ab);
        pm_samples_at(&m, i, d, NULL, d_a, d_ab);
        pm_curvature_at(r_a, r_ab, &here);
        double Q = pm_curvature_gradient(r_a, r_ab, Q_a, Q_ab), A = pm_area_gradient(r_a, A_a);
        for (int k = 0; k < 6; k++) {
            dQ += Q_a[k] * d_a[k];
            dA += A_a[k] * d_a[k];
            up_a[k] = r_a[k] + h * d_a[k];
        }
        for (int k = 0; k < 9; k++) {
            dQ += Q_ab[k] * d_ab[k];
            up_ab[k] = r_ab[k] + h * d_ab[k];
        }
        pm_curvature_at(up_a, up_ab, &up);
        for (int k = 0; k < 9; k++) {
            up_ab[k] = r_ab[k] - h * d_ab[k];
            if (k < 6)
                up_a[k] = r_a[k] - h * d_a[k];
        }
        pm_curvature_at(up_a, up_ab, &down);
        worst[0] = fmax(worst[0], fabs(dQ - (up.Q - down.Q) / (2 * h)) / (1 + fabs(dQ)));
        worst[1] = fmax(worst[1], fabs(dA - (up.A - down.A) / (2 * h)) / (1 + fabs(dA)));
        worst[2] = fmax(worst[2], fabs(Q - here.Q) + fabs(A - here.A));
        scale[0] = fmax(scale[0], fabs(dQ));
        scale[1] = fmax(scale[1], fabs(dA));
    }
    ok(scale[0] > 0.01 && scale[1] > 1, "the field moves curvature and area");
    near_abs("dQ against differences", worst[0], 0, 1e-8);
    near_abs("dA against differences", worst[1], 0, 1e-8);
    near_abs("Q and A come with their gradients", worst[2], 0, 0);
    pm_samples_release(&m);
    pm_surfaces_release(&s);
    pm_free(phi);
    pm_free(d);
}

int main(void)
{
    ellipsoid((const double[3]){0.36, 0.48, 0.8});
    ellipsoid((const double[3]){0, 0, 1});
    ellipsoid((const double[3]){0, -1, 0});
    variations();
    return tap_done();
}
