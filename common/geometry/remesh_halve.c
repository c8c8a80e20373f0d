#include <math.h>

#include "common/geometry/remesh_edit.h"

/* Angles of a uniform tube that are on a plane but for rounding. */
static const double on_plane = 1e-12;

/* Where the path from a to b in the parameter meets the plane: a great circle of the sphere, a
 * straight line in angle and v of the tube. */
static void crossing(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, int axis, double S[3])
{
    const double *p = m->S + 3 * a, *q = m->S + 3 * b;
    double t = p[axis] / (p[axis] - q[axis]);

    for (int j = 0; j < 3; j++)
        S[j] = p[j] + t * (q[j] - p[j]);
    if (m->type == PM_SURFACE_BSPLINE) {
        const double whole = atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
        const double part = atan2(p[0] * S[1] - p[1] * S[0], p[0] * S[0] + p[1] * S[1]);
        t = part / whole;
        S[2] = p[2] + t * (q[2] - p[2]);
    }
    pm_rim_constrain(m->type, pm_rim_plane(m->type, axis), S);
}

static enum pm_status cut(struct pm_edit *m, int axis, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double S[3];
    int done_it = 0;

    for (ptrdiff_t t = 0; t < m->nt;
         t++) /* grows: both parts of a cut triangle are visited again */
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            const ptrdiff_t a = m->tri[3 * t + k], b = m->tri[3 * t + (k + 1) % 3];
            if (!(m->S[3 * a + axis] * m->S[3 * b + axis] < 0))
                continue;
            crossing(m, a, b, axis, S);
            PM_TRY(pm_edit_split_edge(m, a, b, S, &done_it, err));
            if (!done_it)
                PM_TRY(pm_fail(err, PM_NUMERIC,
                               "cannot cut the triangulation along its mirror plane"));
            k = -1;
        }
done:
    return status;
}

enum pm_status pm_edit_halve(struct pm_edit *m, int axis, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const uint8_t bit = pm_rim_plane(m->type, axis);

    for (ptrdiff_t a = 0; a < m->nn && m->type == PM_SURFACE_BSPLINE; a++)
        if (fabs(m->S[3 * a + axis]) < on_plane)
            pm_rim_constrain(m->type, bit, m->S + 3 * a);
    PM_TRY(cut(m, axis, err));
    for (ptrdiff_t t = 0; t < m->nt; t++)
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++)
            if (m->S[3 * (ptrdiff_t)m->tri[3 * t + k] + axis] < 0)
                pm_edit_remove(m, t);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->S[3 * a + axis] == 0)
            m->rim[a] = (uint8_t)(m->rim[a] | bit);
done:
    return status;
}
