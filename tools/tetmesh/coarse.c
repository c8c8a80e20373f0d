#include "tools/tetmesh/coarse.h"

#include <math.h>

#include "common/base/memory.h"
#include "tools/tetmesh/shell.h"

static const double longest = 1.5;

static enum pm_status wanted(const struct pm_surfaces *s, double size, const struct pm_mesh *m,
                             double *h, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_remesh_opts o = pm_shell_edges(size, s->pcase.mesh_crest);
    struct pm_map *map[PM_MAX_CHAMBERS + 1] = {NULL};
    struct pm_basis work = {0};
    double r_a[6], r_ab[9];

    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(pm_map_new(&s->s[k], &map[k], err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const int32_t k = m->surface[a];
        if (k < 0)
            continue;
        PM_TRY(pm_map_point(map[k], s->s[k].phi, &m->S[3 * a], &work, NULL, r_a, r_ab, err));
        h[a] = pm_remesh_length(&o, r_a, r_ab);
    }
done:
    for (ptrdiff_t k = 0; k < s->ns; k++)
        pm_map_free(map[k]);
    pm_basis_release(&work);
    return status;
}

/* Its area by its corners, and the longest edge over what is wanted there. */
static double look(const struct pm_mesh *m, const int32_t *v, const double *h, double *ratio)
{
    double e[3][3], n[3];

    *ratio = 0;
    for (int k = 0; k < 3; k++) {
        const ptrdiff_t a = v[k], b = v[(k + 1) % 3], middle = v[3 + k];
        for (int i = 0; i < 3; i++)
            e[k][i] = m->x[3 * b + i] - m->x[3 * a + i];
        const double length = sqrt(e[k][0] * e[k][0] + e[k][1] * e[k][1] + e[k][2] * e[k][2]);
        *ratio = fmax(*ratio, length / fmin(h[middle], fmin(h[a], h[b])));
    }
    for (int i = 0; i < 3; i++)
        n[i] = e[0][(i + 1) % 3] * e[1][(i + 2) % 3] - e[0][(i + 2) % 3] * e[1][(i + 1) % 3];
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

enum pm_status pm_coarse_part(const struct pm_surfaces *s, double size, const struct pm_mesh *m,
                              double *part, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *h = NULL, area = 0, over = 0, ratio;

    PM_TRY(PM_NEW(h, m->nn, err));
    PM_TRY(wanted(s, size, m, h, err));
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        if (m->tri_tag[f] < 0)
            continue;
        const double A = look(m, m->tri + 6 * f, h, &ratio);
        area += A;
        over += ratio > longest ? A : 0;
    }
    *part = area > 0 ? over / area : 0;
done:
    pm_free(h);
    return status;
}
