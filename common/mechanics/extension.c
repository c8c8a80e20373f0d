#include "common/mechanics/extension.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/pattern.h"
#include "common/base/sparse.h"
#include "common/mechanics/tet10.h"

struct pm_extension {
    const struct pm_mesh *mesh; /* borrowed: connectivity, x_generated */
    struct pm_pattern pattern;  /* interior nodes, one equation each */
    struct pm_cholesky *factor;
    double *rhs; /* 3 right-hand sides (3 x n) */
};

/* Element Laplace matrix on the generated mesh (10 x 10). */
static void laplace_matrix(const struct pm_mesh *m, ptrdiff_t e, double K[100])
{
    double X[30], dN[30];
    for (int a = 0; a < 10; a++)
        memcpy(X + 3 * a, m->x_generated + 3 * (ptrdiff_t)m->tet[10 * e + a], 3 * sizeof *X);
    memset(K, 0, 100 * sizeof *K);
    for (int q = 0; q < PM_TET_POINTS; q++) {
        double w = pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10; b++)
                K[10 * a + b] += w * (dN[3 * a] * dN[3 * b] + dN[3 * a + 1] * dN[3 * b + 1] +
                                      dN[3 * a + 2] * dN[3 * b + 2]);
    }
}

static enum pm_status factor_laplace(struct pm_extension *e, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = e->mesh;
    const struct pm_pattern *p = &e->pattern;
    double *value = NULL, K[100];
    PM_TRY(PM_NEW(value, p->ptr[p->n], err));
    for (ptrdiff_t k = 0; k < m->ne; k++) {
        laplace_matrix(m, k, K);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10; b++) {
                ptrdiff_t i = p->eq[m->tet[10 * k + a]], j = p->eq[m->tet[10 * k + b]];
                if (i >= 0 && j >= 0 && i >= j)
                    value[pm_pattern_block(p, i, j, 0)] += K[10 * a + b];
            }
    }
    int definite;
    ptrdiff_t column;
    PM_TRY(pm_cholesky_new(p->n, p->ptr, p->row, &e->factor, err));
    PM_TRY(pm_cholesky_factor(e->factor, value, &definite, &column, err));
    if (!definite)
        status =
            pm_fail(err, PM_NUMERIC,
                    "Laplace extension is not positive definite (equation %td): inverted elements?",
                    column);
done:
    pm_free(value);
    return status;
}

enum pm_status pm_extension_new(const struct pm_mesh *m, struct pm_extension **out,
                                struct pm_err *err)
{
    enum pm_status status;
    uint8_t *interior = NULL;
    struct pm_extension *e = pm_calloc(1, sizeof *e, err);
    if (e == NULL)
        return PM_SYSTEM;
    e->mesh = m;
    PM_TRY(PM_NEW(interior, m->nn, err));
    memset(interior, 1, (size_t)m->nn);
    for (ptrdiff_t k = 0; k < 6 * m->nf; k++)
        interior[m->tri[k]] = 0;
    PM_TRY(pm_pattern_new(
        &(struct pm_pattern_source){m->nn, m->ne, 10, m->tet, interior, NULL, 1, 0, NULL},
        &e->pattern, err));
    PM_TRY(PM_NEW(e->rhs, 3 * e->pattern.n, err));
    if (e->pattern.n > 0)
        PM_TRY(factor_laplace(e, err));
    *out = e;
    e = NULL;
done:
    pm_free(interior);
    pm_extension_free(e);
    return status;
}

enum pm_status pm_extension_apply(struct pm_extension *e, double *d, struct pm_err *err)
{
    const struct pm_mesh *m = e->mesh;
    const ptrdiff_t *eq = e->pattern.eq, n = e->pattern.n;
    double K[100];
    if (n == 0)
        return PM_OK;
    memset(e->rhs, 0, 3 * (size_t)n * sizeof *e->rhs);
    for (ptrdiff_t k = 0; k < m->ne; k++) {
        const int32_t *t = m->tet + 10 * k;
        laplace_matrix(m, k, K);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10 && eq[t[a]] >= 0; b++)
                for (int i = 0; i < 3 && eq[t[b]] < 0; i++)
                    e->rhs[i * n + eq[t[a]]] -= K[10 * a + b] * d[3 * (ptrdiff_t)t[b] + i];
    }
    enum pm_status status = pm_cholesky_solve(e->factor, e->rhs, 3, err);
    for (ptrdiff_t a = 0; a < m->nn && status == PM_OK; a++)
        for (int i = 0; i < 3 && eq[a] >= 0; i++)
            d[3 * a + i] = e->rhs[i * n + eq[a]];
    return status;
}

enum pm_status pm_extension_transpose(struct pm_extension *e, double *D, struct pm_err *err)
{
    const struct pm_mesh *m = e->mesh;
    const ptrdiff_t *eq = e->pattern.eq, n = e->pattern.n;
    double K[100];
    if (n == 0)
        return PM_OK;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && eq[a] >= 0; i++) {
            e->rhs[i * n + eq[a]] = D[3 * a + i];
            D[3 * a + i] = 0.0;
        }
    enum pm_status status = pm_cholesky_solve(e->factor, e->rhs, 3, err);
    for (ptrdiff_t k = 0; k < m->ne && status == PM_OK; k++) {
        const int32_t *t = m->tet + 10 * k;
        laplace_matrix(m, k, K);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10 && eq[t[a]] < 0; b++)
                for (int i = 0; i < 3 && eq[t[b]] >= 0; i++)
                    D[3 * (ptrdiff_t)t[a] + i] -= K[10 * a + b] * e->rhs[i * n + eq[t[b]]];
    }
    return status;
}

void pm_extension_free(struct pm_extension *e)
{
    if (e == NULL)
        return;
    pm_cholesky_free(e->factor);
    pm_pattern_release(&e->pattern);
    pm_free(e->rhs);
    pm_free(e);
}

enum pm_status pm_mesh_morph(struct pm_mesh *m, struct pm_extension *e, const double *phi,
                             struct pm_err *err)
{
    enum pm_status status;
    double *d = NULL;
    PM_TRY(PM_NEW(d, 3 * m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (m->wptr[a] == m->wptr[a + 1])
            continue;
        double r[3] = {0, 0, 0};
        for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++)
            for (int i = 0; i < 3; i++)
                r[i] += m->wval[k] * phi[3 * (ptrdiff_t)m->wcol[k] + i];
        for (int i = 0; i < 3; i++)
            d[3 * a + i] = r[i] - m->x_generated[3 * a + i];
    }
    PM_TRY(pm_extension_apply(e, d, err));
    for (ptrdiff_t k = 0; k < 3 * m->nn; k++)
        m->x[k] = m->x_generated[k] + d[k];
done:
    pm_free(d);
    return status;
}

void pm_mesh_pull_back(const struct pm_mesh *m, const double *D, double *g)
{
    memset(g, 0, 3 * (size_t)m->N * sizeof *g);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++)
            for (int i = 0; i < 3; i++)
                g[3 * (ptrdiff_t)m->wcol[k] + i] += m->wval[k] * D[3 * a + i];
}
