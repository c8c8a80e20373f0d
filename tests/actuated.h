/* Cases of the five designs for tests of Gauss sets and measures, and a synthetic robot U(p) that
 * obeys the symmetry of its case. */
#ifndef ACTUATED_H
#define ACTUATED_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/measure.h"

/* chambers: sections of the case file; measure and points as there. */
static inline enum pm_status actuated_case(struct pm_case *c, const char *chambers,
                                           const char *group, const char *measure, int points,
                                           struct pm_err *err)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "[case]\nname = test\n[material]\nmu = 0.5\n[body]\nheight = 100\nwall = 3\n%s[symmetry]\n"
        "group = %s\n[actuation]\npmin = 0\npmax = 0.12\npoints = %d\n[workspace]\nmeasure = %s\n"
        "[constraints]\namplification_max = 0\n",
        chambers, group, points, measure);
    return pm_case_parse(text, "test", c, err);
}

#define ACTUATED_SPHERE(k, x, y, z)                                                                \
    "[chamber" #k "]\nshape = sphere\ncenter = " #x ", " #y ", " #z "\nradius = 8\n"

static const char actuated_two[] = ACTUATED_SPHERE(1, 15, 0, 50);
static const char actuated_three[] = ACTUATED_SPHERE(1, 15, 0, 50);
static const char actuated_stack[] = ACTUATED_SPHERE(1, -12, 0, 50) ACTUATED_SPHERE(2, 12, 0, 28);
/* The same three chambers without the images by symmetry. */
static const char actuated_listed[] =
    ACTUATED_SPHERE(1, 15, 0, 50) ACTUATED_SPHERE(2, -7.5, 12.99038105676658, 50)
        ACTUATED_SPHERE(3, -7.5, -12.99038105676658, 50);

/* A smooth map without symmetry: quadratic plus a sine, J with it. x = p/pmax. */
static inline void actuated_plain(const double *x, int n, double U[6], double *J)
{
    for (int i = 0; i < 6; i++) {
        const double scale = i < 3 ? 5 : 0.4;
        U[i] = 0;
        for (int r = 0; r < n; r++) {
            const double a = cos(1.3 * i + 2.1 * r + 0.3), b = 0.2 * sin(2.7 * i - r),
                         k = 0.5 + 0.1 * (i + r);
            U[i] += scale * (a * x[r] + b * x[r] * x[(r + 1) % n] + 0.1 * sin(k * x[r]));
            J[n * i + r] = scale * (a + b * x[(r + 1) % n] + 0.1 * k * cos(k * x[r]) +
                                    0.2 * sin(2.7 * i - (r + n - 1) % n) * x[(r + n - 1) % n]);
        }
    }
}

static inline double actuated_det(const double *Q)
{
    return Q[0] * (Q[4] * Q[8] - Q[5] * Q[7]) - Q[1] * (Q[3] * Q[8] - Q[5] * Q[6]) +
           Q[2] * (Q[3] * Q[7] - Q[4] * Q[6]);
}

/* U(p) = mean over the operations that keep the base of Qh^T plain(Pi p); J per unit of p/mu. */
static inline void actuated_robot(const struct pm_symmetry *y, int n, double pmax, const double *p,
                                  double U[6], double *J)
{
    memset(U, 0, 6 * sizeof *U);
    memset(J, 0, (size_t)(6 * n) * sizeof *J);
    for (ptrdiff_t g = 0; g < y->nops; g++) {
        const double *Q = y->Q[g], axial = actuated_det(Q);
        double x[PM_MAX_CHAMBERS], V[6], K[6 * PM_MAX_CHAMBERS];
        for (int r = 0; r < n; r++)
            x[y->chamber[g][r]] = p[r] / pmax;
        actuated_plain(x, n, V, K);
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 3; j++) {
                const double q = Q[3 * j + i % 3] * (i < 3 ? 1 : axial) / (double)y->nops;
                const int row = j + (i < 3 ? 0 : 3);
                U[i] += q * V[row];
                for (int r = 0; r < n; r++)
                    J[n * i + r] += q * K[n * row + y->chamber[g][r]] / pmax;
            }
    }
}

#endif
