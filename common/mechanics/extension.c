#include "common/mechanics/extension.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/pattern.h"
#include "common/base/sparse.h"
#include "common/mechanics/tet10.h"

/* Axes with the same unknown nodes. */
struct field {
    struct pm_pattern pattern; /* one equation each */
    struct pm_cholesky *factor;
    int naxes, axis[3];
};

struct pm_extension {
    const struct pm_mesh *mesh; /* borrowed: connectivity, x_generated */
    uint8_t *given;             /* bit i: coordinate i is given (nn) */
    uint8_t *plane;             /* bit i: the node is on a symmetry plane across axis i (nn) */
    struct field field[3];
    int nfields;
    double *rhs; /* 3 right-hand sides (3 x most unknowns) */
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

static enum pm_status factor_laplace(const struct pm_mesh *m, struct field *f, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_pattern *p = &f->pattern;
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
    PM_TRY(pm_cholesky_new(p->n, p->ptr, p->row, &f->factor, err));
    PM_TRY(pm_cholesky_factor(f->factor, value, &definite, &column, err));
    if (!definite)
        status =
            pm_fail(err, PM_NUMERIC,
                    "Laplace extension is not positive definite (equation %td): inverted elements?",
                    column);
done:
    pm_free(value);
    return status;
}

/* Which coordinates are given, and the axes that share them: those across a symmetry plane have
 * more. */
static enum pm_status find_given(struct pm_extension *e, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = e->mesh;
    unsigned planes = 0;
    int shared = -1;
    PM_TRY(PM_NEW(e->given, m->nn, err));
    PM_TRY(PM_NEW(e->plane, m->nn, err));
    for (ptrdiff_t k = 0; k < 6 * m->nf; k++) {
        const int32_t a = m->tri[k], tag = m->tri_tag[k / 6];
        const unsigned across = tag <= PM_FACE_SYM_X ? 1u << (PM_FACE_SYM_X - tag) : 0;
        planes |= across;
        e->plane[a] = (uint8_t)(e->plane[a] | across);
        e->given[a] = (uint8_t)(e->given[a] | (across ? across : 7));
    }
    for (int i = 0; i < 3; i++) {
        const int own = (int)(planes >> i & 1);
        if (own || shared < 0) {
            if (!own)
                shared = e->nfields;
            e->field[e->nfields++].axis[0] = i;
            e->field[e->nfields - 1].naxes = 1;
        } else {
            e->field[shared].axis[e->field[shared].naxes++] = i;
        }
    }
done:
    return status;
}

enum pm_status pm_extension_new(const struct pm_mesh *m, struct pm_extension **out,
                                struct pm_err *err)
{
    enum pm_status status;
    uint8_t *use = NULL;
    ptrdiff_t most = 0;
    struct pm_extension *e = pm_calloc(1, sizeof *e, err);
    if (e == NULL)
        return PM_SYSTEM;
    e->mesh = m;
    PM_TRY(find_given(e, err));
    PM_TRY(PM_NEW(use, m->nn, err));
    for (int k = 0; k < e->nfields; k++) {
        struct field *f = &e->field[k];
        for (ptrdiff_t a = 0; a < m->nn; a++)
            use[a] = !(e->given[a] >> f->axis[0] & 1);
        PM_TRY(pm_pattern_new(
            &(struct pm_pattern_source){m->nn, m->ne, 10, m->tet, use, NULL, 1, 0, NULL},
            &f->pattern, err));
        if (f->pattern.n > 0)
            PM_TRY(factor_laplace(m, f, err));
        most = f->pattern.n > most ? f->pattern.n : most;
    }
    PM_TRY(PM_NEW(e->rhs, 3 * most, err));
    *out = e;
    e = NULL;
done:
    pm_free(use);
    pm_extension_free(e);
    return status;
}

static enum pm_status apply_field(const struct pm_extension *e, const struct field *f, double *d,
                                  struct pm_err *err)
{
    const struct pm_mesh *m = e->mesh;
    const ptrdiff_t *eq = f->pattern.eq, n = f->pattern.n;
    double K[100];
    if (n == 0)
        return PM_OK;
    memset(e->rhs, 0, (size_t)(f->naxes * n) * sizeof *e->rhs);
    for (ptrdiff_t k = 0; k < m->ne; k++) {
        const int32_t *t = m->tet + 10 * k;
        laplace_matrix(m, k, K);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10 && eq[t[a]] >= 0; b++)
                for (int i = 0; i < f->naxes && eq[t[b]] < 0; i++)
                    e->rhs[i * n + eq[t[a]]] -= K[10 * a + b] * d[3 * (ptrdiff_t)t[b] + f->axis[i]];
    }
    const enum pm_status status = pm_cholesky_solve(f->factor, e->rhs, f->naxes, err);
    for (ptrdiff_t a = 0; a < m->nn && status == PM_OK; a++)
        for (int i = 0; i < f->naxes && eq[a] >= 0; i++)
            d[3 * a + f->axis[i]] = e->rhs[i * n + eq[a]];
    return status;
}

/* Nodes of symmetry planes stay on them. */
static void clear_planes(const struct pm_extension *e, double *d)
{
    for (ptrdiff_t a = 0; a < e->mesh->nn; a++)
        for (int i = 0; i < 3; i++)
            if (e->plane[a] >> i & 1)
                d[3 * a + i] = 0;
}

enum pm_status pm_extension_apply(struct pm_extension *e, double *d, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    clear_planes(e, d);
    for (int k = 0; k < e->nfields; k++)
        PM_TRY(apply_field(e, &e->field[k], d, err));
done:
    return status;
}

static enum pm_status transpose_field(const struct pm_extension *e, const struct field *f,
                                      double *D, struct pm_err *err)
{
    const struct pm_mesh *m = e->mesh;
    const ptrdiff_t *eq = f->pattern.eq, n = f->pattern.n;
    double K[100];
    if (n == 0)
        return PM_OK;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < f->naxes && eq[a] >= 0; i++) {
            e->rhs[i * n + eq[a]] = D[3 * a + f->axis[i]];
            D[3 * a + f->axis[i]] = 0.0;
        }
    const enum pm_status status = pm_cholesky_solve(f->factor, e->rhs, f->naxes, err);
    for (ptrdiff_t k = 0; k < m->ne && status == PM_OK; k++) {
        const int32_t *t = m->tet + 10 * k;
        laplace_matrix(m, k, K);
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10 && eq[t[a]] < 0; b++)
                for (int i = 0; i < f->naxes && eq[t[b]] >= 0; i++)
                    D[3 * (ptrdiff_t)t[a] + f->axis[i]] -= K[10 * a + b] * e->rhs[i * n + eq[t[b]]];
    }
    return status;
}

enum pm_status pm_extension_transpose(struct pm_extension *e, double *D, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (int k = 0; k < e->nfields; k++)
        PM_TRY(transpose_field(e, &e->field[k], D, err));
    clear_planes(e, D);
done:
    return status;
}

void pm_extension_free(struct pm_extension *e)
{
    if (e == NULL)
        return;
    for (int k = 0; k < e->nfields; k++) {
        pm_cholesky_free(e->field[k].factor);
        pm_pattern_release(&e->field[k].pattern);
    }
    pm_free(e->given);
    pm_free(e->plane);
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
