/* pressure_noise STATE.h5: root mean square of the jumps of element pressures, kappa (Vdeformed/V
 * - 1) by the rule of the 10-node elements, over faces between tetrahedra, and of the pressures
 * themselves, both weighted by volume, in units of mu; tet10, tet10-blend and tet10-mean. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/state.h"
#include "common/mechanics/tet10.h"

struct face {
    int32_t v[3], e;
};

static int by_vertices(const void *a, const void *b)
{
    const struct face *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->v[k] != q->v[k])
            return p->v[k] < q->v[k] ? -1 : 1;
    return (p->e > q->e) - (p->e < q->e);
}

static int ascending(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

/* Volumes of an element by the rule: reference and deformed. */
static void volumes(const struct pm_state *s, ptrdiff_t e, double V[2])
{
    double X[30], x[30], dN[30];
    V[0] = V[1] = 0;
    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++) {
            const ptrdiff_t k = 3 * (ptrdiff_t)s->mesh.tet[10 * e + a] + i;
            X[3 * a + i] = s->mesh.x[k];
            x[3 * a + i] = s->mesh.x[k] + s->u[k];
        }
    for (int q = 0; q < PM_TET_POINTS; q++) {
        V[0] += pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN);
        V[1] += pm_tet_weight[q] * pm_tet10_gradient(x, pm_tet_xi[q], dN);
    }
}

static enum pm_status measure(const struct pm_state *s, struct pm_err *err)
{
    static const int corner[4][3] = {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
    enum pm_status status = PM_OK;
    const ptrdiff_t ne = s->mesh.ne;
    double *p = NULL, *w = NULL, jump = 0, size = 0, weight[2] = {0};
    struct face *f = NULL;
    PM_TRY(PM_NEW(p, ne, err));
    PM_TRY(PM_NEW(w, ne, err));
    PM_TRY(PM_NEW(f, 4 * ne, err));
    for (ptrdiff_t e = 0; e < ne; e++) {
        double V[2];
        volumes(s, e, V);
        w[e] = V[0];
        p[e] = s->mesh.pcase.kappa / s->mesh.pcase.mu * (V[1] / V[0] - 1);
        size += w[e] * p[e] * p[e];
        weight[0] += w[e];
        for (int k = 0; k < 4; k++) {
            struct face *g = f + 4 * e + k;
            g->e = (int32_t)e;
            for (int a = 0; a < 3; a++)
                g->v[a] = s->mesh.tet[10 * e + corner[k][a]];
            qsort(g->v, 3, sizeof g->v[0], ascending);
        }
    }
    qsort(f, (size_t)(4 * ne), sizeof *f, by_vertices);
    for (ptrdiff_t k = 0; k + 1 < 4 * ne; k++)
        if (memcmp(f[k].v, f[k + 1].v, sizeof f[k].v) == 0) {
            const double v = w[f[k].e] + w[f[k + 1].e], d = p[f[k].e] - p[f[k + 1].e];
            jump += v * d * d;
            weight[1] += v;
        }
    printf("%.4f\t%.4f\n", sqrt(jump / weight[1]), sqrt(size / weight[0]));
done:
    pm_free(p);
    pm_free(w);
    pm_free(f);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_state s = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: pressure_noise STATE.h5\n");
        return PM_USAGE;
    }
    if (pm_state_load(argv[1], 0, &s, &err) == PM_OK) {
        if (s.mesh.npe == 10 && strncmp(s.element, "tet10", 5) == 0)
            measure(&s, &err);
        else
            pm_fail(&err, PM_INPUT, "'%s' is of element %s, expected one of 10 nodes", argv[1],
                    s.element);
    }
    if (err.status != PM_OK)
        fprintf(stderr, "pressure_noise: %s\n", err.text);
    pm_state_release(&s);
    return (int)err.status;
}
