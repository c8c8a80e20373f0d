#include "common/mechanics/advect.h"

#include "common/base/memory.h"
#include "common/mechanics/tet10.h"

/* Reference coordinates of the ten nodes. */
static const double NODE[10][3] = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},   {0, 0, 1},
                                   {0.5, 0, 0},   {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5},
                                   {0, 0.5, 0.5}, {0.5, 0, 0.5}};

/* Adds du/dX of one element at its nodes to H (nn x 9). */
static void add_gradients(const struct pm_mesh *m, ptrdiff_t e, const double *u, double *H,
                          double *count)
{
    const int32_t *node = m->tet + 10 * e;
    double X[30], dN[30];

    for (int a = 0; a < 10; a++)
        for (int i = 0; i < 3; i++)
            X[3 * a + i] = m->x[3 * node[a] + i];
    for (int b = 0; b < 10; b++) {
        double *h = H + 9 * (ptrdiff_t)node[b];
        pm_tet10_gradient(X, NODE[b], dN);
        for (int a = 0; a < 10; a++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    h[3 * i + j] += u[3 * node[a] + i] * dN[3 * a + j];
        count[node[b]]++;
    }
}

enum pm_status pm_advect(const struct pm_mesh *from, const double *u, const struct pm_mesh *to,
                         double *u_to, struct pm_err *err)
{
    enum pm_status status;
    double *H = NULL, *count = NULL;

    PM_TRY(PM_NEW(H, 9 * from->nn, err));
    PM_TRY(PM_NEW(count, from->nn, err));
    for (ptrdiff_t e = 0; e < from->ne; e++)
        add_gradients(from, e, u, H, count);
    for (ptrdiff_t a = 0; a < from->nn; a++)
        for (int i = 0; i < 3; i++) {
            u_to[3 * a + i] = u[3 * a + i];
            for (int j = 0; j < 3 && count[a] > 0; j++)
                u_to[3 * a + i] +=
                    H[9 * a + 3 * i + j] / count[a] * (to->x[3 * a + j] - from->x[3 * a + j]);
        }
done:
    pm_free(H);
    pm_free(count);
    return status;
}
