#include "common/actuation/weight.h"

#include <math.h>
#include <string.h>

#include "common/mechanics/rotation.h"

/* s(d) and ds/dd. */
static double step(double d, double width, double *slope)
{
    const double t = tanh(d / width);
    *slope = (1 - t * t) / (2 * width);
    return (1 + t) / 2;
}

static double box(const struct pm_weight *k, const double *y, double *dy)
{
    double f[3], df[3];
    for (int i = 0; i < 3; i++) {
        double low, high, dlow, dhigh;
        low = step(y[i] - k->center[i] + k->size[i], k->width, &dlow);
        high = step(k->center[i] + k->size[i] - y[i], k->width, &dhigh);
        f[i] = low * high;
        df[i] = dlow * high - low * dhigh;
    }
    for (int i = 0; i < 3; i++)
        dy[i] = df[i] * f[(i + 1) % 3] * f[(i + 2) % 3];
    return f[0] * f[1] * f[2];
}

static double gaussian(const struct pm_weight *k, const double *y, double *dy)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double z = (y[i] - k->center[i]) / k->size[i];
        sum += z * z / 2;
        dy[i] = -z / k->size[i];
    }
    const double rho = exp(-sum);
    for (int i = 0; i < 3; i++)
        dy[i] *= rho;
    return rho;
}

static double half_space(const struct pm_weight *k, const double *y, double *dy)
{
    double d = 0, slope;
    for (int i = 0; i < 3; i++)
        d += (y[i] - k->center[i]) * k->normal[i];
    const double rho = step(d, k->width, &slope);
    for (int i = 0; i < 3; i++)
        dy[i] = slope * k->normal[i];
    return rho;
}

double pm_weight_at(const struct pm_weight *k, const double U[6], double grad[6])
{
    struct pm_rotation rot;
    double y[3], dy[3];

    memset(grad, 0, 6 * sizeof *grad);
    if (k->kind == PM_WEIGHT_NONE)
        return 1;
    if (k->direction)
        pm_rotation_at(U + 3, 0, &rot);
    for (int i = 0; i < 3; i++)
        y[i] = k->direction ? rot.R[3 * i + 2] : U[i];
    const double rho = k->kind == PM_WEIGHT_BOX        ? box(k, y, dy)
                       : k->kind == PM_WEIGHT_GAUSSIAN ? gaussian(k, y, dy)
                                                       : half_space(k, y, dy);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (k->direction)
                grad[3 + i] += dy[j] * rot.Ri[i][3 * j + 2];
            else
                grad[i] += (i == j) * dy[j];
    return rho;
}

int pm_weight_keeps(const struct pm_weight *k, const double *Q)
{
    double largest = 0; /* deviation of what Q moves, relative to its size */
    double center = 0, moved_normal = 0;

    if (k->kind == PM_WEIGHT_NONE)
        return 1;
    for (int i = 0; i < 3; i++) {
        const double *q = Q + 3 * i;
        const double c =
            q[0] * k->center[0] + q[1] * k->center[1] + q[2] * k->center[2] - k->center[i];
        const double n =
            q[0] * k->normal[0] + q[1] * k->normal[1] + q[2] * k->normal[2] - k->normal[i];
        center = fmax(center, fabs(c));
        moved_normal = fmax(moved_normal, fabs(n));
        for (int j = 0; j < 3 && k->kind != PM_WEIGHT_HALF_SPACE; j++) {
            double S = 0; /* Q diag(a^2) Q^T */
            for (int l = 0; l < 3; l++)
                S += q[l] * k->size[l] * k->size[l] * Q[3 * j + l];
            const double a2 = k->size[i] * k->size[i];
            largest = fmax(largest, fabs(S - (i == j) * a2) / a2);
            if (k->kind == PM_WEIGHT_BOX && fabs(q[j]) > 1e-9 && fabs(fabs(q[j]) - 1) > 1e-9)
                return 0; /* faces of a box go to faces under signed permutations alone */
        }
    }
    /* a plane that Q maps onto itself: n stays, and c moves within the plane since Q^T n = n */
    return k->kind == PM_WEIGHT_HALF_SPACE ? moved_normal < 1e-9 : largest < 1e-9 && center < 1e-9;
}
