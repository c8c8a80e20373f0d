#include <math.h>

#include "common/geometry/collide.h"
#include "common/geometry/remesh_edit.h"

enum { ROUNDS = 12 };

/* Largest distance of the surface from triangle t. */
static enum pm_status measure(struct pm_edit *m, ptrdiff_t t, double *off, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int32_t *v = m->tri + 3 * t;
    double S[4][3], r[3], foot[3];
    for (int k = 0; k < 3; k++)
        pm_map_middle(m->type, m->S + 3 * (ptrdiff_t)v[k], m->S + 3 * (ptrdiff_t)v[(k + 1) % 3],
                      S[k]);
    /* two thirds of the way from a corner to the middle of the other side, nearly */
    pm_map_middle(m->type, S[0], S[1], S[3]);
    pm_map_middle(m->type, S[3], S[2], S[3]);
    *off = 0;
    for (int k = 0; k < 4; k++) {
        PM_TRY(pm_map_point(m->map, m->phi, S[k], &m->basis, r, NULL, NULL, err));
        *off =
            fmax(*off, pm_collide_closest(r, m->x + 3 * (ptrdiff_t)v[0], m->x + 3 * (ptrdiff_t)v[1],
                                          m->x + 3 * (ptrdiff_t)v[2], foot));
    }
done:
    return status;
}

/* Side k of triangle t, between its corners k and k + 1, is its longest. */
static int longest_side(const struct pm_edit *m, ptrdiff_t t)
{
    const int32_t *v = m->tri + 3 * t;
    double most = 0;
    int longest = 0;
    for (int k = 0; k < 3; k++) {
        const double l = pm_edit_length(m, v[k], v[(k + 1) % 3]);
        longest = l > most ? k : longest;
        most = fmax(most, l);
    }
    return longest;
}

/* Once over the triangles there are; *off: the largest distance seen. */
static enum pm_status split_off(struct pm_edit *m, double tolerance, double *off,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t nt = m->nt;
    *off = 0;
    for (ptrdiff_t t = 0; t < nt; t++) {
        double d = 0;
        int done_it;
        if (m->tri[3 * t] < 0)
            continue;
        PM_TRY(measure(m, t, &d, err));
        *off = fmax(*off, d);
        if (!(d > tolerance))
            continue;
        const int k = longest_side(m, t);
        PM_TRY(pm_edit_split_edge(m, m->tri[3 * t + k], m->tri[3 * t + (k + 1) % 3], NULL, &done_it,
                                  err));
    }
done:
    return status;
}

enum pm_status pm_edit_hold(struct pm_edit *m, double tolerance, double *off, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(split_off(m, tolerance, off, err));
    for (int round = 1; round <= ROUNDS && *off > tolerance; round++)
        PM_TRY(split_off(m, tolerance, off, err));
done:
    return status;
}
