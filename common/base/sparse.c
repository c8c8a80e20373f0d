#include "common/base/sparse.h"

#include <cblas.h>
#include <cholmod.h>
#include <metis.h>

#include <string.h>

#include "common/base/memory.h"

void pm_threads_set(int n)
{
    openblas_set_num_threads(n);
}

struct pm_cholesky {
    cholmod_common common;
    cholmod_sparse matrix; /* borrowed pattern, values set per factorisation */
    cholmod_factor *factor;
    double entries, flops;
    cholmod_dense *x, *y, *e; /* workspaces of cholmod_l_solve2 */
};

/* The indices stay ours and are only read, but cholmod has no const. */
static void *borrow(const void *p)
{
    union {
        const void *c;
        void *m;
    } u = {.c = p};
    return u.m;
}

/* The pattern in compressed columns; what lies above the diagonal does not count. */
static cholmod_sparse lower_triangle(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *row)
{
    return (cholmod_sparse){.nrow = (size_t)n,
                            .ncol = (size_t)n,
                            .nzmax = (size_t)ptr[n],
                            .p = borrow(ptr),
                            .i = borrow(row),
                            .stype = -1,
                            .itype = CHOLMOD_LONG,
                            .xtype = CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

/* perm followed by a postorder of its elimination tree: children before parents, subtrees together,
 * as supernodes want them. */
static enum pm_status postorder(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *adj,
                                ptrdiff_t *perm, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    cholmod_common cm;
    cholmod_factor *tree;
    cholmod_l_start(&cm);
    cm.print = 0;
    cm.supernodal = CHOLMOD_SIMPLICIAL;
    cm.nmethods = 1;
    cm.method[0].ordering = CHOLMOD_GIVEN;
    cm.postorder = 1;
    cholmod_sparse graph = lower_triangle(n, ptr, adj);
    tree = cholmod_l_analyze_p(&graph, perm, NULL, 0, &cm);
    if (tree == NULL)
        status = pm_fail(err, PM_SYSTEM, "CHOLMOD cannot order a graph of %td nodes (status %d)", n,
                         cm.status);
    else
        memcpy(perm, tree->Perm, (size_t)n * sizeof *perm);
    cholmod_l_free_factor(&tree, &cm);
    cholmod_l_finish(&cm);
    return status;
}

enum pm_status pm_order_nodes(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *adj,
                              ptrdiff_t *perm, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    idx_t *xadj = NULL, *list = NULL, *p = NULL, *ip = NULL;
    if (n == 0)
        return PM_OK;
    PM_TRY(PM_NEW(xadj, n + 1, err));
    PM_TRY(PM_NEW(list, ptr[n] > 0 ? ptr[n] : 1, err));
    PM_TRY(PM_NEW(p, n, err));
    PM_TRY(PM_NEW(ip, n, err));
    for (ptrdiff_t i = 0; i <= n; i++)
        xadj[i] = (idx_t)ptr[i];
    for (ptrdiff_t i = 0; i < ptr[n]; i++)
        list[i] = (idx_t)adj[i];
    idx_t count = (idx_t)n, options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    if (METIS_NodeND(&count, xadj, list, NULL, options, p, ip) != METIS_OK) {
        status = pm_fail(err, PM_SYSTEM, "METIS cannot order a graph of %td nodes", n);
        goto done;
    }
    for (ptrdiff_t i = 0; i < n; i++)
        perm[i] = p[i];
    PM_TRY(postorder(n, ptr, adj, perm, err));
done:
    pm_free(xadj);
    pm_free(list);
    pm_free(p);
    pm_free(ip);
    return status;
}

enum pm_status pm_cholesky_new(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *row,
                               struct pm_cholesky **out, struct pm_err *err)
{
    struct pm_cholesky *c = pm_calloc(1, sizeof *c, err);
    if (c == NULL)
        return PM_SYSTEM;
    cholmod_common *cm = &c->common;
    cholmod_l_start(cm);
    cm->print = 0;
    cm->quick_return_if_not_posdef = 1;
    cm->supernodal = CHOLMOD_SUPERNODAL;
    cm->final_ll = 1;
    cm->nmethods = 1;
    cm->method[0].ordering = CHOLMOD_NATURAL;
    cm->postorder = 0; /* it is one: no copy of the matrix at each factorisation */
    c->matrix = lower_triangle(n, ptr, row);
    c->factor = cholmod_l_analyze(&c->matrix, cm);
    if (c->factor == NULL || cm->status < CHOLMOD_OK) {
        enum pm_status status =
            pm_fail(err, PM_SYSTEM, "CHOLMOD cannot analyse a matrix of order %td (status %d)", n,
                    cm->status);
        pm_cholesky_free(c);
        return status;
    }
    c->entries = cm->lnz;
    c->flops = cm->fl;
    *out = c;
    return PM_OK;
}

enum pm_status pm_cholesky_factor(struct pm_cholesky *c, const double *value, int *definite,
                                  ptrdiff_t *column, struct pm_err *err)
{
    cholmod_common *cm = &c->common;
    c->matrix.x = borrow(value);
    c->matrix.xtype = CHOLMOD_REAL;
    cholmod_l_factorize(&c->matrix, c->factor, cm);
    if (cm->status < CHOLMOD_OK)
        return pm_fail(err, PM_SYSTEM, "CHOLMOD cannot factor a matrix of order %zu (status %d)",
                       c->matrix.nrow, cm->status);
    /* the return value stays true for an indefinite matrix: only minor tells */
    *definite = c->factor->minor == c->factor->n && cm->status != CHOLMOD_NOT_POSDEF;
    if (column != NULL)
        *column = *definite ? -1 : (ptrdiff_t)c->factor->minor;
    return PM_OK;
}

enum pm_status pm_cholesky_solve(struct pm_cholesky *c, double *x, ptrdiff_t nrhs,
                                 struct pm_err *err)
{
    cholmod_common *cm = &c->common;
    size_t n = c->matrix.nrow;
    cholmod_dense b = {.nrow = n,
                       .ncol = (size_t)nrhs,
                       .nzmax = n * (size_t)nrhs,
                       .d = n,
                       .x = x,
                       .xtype = CHOLMOD_REAL,
                       .dtype = CHOLMOD_DOUBLE};
    if (!cholmod_l_solve2(CHOLMOD_A, c->factor, &b, NULL, &c->x, NULL, &c->y, &c->e, cm))
        return pm_fail(err, PM_SYSTEM, "CHOLMOD cannot solve a system of order %zu (status %d)", n,
                       cm->status);
    memcpy(x, c->x->x, n * (size_t)nrhs * sizeof *x);
    return PM_OK;
}

void pm_cholesky_size(const struct pm_cholesky *c, double *entries, double *flops)
{
    *entries = c->entries;
    *flops = c->flops;
}

void pm_cholesky_free(struct pm_cholesky *c)
{
    if (c == NULL)
        return;
    cholmod_l_free_dense(&c->x, &c->common);
    cholmod_l_free_dense(&c->y, &c->common);
    cholmod_l_free_dense(&c->e, &c->common);
    cholmod_l_free_factor(&c->factor, &c->common);
    cholmod_l_finish(&c->common);
    pm_free(c);
}
