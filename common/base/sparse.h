/* Sparse symmetric positive definite systems: the only user of cholmod.h and metis.h. */
#ifndef PM_SPARSE_H
#define PM_SPARSE_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

/* Threads of the dense kernels in factorisations (1 at the start of every tool). */
void pm_threads_set(int n);

struct pm_cholesky; /* symbolic analysis and factor of one sparsity pattern */

/* Nested dissection (METIS) of a graph of n nodes given by its adjacency lists without self loops:
 * perm[k] = node eliminated at place k. Deterministic. */
enum pm_status pm_order_nodes(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *adj,
                              ptrdiff_t *perm, struct pm_err *err);

/* Lower triangle, compressed columns (ptr: n + 1, row: ascending; entries above the diagonal are
 * ignored), already numbered in elimination order. Supernodal LL'. */
enum pm_status pm_cholesky_new(ptrdiff_t n, const ptrdiff_t *ptr, const ptrdiff_t *row,
                               struct pm_cholesky **c, struct pm_err *err);
/* Factors the values (same order as row); *definite = 0 where the matrix is not positive definite,
 * then *column is the column at which it was seen. That is a result, not an error. */
enum pm_status pm_cholesky_factor(struct pm_cholesky *c, const double *value, int *definite,
                                  ptrdiff_t *column, struct pm_err *err);
/* x (n x nrhs, column after column) is replaced by A^-1 x. */
enum pm_status pm_cholesky_solve(struct pm_cholesky *c, double *x, ptrdiff_t nrhs,
                                 struct pm_err *err);
/* Entries of the factor and floating point operations of a factorisation. */
void pm_cholesky_size(const struct pm_cholesky *c, double *entries, double *flops);
void pm_cholesky_free(struct pm_cholesky *c);

#endif
