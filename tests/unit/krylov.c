/* Conjugate gradients with an older factor against the factor of the same matrix. */
#include "common/mechanics/krylov.h"
#include "tests/bar.h"
#include "tests/tap.h"

enum { COLUMNS = 3, MOST = 4000 };

struct system {
    struct pm_mesh mesh;
    struct pm_model *m;
    struct pm_config rest, sheared;
    double *f;
    double b[COLUMNS * MOST], x[COLUMNS * MOST], want[COLUMNS * MOST];
};

static enum pm_status system_new(struct system *s, struct pm_err *err)
{
    enum pm_status status;
    const struct bar b = {2, 6, 2, 6, 0, 0};
    PM_TRY(bar_mesh(&b, &s->mesh, err));
    PM_TRY(pm_model_new(&s->mesh, NULL, &s->m, err));
    PM_TRY(pm_config_new(s->m, &s->rest, err));
    PM_TRY(pm_config_new(s->m, &s->sheared, err));
    PM_TRY(PM_NEW(s->f, 3 * s->m->nn, err));
    for (ptrdiff_t a = 0; a < s->m->nn; a++)
        s->sheared.u[3 * a] = 0.03 * s->mesh.x[3 * a + 2];
    s->sheared.U[0] = 0.03 * b.length;
    pm_model_place_tip(s->m, &s->sheared);
    for (ptrdiff_t i = 0; i < COLUMNS * s->m->nq; i++)
        s->b[i] = s->m->fixed[i % s->m->nq] ? 0 : sin(0.3 + 1.7 * (double)i);
done:
    return status;
}

static void system_release(struct system *s)
{
    pm_config_release(&s->rest);
    pm_config_release(&s->sheared);
    pm_free(s->f);
    pm_model_free(s->m);
    pm_mesh_release(&s->mesh);
}

static enum pm_status factor(struct system *s, const struct pm_config *c, struct pm_err *err)
{
    enum pm_status status;
    const double none = 0;
    double low;
    int definite;
    pm_model_potential(s->m, c, &none, s->f, NULL, &low);
    PM_TRY(pm_model_factor(s->m, c, &none, s->f, NULL, &definite, err));
    ok(definite && low > 0, "a positive definite tangent");
done:
    return status;
}

static void assemble(struct system *s, const struct pm_config *c)
{
    const double none = 0;
    double low;
    pm_model_potential(s->m, c, &none, s->f, NULL, &low);
    pm_model_assemble(s->m, c, &none, s->f, NULL);
}

static void scale_values(struct system *s, double by)
{
    for (ptrdiff_t k = 0; k < s->m->pattern.ptr[s->m->pattern.n]; k++)
        s->m->value[k] *= by;
}

static enum pm_status plain(struct system *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_krylov_report r;
    const ptrdiff_t n = COLUMNS * s->m->nq;
    const size_t bytes = (size_t)n * sizeof *s->x;
    PM_TRY(factor(s, &s->sheared, err));
    memcpy(s->want, s->b, bytes);
    PM_TRY(pm_cholesky_solve(s->m->factor, s->want, COLUMNS, err));
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve(s->m, s->x, COLUMNS, 1e-9, 50, &r, err));
    ok(r.good && r.steps <= 2, "its own factor: %d steps", r.steps);
    near_array("the same", s->x, s->want, n, 1e-9);
    near_abs("eigenvalues 1", fmax(r.largest - 1, 1 - r.least), 0, 1e-9);

    PM_TRY(factor(s, &s->rest, err));
    assemble(s, &s->sheared);
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve(s->m, s->x, COLUMNS, 1e-12, 150, &r, err));
    ok(r.good && r.steps > 5, "the factor of the body at rest: %d steps", r.steps);
    near_array("the same", s->x, s->want, n, 1e-9);
    ok(r.least < 0.9 && r.least > 0 && r.largest > 1.1, "eigenvalues %g to %g", r.least, r.largest);
    const int steps = r.steps;
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve(s->m, s->x, COLUMNS, 1e-12, steps - 2, &r, err));
    ok(!r.good && r.steps == steps - 2, "two steps too few: not good");

    assemble(s, &s->rest);
    scale_values(s, 1.5);
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve(s->m, s->x, COLUMNS, 1e-9, 50, &r, err));
    near_rel("half as stiff again: eigenvalue 1.5", r.largest, 1.5, 1e-9);
    scale_values(s, -1);
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve(s->m, s->x, COLUMNS, 1e-9, 50, &r, err));
    ok(!r.good && r.least < 0, "negative curvature is seen");
done:
    return status;
}

/* s->want: from K^-1 r to (K + gamma b b^T)^-1 r, z = K^-1 b (Sherman and Morrison). */
static void border(struct system *s, double gamma, const double *b, const double *z)
{
    const ptrdiff_t nq = s->m->nq;
    double bz = 0;
    for (ptrdiff_t i = 0; i < nq; i++)
        bz += b[i] * z[i];
    for (ptrdiff_t c = 0; c < COLUMNS; c++) {
        double *x = s->want + c * nq, bx = 0;
        for (ptrdiff_t i = 0; i < nq; i++)
            bx += b[i] * x[i];
        for (ptrdiff_t i = 0; i < nq; i++)
            x[i] -= gamma * bx / (1 + gamma * bz) * z[i];
    }
}

/* Any b, the tangent of the sheared body, the factor of the one at rest. */
static enum pm_status stiffened(struct system *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_krylov_report r;
    static double z[MOST];
    const ptrdiff_t nq = s->m->nq;
    const size_t bytes = (size_t)(COLUMNS * nq) * sizeof *s->x;
    const double *b = s->b + nq;
    PM_TRY(factor(s, &s->sheared, err));
    memcpy(z, b, (size_t)nq * sizeof *z);
    PM_TRY(pm_cholesky_solve(s->m->factor, z, 1, err));
    memcpy(s->want, s->b, bytes);
    PM_TRY(pm_cholesky_solve(s->m->factor, s->want, COLUMNS, err));
    PM_TRY(factor(s, &s->rest, err));
    assemble(s, &s->sheared);
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve_stiffened(s->m, b, s->x, COLUMNS, 1e-12, 150, &r, err));
    ok(r.good && r.steps > 5, "stiffened, the factor of the body at rest: %d steps", r.steps);
    border(s, r.gamma, b, z);
    near_array("as by the direct solve", s->x, s->want, COLUMNS * nq, 1e-9);
done:
    return status;
}

/* K = the tangent at rest less alpha e e^T, one diagonal entry, so that it is indefinite; b = e: K
 * + gamma b b^T by Sherman and Morrison. */
static enum pm_status indefinite(struct system *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_krylov_report r;
    static double e[MOST], z[MOST];
    const ptrdiff_t nq = s->m->nq, k = nq / 2;
    const size_t bytes = (size_t)(COLUMNS * nq) * sizeof *s->x;
    PM_TRY(factor(s, &s->rest, err));
    e[k] = 1;
    memcpy(z, e, sizeof z);
    PM_TRY(pm_cholesky_solve(s->m->factor, z, 1, err));
    const double alpha = 2 / z[k];
    s->m->value[s->m->pattern.ptr[k] + k % 3] -= alpha;
    memcpy(s->x, e, sizeof e);
    PM_TRY(pm_krylov_solve(s->m, s->x, 1, 1e-9, 50, &r, err));
    ok(!r.good && r.least < 0, "a negative direction is seen");

    memcpy(s->want, s->b, bytes);
    PM_TRY(pm_cholesky_solve(s->m->factor, s->want, COLUMNS, err));
    memcpy(s->x, s->b, bytes);
    PM_TRY(pm_krylov_solve_stiffened(s->m, e, s->x, COLUMNS, 1e-12, 50, &r, err));
    near_rel("gamma", r.gamma, 10 / z[k], 1e-12);
    ok(r.good, "stiffened along it: %d steps", r.steps);
    border(s, r.gamma - alpha, e, z);
    near_array("as by the direct solve", s->x, s->want, COLUMNS * nq, 1e-9);
done:
    return status;
}

int main(void)
{
    static struct system s;
    struct pm_err err = {0};
    if (system_new(&s, &err) != PM_OK || plain(&s, &err) != PM_OK || stiffened(&s, &err) != PM_OK ||
        indefinite(&s, &err) != PM_OK)
        return tap_bail("%s", err.text);
    system_release(&s);
    return tap_done();
}
