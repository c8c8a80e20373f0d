/* Shape derivatives of the inflated thick sphere, 1 <= r <= 2: of the radial displacement ub of the
 * outer surface and of dub/dp, by the two radii.
 *   sphere_shape exact KAPPA P          the radial equation: ub, dub/dp, then dub/dA dub/dB
 *                                       d2ub/dpdA d2ub/dpdB; mu = 1
 *   sphere_shape read STATE.h5 SENS.h5  the same four of an octant whose outer side is chamber 2,
 * by the nodal derivatives of its volume and compliance
 */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/state.h"

/* Radial and hoop stress of first Piola-Kirchhoff, mu = 1: W = (I1 J^-2/3 - 3)/2 + kappa/2 (J -
 * 1)^2. */
static void stresses(double kappa, double lr, double lt, double P[2])
{
    double J = lr * lt * lt, I1 = lr * lr + 2 * lt * lt, s = pow(J, -2.0 / 3);
    P[0] = s * (lr - I1 / (3 * lr)) + kappa * (J - 1) * lt * lt;
    P[1] = s * (lt - I1 / (3 * lt)) + kappa * (J - 1) * lr * lt;
}

/* Radial stretch where the radial stress is P: Newton from 1/lt^2. */
static double radial_stretch(double kappa, double P, double lt)
{
    double lr = 1 / (lt * lt);
    for (int k = 0; k < 50; k++) {
        double a[2], b[2], h = 1e-6;
        stresses(kappa, lr + h, lt, a);
        stresses(kappa, lr - h, lt, b);
        double slope = (a[0] - b[0]) / (2 * h);
        stresses(kappa, lr, lt, a);
        lr -= (a[0] - P) / slope;
        if (fabs(a[0] - P) < 1e-14)
            break;
    }
    return lr;
}

/* y = (r, P_r) by R: r' = lr, P_r' = -2 (P_r - P_t)/R. */
static int slope(double R, const double y[], double dy[], void *data)
{
    const double kappa = *(const double *)data, lt = y[0] / R;
    double lr = radial_stretch(kappa, y[1], lt), P[2];
    stresses(kappa, lr, lt, P);
    dy[0] = lr;
    dy[1] = -2 * (y[1] - P[1]) / R;
    return GSL_SUCCESS;
}

struct shot {
    double A, B, kappa, p, b; /* b: deformed outer radius */
};

/* Radial stress at B from the deformed inner radius a; at A it is -p (a/A)^2. */
static double shoot(double a, void *data)
{
    struct shot *s = data;
    gsl_odeiv2_system system = {slope, NULL, 2, &s->kappa};
    gsl_odeiv2_driver *d =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3, 1e-13, 1e-13);
    double R = s->A, y[2] = {a, -s->p * a * a / (s->A * s->A)};
    gsl_odeiv2_driver_apply(d, &R, s->B, y);
    gsl_odeiv2_driver_free(d);
    s->b = y[0];
    return y[1];
}

static double outer_displacement(double A, double B, double kappa, double p)
{
    struct shot s = {A, B, kappa, p, 0};
    double low = A, high = 1.2 * A;
    gsl_function f = {shoot, &s};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (gsl_root_fsolver_set(solver, &f, low, high) == GSL_SUCCESS)
        for (int k = 0; k < 100 && high - low > 4e-15; k++) {
            gsl_root_fsolver_iterate(solver);
            low = gsl_root_fsolver_x_lower(solver);
            high = gsl_root_fsolver_x_upper(solver);
        }
    shoot(gsl_root_fsolver_root(solver), &s);
    gsl_root_fsolver_free(solver);
    return s.b - B;
}

/* Central differences of fourth order. */
static double slope_p(double A, double B, double kappa, double p)
{
    const double h = 2e-3;
    return (8 * (outer_displacement(A, B, kappa, p + h) - outer_displacement(A, B, kappa, p - h)) -
            (outer_displacement(A, B, kappa, p + 2 * h) -
             outer_displacement(A, B, kappa, p - 2 * h))) /
           (12 * h);
}

typedef double function(double A, double B, double kappa, double p);

static double by_radius(function *f, int outer, double kappa, double p)
{
    const double h = 2e-3;
    double v[4];
    for (int k = 0; k < 4; k++) {
        const double d = h * (k < 2 ? k - 2 : k - 1);
        v[k] = f(outer ? 1 : 1 + d, outer ? 2 + d : 2, kappa, p);
    }
    return (8 * (v[2] - v[1]) - (v[3] - v[0])) / (12 * h);
}

static void print_exact(double kappa, double p)
{
    printf("%.8f %.7f %.7f %.7f %.6f %.6f\n", outer_displacement(1, 2, kappa, p),
           slope_p(1, 2, kappa, p), by_radius(outer_displacement, 0, kappa, p),
           by_radius(outer_displacement, 1, kappa, p), by_radius(slope_p, 0, kappa, p),
           by_radius(slope_p, 1, kappa, p));
}

/* D . dX for both radii: the radial field linear in r, 1 on one surface and 0 on the other. */
static void along_radii(const struct pm_mesh *m, const double *D, double out[2])
{
    out[0] = out[1] = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const double *x = m->x + 3 * a, r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        const double d = (D[3 * a] * x[0] + D[3 * a + 1] * x[1] + D[3 * a + 2] * x[2]) / r;
        out[0] += d * (2 - r);
        out[1] += d * (r - 1);
    }
}

/* The octant's V_2 = -pi b^3/6, times what the faces of the mesh miss of the sphere. */
static enum pm_status print_read(const char *state, const char *sens, struct pm_err *err)
{
    enum pm_status status;
    struct pm_state s = {.load = 0};
    struct pm_h5 *f = NULL;
    double *dV = NULL, *dC = NULL, C[4], V[2], Vp[2];
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_state_load(state, 0, &s, err));
    PM_TRY(pm_h5_open(sens, "sens", &f, err));
    PM_TRY(pm_h5_get_into(f, "/chamber/compliance", 4, C, err));
    PM_TRY(pm_h5_get(f, "/nodal/dV", d, &dV, err));
    PM_TRY(pm_h5_get(f, "/nodal/dC", d, &dC, err));
    along_radii(&s.mesh, dV + 3 * s.mesh.nn, V);
    along_radii(&s.mesh, dC + 6 * s.mesh.nn, Vp); /* C_21 */
    const double b = 2 * cbrt(s.volume[1] / s.volume0[1]);
    const double area = 3 * s.volume[1] / b, bp = C[2] / area; /* dV_2/db */
    printf("%.8f %.7f", b - 2, bp);
    for (int k = 0; k < 2; k++)
        printf(" %.7f", V[k] / area - k);
    for (int k = 0; k < 2; k++)
        printf(" %.6f", (Vp[k] - 2 / b * V[k] * bp) / area);
    printf("\n");
done:
    pm_h5_close(f);
    pm_free(dV);
    pm_free(dC);
    pm_state_release(&s);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    if (argc == 4 && strcmp(argv[1], "exact") == 0) {
        print_exact(strtod(argv[2], NULL), strtod(argv[3], NULL));
        return 0;
    }
    if (argc == 4 && strcmp(argv[1], "read") == 0) {
        if (print_read(argv[2], argv[3], &err) == PM_OK)
            return 0;
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    fprintf(stderr, "usage: sphere_shape exact KAPPA P | read STATE SENS\n");
    return 2;
}
