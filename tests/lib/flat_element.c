/* flat_element MESH.h5 OUT.h5: one vertex inside moved towards the face opposite to it, as
 * generated, until the mean ratio of the straight tetrahedra is between 0.06 and 0.08. Prints it.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/curve.h"

/* Moves vertex `a` by d and the middles of its edges by half of that; 0 where one is on a surface.
 */
static int push(const struct pm_mesh *m, int32_t a, const double d[3], double *x)
{
    unsigned char *done = calloc((size_t)m->nn, 1);
    int inside = done != NULL && m->surface[a] < 0;

    for (ptrdiff_t e = 0; e < m->ne && inside; e++) {
        const int32_t *v = &m->tet[10 * e];
        for (int k = 0; k < 6; k++) {
            const int32_t b = v[4 + k];
            if ((v[pm_tet10_edge[k][0]] != a && v[pm_tet10_edge[k][1]] != a) || done[b])
                continue;
            inside = inside && m->surface[b] < 0;
            done[b] = 1;
            for (int j = 0; j < 3; j++)
                x[3 * b + j] += d[j] / 2;
        }
    }
    for (int j = 0; j < 3; j++)
        x[3 * a + j] += d[j];
    free(done);
    return inside;
}

/* Of tetrahedron e, its first vertex. */
static int flatten(struct pm_mesh *m, ptrdiff_t e, double *x, double *ratio)
{
    const int32_t *v = &m->tet[10 * e];
    const size_t size = 3 * (size_t)m->nn * sizeof *x;
    double scaled;

    for (int percent = 50; percent < 99; percent++) {
        const double t = percent / 100.0;
        double d[3];
        memcpy(x, m->x_generated, size);
        for (int j = 0; j < 3; j++)
            d[j] =
                t * ((x[3 * v[1] + j] + x[3 * v[2] + j] + x[3 * v[3] + j]) / 3 - x[3 * v[0] + j]);
        if (!push(m, v[0], d, x))
            return 0;
        pm_curve_quality(m, x, &scaled, ratio);
        if (*ratio < 0.08)
            return *ratio > 0.06 && scaled >= 0.2;
    }
    return 0;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh m = {.nn = 0};
    const struct pm_common common = {.tool = "flat_element", .command = "flat_element"};
    struct pm_h5 *f = NULL;
    double *x = NULL, ratio = 0;
    enum pm_status status = PM_OK;
    ptrdiff_t e = 0;

    if (argc != 3)
        return PM_USAGE;
    PM_TRY(pm_mesh_load(argv[1], 0, &m, &err));
    PM_TRY(PM_NEW(x, 3 * m.nn, &err));
    while (e < m.ne && !flatten(&m, e, x, &ratio))
        e++;
    if (e == m.ne)
        PM_TRY(pm_fail(&err, PM_NUMERIC, "no vertex inside"));
    memcpy(m.x_generated, x, 3 * (size_t)m.nn * sizeof *x);
    memcpy(m.x, x, 3 * (size_t)m.nn * sizeof *x);
    PM_TRY(pm_h5_create(argv[2], "mesh", &common, NULL, &f, &err));
    PM_TRY(pm_mesh_write(f, &m, &err));
    status = pm_h5_commit(f, &err);
    f = NULL;
    printf("%.3f\n", ratio);
done:
    if (status != PM_OK)
        fprintf(stderr, "flat_element: %s\n", err.text);
    pm_h5_close(f);
    pm_mesh_release(&m);
    pm_free(x);
    return (int)status;
}
