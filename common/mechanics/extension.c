#include "common/mechanics/extension.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/pattern.h"
#include "common/base/sparse.h"
#include "common/mechanics/tet10.h"

/* One system: axes with the same unknown nodes, one by one (Laplace), or all three coupled
 * (elasticity). */
struct field {
    struct pm_pattern pattern; /* bs = 1, or 3 */
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

/* lambda/G of the elastic extension: Poisson's ratio 0.3. */
static const double LAMBDA = 1.5;

enum { MOST = 900 };

/* Element matrix on the generated mesh: Laplace (10 x 10), or isotropic elasticity with the shear
 * modulus G = 1/volume (30 x 30), so that small elements are stiff. */
static void element_matrix(const struct pm_mesh *m, const struct field *f, ptrdiff_t e, double *K)
{
    double X[30], dN[PM_TET_POINTS][30], w[PM_TET_POINTS], volume = 0;
    const int bs = (int)f->pattern.bs;
    for (int a = 0; a < 10; a++)
        memcpy(X + 3 * a, m->x_generated + 3 * (ptrdiff_t)m->tet[10 * e + a], 3 * sizeof *X);
    memset(K, 0, (size_t)(100 * bs * bs) * sizeof *K);
    for (int q = 0; q < PM_TET_POINTS; q++) {
        w[q] = pm_tet_weight[q] * pm_tet10_gradient(X, pm_tet_xi[q], dN[q]);
        volume += w[q];
    }
    for (int q = 0; q < PM_TET_POINTS; q++)
        for (int a = 0; a < 10; a++)
            for (int b = 0; b < 10; b++) {
                const double *g = dN[q] + 3 * a, *h = dN[q] + 3 * b;
                const double gh = w[q] * (g[0] * h[0] + g[1] * h[1] + g[2] * h[2]);
                if (bs == 1)
                    K[10 * a + b] += gh;
                for (int k = 0; k < 9 && bs == 3; k++) {
                    const int i = k / 3, j = k % 3;
                    K[30 * (3 * a + i) + 3 * b + j] +=
                        ((i == j ? gh : 0) + w[q] * (LAMBDA * g[i] * h[j] + g[j] * h[i])) / volume;
                }
            }
}

/* Its entry for components i and j of nodes a and b. */
static double entry(const struct field *f, const double *K, int a, int i, int b, int j)
{
    return f->pattern.bs == 1 ? K[10 * a + b] : K[30 * (3 * a + i) + 3 * b + j];
}

static enum pm_status factor_field(const struct pm_extension *e, struct field *f,
                                   struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = e->mesh;
    const struct pm_pattern *p = &f->pattern;
    const int bs = (int)p->bs;
    double *value = NULL, K[MOST];
    PM_TRY(PM_NEW(value, p->ptr[p->n], err));
    for (ptrdiff_t k = 0; k < m->ne; k++) {
        const int32_t *t = m->tet + 10 * k;
        element_matrix(m, f, k, K);
        for (int ab = 0; ab < 100 * bs * bs; ab++) {
            const int a = ab / (10 * bs) / bs, d = ab / (10 * bs) % bs, b = ab % (10 * bs) / bs,
                      c = ab % bs;
            const ptrdiff_t i = p->eq[t[a]], j = p->eq[t[b]];
            if (i < 0 || j < 0 || i < j ||
                (bs == 3 && ((e->given[t[a]] >> d & 1) || (e->given[t[b]] >> c & 1))))
                continue;
            value[pm_pattern_block(p, i, j, c) + d] += K[ab];
        }
    }
    for (ptrdiff_t a = 0; a < m->nn && bs == 3; a++) /* given components of free nodes */
        for (int d = 0; d < 3 && p->eq[a] >= 0; d++)
            if (e->given[a] >> d & 1)
                value[pm_pattern_block(p, p->eq[a], p->eq[a], d) + d] = 1;
    int definite;
    ptrdiff_t column;
    PM_TRY(pm_cholesky_new(p->n, p->ptr, p->row, &f->factor, err));
    PM_TRY(pm_cholesky_factor(f->factor, value, &definite, &column, err));
    if (!definite)
        status = pm_fail(err, PM_NUMERIC,
                         "the extension to interior nodes is not positive definite (equation %td): "
                         "inverted elements?",
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
    if (m->pcase.extension == PM_EXTENSION_ELASTICITY) {
        e->field[e->nfields++] = (struct field){.naxes = 3, .axis = {0, 1, 2}};
        planes = 0;
    }
    for (int i = 0; i < 3 && m->pcase.extension == PM_EXTENSION_LAPLACE; i++) {
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
        const int elastic = m->pcase.extension == PM_EXTENSION_ELASTICITY;
        const unsigned all = elastic ? 7u : 1u << f->axis[0];
        for (ptrdiff_t a = 0; a < m->nn; a++)
            use[a] = (e->given[a] & all) != all;
        PM_TRY(pm_pattern_new(&(struct pm_pattern_source){m->nn, m->ne, 10, m->tet, use, NULL,
                                                          elastic ? 3 : 1, 0, NULL},
                              &f->pattern, err));
        if (f->pattern.n > 0)
            PM_TRY(factor_field(e, f, err));
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

/* Place of component `axis` (the k-th of the field) of node a in the right-hand sides, -1 where it
 * is given. */
static ptrdiff_t place(const struct pm_extension *e, const struct field *f, ptrdiff_t a, int k)
{
    const struct pm_pattern *p = &f->pattern;
    if (e->given[a] >> f->axis[k] & 1)
        return -1;
    return p->bs == 1 ? k * p->n + p->eq[a] : 3 * p->eq[a] + f->axis[k];
}

static enum pm_status solve(const struct pm_extension *e, const struct field *f, struct pm_err *err)
{
    return pm_cholesky_solve(f->factor, e->rhs, f->pattern.bs == 1 ? f->naxes : 1, err);
}

/* How a pair of components of an element adds: given ones to the right-hand side, or solved ones to
 * the given (transposed). */
static void couple(const struct pm_extension *e, const struct field *f, double *d, int transposed)
{
    const struct pm_mesh *m = e->mesh;
    double K[MOST];
    for (ptrdiff_t t = 0; t < m->ne; t++) {
        const int32_t *node = m->tet + 10 * t;
        element_matrix(m, f, t, K);
        for (int a = 0; a < 10; a++)
            for (int i = 0; i < f->naxes; i++) {
                const ptrdiff_t to = place(e, f, node[a], i);
                for (int b = 0; b < 10 && to >= 0; b++)
                    for (int j = 0; j < f->naxes; j++) {
                        double *given = d + 3 * (ptrdiff_t)node[b] + f->axis[j];
                        if ((f->pattern.bs == 1 && i != j) || place(e, f, node[b], j) >= 0)
                            continue;
                        const double k = entry(f, K, a, f->axis[i], b, f->axis[j]);
                        if (transposed)
                            *given -= k * e->rhs[to];
                        else
                            e->rhs[to] -= k * *given;
                    }
            }
    }
}

static enum pm_status apply_field(const struct pm_extension *e, const struct field *f, double *d,
                                  struct pm_err *err)
{
    const struct pm_mesh *m = e->mesh;
    if (f->pattern.n == 0)
        return PM_OK;
    memset(e->rhs, 0, (size_t)(3 * f->pattern.n) * sizeof *e->rhs);
    couple(e, f, d, 0);
    const enum pm_status status = solve(e, f, err);
    for (ptrdiff_t a = 0; a < m->nn && status == PM_OK; a++)
        for (int i = 0; i < f->naxes; i++) {
            const ptrdiff_t at = place(e, f, a, i);
            if (at >= 0)
                d[3 * a + f->axis[i]] = e->rhs[at];
        }
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
    if (f->pattern.n == 0)
        return PM_OK;
    memset(e->rhs, 0, (size_t)(3 * f->pattern.n) * sizeof *e->rhs);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < f->naxes; i++) {
            const ptrdiff_t at = place(e, f, a, i);
            if (at < 0)
                continue;
            e->rhs[at] = D[3 * a + f->axis[i]];
            D[3 * a + f->axis[i]] = 0;
        }
    const enum pm_status status = solve(e, f, err);
    if (status == PM_OK)
        couple(e, f, D, 1);
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
