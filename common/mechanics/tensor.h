/* 3x3 tensors, row major: A[3*i + J]; of numbers (pm_dot9) and of lanes (pm_lanes_dot9). */
#ifndef PM_TENSOR_H
#define PM_TENSOR_H

#include <string.h>

#include "common/mechanics/lanes.h"

#define REAL     double
#define OF(name) pm_##name
#include "common/mechanics/tensor_of.h"
#undef REAL
#undef OF

#define REAL     pm_lanes
#define OF(name) pm_lanes_##name
#include "common/mechanics/tensor_of.h"
#undef REAL
#undef OF

static inline void pm_vcross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* y = M v, y = M^T v */
static inline void pm_mul3(const double M[9], const double v[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = M[3 * i] * v[0] + M[3 * i + 1] * v[1] + M[3 * i + 2] * v[2];
}

static inline void pm_tmul3(const double M[9], const double v[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = M[i] * v[0] + M[3 + i] * v[1] + M[6 + i] * v[2];
}

/* a . b of n numbers */
static inline double pm_dot(ptrdiff_t n, const double *a, const double *b)
{
    double s = 0.0;
    for (ptrdiff_t i = 0; i < n; i++)
        s += a[i] * b[i];
    return s;
}

static inline double pm_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#endif
