/* Triangle meshes of bent, folded and flat tubes for tests: rings of points about a curved axis. */
#ifndef PM_TEST_TUBE_MESH_H
#define PM_TEST_TUBE_MESH_H

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/trimesh.h"

struct tube_shape {
    double radius, length; /* of the axis [mm] */
    double amplitude;      /* folds: radius + amplitude cos */
    int folds;
    double flat;     /* ratio of the half-axes x / y */
    double bend;     /* the axis is an arc of this angle in the plane y = 0 [rad] */
    double overhang; /* folds lean: points move along the axis by overhang * sin [mm] */
    int caps;        /* 1: closed by half ellipsoids; 0: open at both ends */
};

/* Place at the fraction t of the way from end to end and the angle a. */
static inline void tube_point(const struct tube_shape *s, double t, double a, double x[3])
{
    const double PI = acos(-1.0);
    double cap = s->caps ? s->radius : 0, z = s->length * (t - 0.5), r = 1,
           wave = 2 * PI * s->folds;
    double straight = s->length / 2 - cap;
    if (s->caps) { /* t is the angle in the caps */
        double arc = PI / 2 * s->radius, total = 2 * (straight + arc), along = t * total;
        double from = fmin(along, total - along), sign = along > total / 2 ? 1 : -1;
        if (from < arc) {
            r = sin(from / s->radius);
            z = sign * (straight + s->radius * cos(from / s->radius));
        } else
            z = sign * (straight - (from - arc));
    }
    double u = fmin(fmax((z + straight) / (2 * straight), 0), 1);
    double fade = s->caps ? sin(PI * u) * sin(PI * u) : 1;
    double rho = s->radius * r + s->amplitude * fade * (cos(wave * u) - (s->caps ? 0 : 1));
    z += s->overhang * fade * sin(wave * u) * (rho - s->radius) / fmax(s->amplitude, 1e-9);
    x[0] = s->flat * rho * cos(a);
    x[1] = rho * sin(a);
    x[2] = z;
    if (s->bend > 0) {
        double R = s->length / s->bend, angle = z / R, d = R + x[0];
        x[0] = d * cos(angle) - R;
        x[2] = d * sin(angle);
    }
}

/* around points a ring, `rings` rings, alternately half a step turned where the mesh need not be
 * its own mirror image; poles at the ends of a closed tube. */
static inline enum pm_status tube_mesh(const struct tube_shape *s, int around, int rings,
                                       struct pm_trimesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double PI = acos(-1.0);
    int32_t n = 0;

    memset(m, 0, sizeof *m);
    PM_TRY(PM_NEW(m->x, 3 * (around * rings + 2), err));
    PM_TRY(PM_NEW(m->tri, 6 * around * rings, err));
    for (int b = 0; b < rings; b++) {
        double t = s->caps ? (b + 1.0) / (rings + 1) : b / (rings - 1.0);
        for (int a = 0; a < around; a++)
            tube_point(s, t, 2 * PI * (a + 0.5 * (b % 2)) / around, &m->x[3 * n++]);
    }
    for (int b = 0; b + 1 < rings; b++)
        for (int a = 0; a < around; a++) {
            int32_t i = b * around + a, j = b * around + (a + 1) % around;
            int32_t k = i + around, l = j + around;
            const int32_t even[6] = {i, j, k, j, l, k}, odd[6] = {i, l, k, i, j, l};
            memcpy(&m->tri[3 * m->nt], b % 2 ? odd : even, sizeof even);
            m->nt += 2;
        }
    if (s->caps) {
        tube_point(s, 0, 0, &m->x[3 * n]);
        tube_point(s, 1, 0, &m->x[3 * (n + 1)]);
        for (int a = 0; a < around; a++) {
            const int32_t i = a, j = (a + 1) % around, top = (rings - 1) * around;
            const int32_t caps[6] = {j, i, n, top + i, top + j, n + 1};
            memcpy(&m->tri[3 * m->nt], caps, sizeof caps);
            m->nt += 2;
        }
        n += 2;
    }
    m->nn = n;
done:
    return status;
}

#endif
