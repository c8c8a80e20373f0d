/* What a mesh has at the points of another: gradients of quadratic fields exactly within straight
 * elements, of homogeneous ones also outside, images behind a symmetry plane; stresses exactly
 * where points coincide; a displacement fitted to its own gradients is itself. */
#include "common/mechanics/transfer.h"
#include "common/mechanics/warp.h"
#include "tests/bar.h"
#include "tests/tap.h"

struct body {
    struct pm_mesh mesh;
    struct pm_model *m;
    struct pm_config c;
    pm_lanes *gradient, *mixed;
};

/* u (3) and its gradient G (9) at x. */
typedef void field(const double *x, double u[3], double G[9]);

static void homogeneous(const double *x, double u[3], double G[9])
{
    static const double A[9] = {0.3, -0.1, 0.1, 0.2, 0.4, -0.2, 0.05, 0.3, 0.1};
    for (int i = 0; i < 3; i++)
        u[i] = A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2];
    memcpy(G, A, sizeof A);
}

/* Its own image at y = 0. */
static void quadratic(const double *x, double u[3], double G[9])
{
    const double D[9] = {0.1 * x[2],  -0.08 * x[1], 0.1 * x[0] + 0.05, 0,
                         0.06 * x[2], 0.06 * x[1],  0.08 * x[0],       0,
                         0.02 * x[2]};
    u[0] = 0.1 * x[0] * x[2] - 0.04 * x[1] * x[1] + 0.05 * x[2];
    u[1] = 0.06 * x[1] * x[2];
    u[2] = 0.01 * x[2] * x[2] + 0.04 * x[0] * x[0];
    memcpy(G, D, sizeof D);
}

/* 0 at the base and at the tip, which is at z = 4. */
static void held(const double *x, double u[3], double G[9])
{
    const double b = x[2] * (4 - x[2]), d = 4 - 2 * x[2];
    const double D[9] = {0, 0, 0.05 * d, 0, 0, 0, 0, 0, 0.01 * d};
    u[0] = 0.05 * b;
    u[1] = 0;
    u[2] = 0.01 * b;
    memcpy(G, D, sizeof D);
}

static enum pm_status body_new(const struct bar *b, field *f, struct body *o, struct pm_err *err)
{
    enum pm_status status;
    double G[9];
    *o = (struct body){.m = NULL};
    PM_TRY(bar_mesh(b, &o->mesh, err));
    PM_TRY(pm_model_new(&o->mesh, NULL, &o->m, err));
    PM_TRY(pm_config_new(o->m, &o->c, err));
    for (ptrdiff_t a = 0; a < o->m->nn; a++)
        f(o->mesh.x + 3 * a, o->c.u + 3 * a, G);
    PM_TRY(PM_NEW_LANES(o->gradient, 9 * o->m->nb * o->m->space.type->nq, err));
    PM_TRY(pm_model_mixed_new(o->m, &o->mixed, err));
done:
    return status;
}

static void body_release(struct body *o)
{
    pm_config_release(&o->c);
    pm_model_free(o->m);
    pm_mesh_release(&o->mesh);
    pm_free(o->gradient);
    pm_free(o->mixed);
}

/* Of straight elements; lanes behind the last too. */
static double gradient_error(const struct body *o, field *f)
{
    const struct pm_element_type *t = o->m->space.type;
    double worst = 0;
    for (ptrdiff_t k = 0; k < PM_LANES * o->m->nb * t->nq; k++) {
        const ptrdiff_t lane = k / t->nq, e = lane < o->mesh.ne ? lane : o->mesh.ne - 1;
        const double *xi = t->xi[k % t->nq];
        const int32_t *v = o->mesh.tet + 10 * e;
        double x[3], u[3], G[9];
        for (int i = 0; i < 3; i++) {
            const double *X = o->mesh.x + i;
            x[i] = X[3 * v[0]];
            for (int j = 0; j < 3; j++)
                x[i] += xi[j] * (X[3 * v[j + 1]] - X[3 * v[0]]);
        }
        f(x, u, G);
        for (int i = 0; i < 9; i++)
            worst =
                fmax(worst, fabs(G[i] - o->gradient[9 * (t->nq * (lane / PM_LANES) + k % t->nq) + i]
                                                   [lane % PM_LANES]));
    }
    return worst;
}

/* Against those of its own at c; in parts of the largest. */
static enum pm_status mixed_error(const struct body *o, double *error, struct pm_err *err)
{
    enum pm_status status;
    double *still = NULL, most = 0;
    pm_lanes *own = NULL;
    *error = 0;
    PM_TRY(PM_NEW(still, 3 * o->m->nn, err));
    PM_TRY(pm_model_mixed_new(o->m, &own, err));
    pm_model_mixed(o->m, &o->c, still, own);
    for (ptrdiff_t k = 0; k < PM_MIXED * o->m->nb * o->m->space.type->nq; k++)
        for (int l = 0; l < PM_LANES; l++) {
            most = fmax(most, fabs(own[k][l]));
            *error = fmax(*error, fabs(own[k][l] - o->mixed[k][l]));
        }
    *error /= most;
done:
    pm_free(still);
    pm_free(own);
    return status;
}

/* From a bar to another; error: of the gradients, of pressures and stresses, of the displacement
 * fitted to the gradients [mm]. */
static enum pm_status carry(const struct bar *from, const struct bar *to, field *f, double error[3],
                            struct pm_err *err)
{
    enum pm_status status;
    struct body a = {.m = NULL}, b = {.m = NULL};
    struct pm_warp *w = NULL;
    struct pm_config fit = {0};
    PM_TRY(body_new(from, f, &a, err));
    PM_TRY(body_new(to, f, &b, err));
    PM_TRY(pm_transfer(a.m, &a.c, b.m, b.gradient, b.mixed, err));
    error[0] = gradient_error(&b, f);
    PM_TRY(mixed_error(&b, &error[1], err));
    PM_TRY(pm_config_new(b.m, &fit, err));
    PM_TRY(pm_warp_new(b.m, &w, err));
    PM_TRY(pm_warp_fit(w, b.gradient, &fit, err));
    error[2] = 0;
    for (ptrdiff_t k = 0; k < 3 * b.m->nn; k++)
        error[2] = fmax(error[2], fabs(fit.u[k] - b.c.u[k]));
done:
    pm_config_release(&fit);
    pm_warp_free(w);
    body_release(&a);
    body_release(&b);
    return status;
}

int main(void)
{
    static const struct bar coarse = {2, 4, 2, 3, 0, 0}, fine = {2, 4, 4, 5, 0, 0},
                            wide = {2.4, 4.4, 4, 5, 0, 0}, half = {2, 4, 4, 5, 1, 0};
    struct pm_err err = {0};
    double e[3];
    /* bounds: rounding; gradients are below 1, displacements below 1 mm */
    if (carry(&coarse, &wide, homogeneous, e, &err) != PM_OK)
        return tap_bail("%s", err.text);
    near_abs("homogeneous, also outside: gradients", e[0], 0, 1e-12);
    near_abs("stresses", e[1], 0, 1e-10);
    if (carry(&coarse, &fine, quadratic, e, &err) != PM_OK)
        return tap_bail("%s", err.text);
    near_abs("quadratic: gradients", e[0], 0, 1e-12);
    ok(e[1] > 1e-6, "stresses are interpolated"); /* else the next case says nothing */
    if (carry(&half, &fine, quadratic, e, &err) != PM_OK)
        return tap_bail("%s", err.text);
    near_abs("from a half: gradients", e[0], 0, 1e-12);
    near_abs("stresses at the same points and behind the plane", e[1], 0, 1e-9);
    if (carry(&fine, &half, quadratic, e, &err) != PM_OK)
        return tap_bail("%s", err.text);
    near_abs("to a half: gradients", e[0], 0, 1e-12);
    near_abs("stresses", e[1], 0, 1e-9);
    if (carry(&coarse, &fine, held, e, &err) != PM_OK)
        return tap_bail("%s", err.text);
    near_abs("held at both ends: gradients", e[0], 0, 1e-12);
    near_abs("the displacement of these gradients [mm]", e[2], 0, 1e-10);
    return tap_done();
}
