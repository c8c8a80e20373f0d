#include <math.h>

#include "common/geometry/remesh_edit.h"

/* Where the great circle from a to b meets the plane. */
static void crossing(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, int axis, double S[3])
{
    const double *p = m->S + 3 * a, *q = m->S + 3 * b, t = p[axis] / (p[axis] - q[axis]);
    double sum = 0;

    for (int j = 0; j < 3; j++) {
        S[j] = j == axis ? 0 : p[j] + t * (q[j] - p[j]);
        sum += S[j] * S[j];
    }
    for (int j = 0; j < 3; j++)
        S[j] /= sqrt(sum);
}

enum pm_status pm_edit_halve(struct pm_edit *m, int axis, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double S[3];
    int cut = 0;

    for (ptrdiff_t t = 0; t < m->nt;
         t++) /* grows: both parts of a cut triangle are visited again */
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++) {
            ptrdiff_t a = m->tri[3 * t + k], b = m->tri[3 * t + (k + 1) % 3];
            if (!(m->S[3 * a + axis] * m->S[3 * b + axis] < 0))
                continue;
            crossing(m, a, b, axis, S);
            PM_TRY(pm_edit_split_edge(m, a, b, S, &cut, err));
            if (!cut)
                PM_TRY(pm_fail(err, PM_NUMERIC,
                               "cannot cut the triangulation along its mirror plane"));
            k = -1;
        }
    for (ptrdiff_t t = 0; t < m->nt; t++)
        for (int k = 0; k < 3 && m->tri[3 * t] >= 0; k++)
            if (m->S[3 * (ptrdiff_t)m->tri[3 * t + k] + axis] < 0)
                pm_edit_remove(m, t);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->S[3 * a + axis] == 0)
            m->rim[a] = (uint8_t)(m->rim[a] | 1 << axis);
done:
    return status;
}
