/* Steps that turn: a bar bent to an arc keeps its lengths, planes stay planes, no step moves
 * nothing. */
#include "common/mechanics/warp.h"
#include "tests/bar.h"
#include "tests/tap.h"

enum { MOST = 3 * 6000 };

struct bent {
    struct pm_mesh mesh;
    struct pm_model *m;
    struct pm_warp *w;
    struct pm_config from, to;
    double du1[MOST], du2[MOST];
};

static enum pm_status bent_new(const struct bar *b, struct bent *t, struct pm_err *err)
{
    enum pm_status status;
    memset(t, 0, sizeof *t);
    PM_TRY(bar_mesh(b, &t->mesh, err));
    PM_TRY(pm_model_new(&t->mesh, NULL, &t->m, err));
    PM_TRY(pm_warp_new(t->m, &t->w, err));
    PM_TRY(pm_config_new(t->m, &t->from, err));
    PM_TRY(pm_config_new(t->m, &t->to, err));
done:
    return status;
}

static void bent_release(struct bent *t)
{
    pm_config_release(&t->from);
    pm_config_release(&t->to);
    pm_warp_free(t->w);
    pm_model_free(t->m);
    pm_mesh_release(&t->mesh);
}

/* The arc of curvature k: where point X goes. */
static void arc(const double *X, double k, double *x)
{
    const double a = k * X[2], s = sin(0.5 * a);
    x[0] = 2 * s * s / k + X[0] * cos(a);
    x[1] = X[1];
    x[2] = sin(a) / k - X[0] * sin(a);
}

/* First and second derivatives by k of the arc at k = 0, times k and k^2. */
static void bending(struct bent *t, double k)
{
    for (ptrdiff_t a = 0; a < t->m->nn; a++) {
        const double *X = t->mesh.x + 3 * a;
        t->du1[3 * a] = k * X[2] * X[2] / 2;
        t->du1[3 * a + 1] = 0;
        t->du1[3 * a + 2] = -k * X[0] * X[2];
        t->du2[3 * a] = -k * k * X[0] * X[2] * X[2];
        t->du2[3 * a + 1] = 0;
        t->du2[3 * a + 2] = -k * k * X[2] * X[2] * X[2] / 3;
    }
}

/* Largest distance from the arc [mm]. */
static double off_arc(const struct bent *t, const double *u, double k)
{
    double worst = 0;
    for (ptrdiff_t a = 0; a < t->m->nn; a++) {
        double x[3], sum = 0;
        arc(t->mesh.x + 3 * a, k, x);
        for (int i = 0; i < 3; i++)
            sum += pow(t->mesh.x[3 * a + i] + u[3 * a + i] - x[i], 2);
        worst = fmax(worst, sqrt(sum));
    }
    return worst;
}

/* Length of the axis, over its length at rest: the nodes on x = y = 0 come in ascending z. */
static double axis(const struct bent *t, const double *u, double length)
{
    double sum = 0, last[3] = {0};
    for (ptrdiff_t a = 0; a < t->m->nn; a++) {
        const double *X = t->mesh.x + 3 * a;
        double x[3], d = 0;
        if (fabs(X[0]) > 1e-12 || fabs(X[1]) > 1e-12)
            continue;
        for (int i = 0; i < 3; i++) {
            x[i] = X[i] + u[3 * a + i];
            d += pow(x[i] - last[i], 2);
            last[i] = x[i];
        }
        sum += sqrt(d);
    }
    return sum / length;
}

static enum pm_status widths(struct pm_err *err)
{
    static struct bent t;
    enum pm_status status = PM_OK;
    for (int n = 1; n <= 4; n *= 2) {
        const struct bar b = {.width = 2.0 / n, .length = 10, .cells = 2, .layers = 10 * n};
        PM_TRY(bent_new(&b, &t, err));
        bending(&t, 0.2);
        PM_TRY(pm_warp_move(t.w, &t.from, t.du1, NULL, &t.to, err));
        printf("# %d first %g axis %g theta %.9f straight %g\n", n, off_arc(&t, t.to.u, 0.2),
               axis(&t, t.to.u, 10), t.to.U[4], axis(&t, t.du1, 10));
        PM_TRY(pm_warp_move(t.w, &t.from, t.du1, t.du2, &t.to, err));
        printf("# %d second %g axis %g theta %.9f\n", n, off_arc(&t, t.to.u, 0.2),
               axis(&t, t.to.u, 10), t.to.U[4]);
        bent_release(&t);
    }
done:
    return status;
}

int main(void)
{
    struct pm_err err = {0};
    if (widths(&err) != PM_OK)
        return tap_bail("%s", err.text);
    return tap_done();
}
