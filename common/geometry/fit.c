#include "common/geometry/fit.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/base/sparse.h"

/* C (nq x n) by rows and by columns, and the lower triangle of C^T W C + alpha I in elimination
 * order. */
struct system {
    const struct pm_fit *fit;
    ptrdiff_t n;
    double scale;          /* of the weights */
    ptrdiff_t *ptr, *tptr; /* (nq + 1), (n + 1) */
    int32_t *col, *trow;   /* control points of a row, rows of a control point */
    double *c, *tc;
    ptrdiff_t *adj_ptr, *adj; /* control points that share a sample, ascending, self left out */
    ptrdiff_t *perm, *place;  /* perm[k]: control point eliminated at k; place: its inverse */
    ptrdiff_t *lptr, *lrow;
    double *value;
    struct pm_cholesky *factor;
};

static void release(struct system *y)
{
    void *all[] = {y->ptr, y->tptr, y->col,   y->trow, y->c,    y->tc,   y->adj_ptr,
                   y->adj, y->perm, y->place, y->lptr, y->lrow, y->value};

    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        pm_free(all[k]);
    pm_cholesky_free(y->factor);
}

/* Rows of weights of all samples, order 0, and their transpose. */
static enum pm_status gather(struct system *y, const struct pm_map *map, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis b = {0};
    ptrdiff_t nq = y->fit->nq, nw = 0, k;

    PM_TRY(PM_NEW(y->ptr, nq + 1, err));
    PM_TRY(PM_NEW(y->tptr, y->n + 2, err));
    for (ptrdiff_t q = 0; q < nq; q++) { /* sizes first */
        PM_TRY(pm_map_basis(map, &y->fit->S[3 * q], 0, &b, err));
        y->ptr[q + 1] = nw += b.n;
    }
    PM_TRY(PM_NEW(y->col, nw, err));
    PM_TRY(PM_NEW(y->trow, nw, err));
    PM_TRY(PM_NEW(y->c, nw, err));
    PM_TRY(PM_NEW(y->tc, nw, err));
    for (ptrdiff_t q = 0; q < nq; q++) {
        PM_TRY(pm_map_basis(map, &y->fit->S[3 * q], 0, &b, err));
        memcpy(&y->col[y->ptr[q]], b.id, (size_t)b.n * sizeof *b.id);
        memcpy(&y->c[y->ptr[q]], b.c, (size_t)b.n * sizeof *b.c);
    }
    for (k = 0; k < nw; k++)
        y->tptr[y->col[k] + 2]++;
    for (k = 0; k < y->n; k++)
        y->tptr[k + 2] += y->tptr[k + 1];
    for (ptrdiff_t q = 0; q < nq; q++)
        for (k = y->ptr[q]; k < y->ptr[q + 1]; k++) {
            ptrdiff_t to = y->tptr[y->col[k] + 1]++;
            y->trow[to] = (int32_t)q;
            y->tc[to] = y->c[k];
        }
done:
    pm_basis_release(&b);
    return status;
}

/* Marks the neighbours of control point m in mark (= m + 1) and lists them unless list is NULL. */
static ptrdiff_t neighbours(const struct system *y, ptrdiff_t m, ptrdiff_t *mark, ptrdiff_t *list)
{
    ptrdiff_t n = 0;

    mark[m] = m + 1;
    for (ptrdiff_t t = y->tptr[m]; t < y->tptr[m + 1]; t++)
        for (ptrdiff_t k = y->ptr[y->trow[t]]; k < y->ptr[y->trow[t] + 1]; k++) {
            ptrdiff_t j = y->col[k];
            if (mark[j] == m + 1)
                continue;
            mark[j] = m + 1;
            if (list != NULL)
                list[n] = j;
            n++;
        }
    return n;
}

/* Column j = place of a control point: its diagonal, then the later places in ascending order. */
static enum pm_status lower_triangle(struct system *y, ptrdiff_t *next, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t n = y->n;

    PM_TRY(PM_NEW(y->lptr, n + 1, err));
    PM_TRY(PM_NEW(y->lrow, n + y->adj_ptr[n] / 2, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        y->lptr[k + 1] = y->lptr[k] + 1;
        for (ptrdiff_t t = y->adj_ptr[y->perm[k]]; t < y->adj_ptr[y->perm[k] + 1]; t++)
            y->lptr[k + 1] += y->place[y->adj[t]] > k;
        next[k] = y->lptr[k];
    }
    for (ptrdiff_t k = 0; k < n; k++) {
        y->lrow[next[k]++] = k;
        for (ptrdiff_t t = y->adj_ptr[y->perm[k]]; t < y->adj_ptr[y->perm[k] + 1]; t++)
            if (y->place[y->adj[t]] < k)
                y->lrow[next[y->place[y->adj[t]]]++] = k;
    }
    PM_TRY(PM_NEW(y->value, y->lptr[n], err));
    PM_TRY(pm_cholesky_new(n, y->lptr, y->lrow, &y->factor, err));
done:
    return status;
}

static enum pm_status analyse(struct system *y, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *mark = NULL, n = y->n;

    PM_TRY(PM_NEW(mark, n, err));
    PM_TRY(PM_NEW(y->adj_ptr, n + 1, err));
    for (ptrdiff_t m = 0; m < n; m++)
        y->adj_ptr[m + 1] = y->adj_ptr[m] + neighbours(y, m, mark, NULL);
    PM_TRY(PM_NEW(y->adj, y->adj_ptr[n], err));
    memset(mark, 0, (size_t)n * sizeof *mark);
    for (ptrdiff_t m = 0; m < n; m++)
        neighbours(y, m, mark, &y->adj[y->adj_ptr[m]]);
    PM_TRY(PM_NEW(y->perm, n, err));
    PM_TRY(PM_NEW(y->place, n, err));
    PM_TRY(pm_order_nodes(n, y->adj_ptr, y->adj, y->perm, err));
    for (ptrdiff_t k = 0; k < n; k++)
        y->place[y->perm[k]] = k;
    PM_TRY(lower_triangle(y, mark, err));
done:
    pm_free(mark);
    return status;
}

static int is_fixed(const struct system *y, ptrdiff_t m, int axis)
{
    return y->fit->fixed != NULL && y->fit->fixed[3 * m + axis];
}

/* Factors the system of one coordinate; a fixed control point has a unit row. */
static enum pm_status factor(struct system *y, int axis, double *sum, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t column;
    int definite;

    for (ptrdiff_t k = 0; k < y->n; k++) {
        ptrdiff_t m = y->perm[k];
        for (ptrdiff_t e = y->lptr[k]; e < y->lptr[k + 1]; e++)
            sum[y->lrow[e]] = 0;
        for (ptrdiff_t t = y->tptr[m]; t < y->tptr[m + 1]; t++) {
            ptrdiff_t q = y->trow[t];
            double w = y->scale * y->fit->weight[q] * y->tc[t];
            for (ptrdiff_t e = y->ptr[q]; e < y->ptr[q + 1]; e++)
                sum[y->place[y->col[e]]] += w * y->c[e];
        }
        for (ptrdiff_t e = y->lptr[k]; e < y->lptr[k + 1]; e++) {
            ptrdiff_t j = y->lrow[e];
            int off = is_fixed(y, m, axis) || is_fixed(y, y->perm[j], axis);
            y->value[e] = j == k ? (off ? 1 : sum[j] + y->fit->alpha) : off ? 0 : sum[j];
        }
    }
    status = pm_cholesky_factor(y->factor, y->value, &definite, &column, err);
    if (status == PM_OK && !definite)
        status =
            pm_fail(err, PM_NUMERIC, "fit is singular at control point %td: alpha %g is too small",
                    y->perm[column], y->fit->alpha);
    return status;
}

/* target - C psi of one coordinate (nq). */
static void residual(const struct system *y, int axis, const double *psi, double *res)
{
    for (ptrdiff_t q = 0; q < y->fit->nq; q++) {
        res[q] = y->fit->target[3 * q + axis];
        for (ptrdiff_t e = y->ptr[q]; e < y->ptr[q + 1]; e++)
            res[q] -= y->c[e] * psi[3 * (ptrdiff_t)y->col[e] + axis];
    }
}

/* One sweep: psi += (C^T W C + alpha)^-1 C^T W (target - C psi). */
static enum pm_status sweep(struct system *y, int axis, double *psi, double *res, double *rhs,
                            struct pm_err *err)
{
    enum pm_status status;

    residual(y, axis, psi, res);
    for (ptrdiff_t k = 0; k < y->n; k++) {
        ptrdiff_t m = y->perm[k];
        rhs[k] = 0;
        for (ptrdiff_t t = y->tptr[m]; !is_fixed(y, m, axis) && t < y->tptr[m + 1]; t++)
            rhs[k] += y->scale * y->fit->weight[y->trow[t]] * y->tc[t] * res[y->trow[t]];
    }
    status = pm_cholesky_solve(y->factor, rhs, 1, err);
    for (ptrdiff_t k = 0; status == PM_OK && k < y->n; k++)
        psi[3 * y->perm[k] + axis] += rhs[k];
    return status;
}

static void measure(const struct system *y, const double *psi, double *res, double *square,
                    double error[2])
{
    double sum = 0, largest = 0;

    memset(square, 0, (size_t)y->fit->nq * sizeof *square);
    for (int axis = 0; axis < 3; axis++) {
        residual(y, axis, psi, res);
        for (ptrdiff_t q = 0; q < y->fit->nq; q++)
            square[q] += res[q] * res[q];
    }
    for (ptrdiff_t q = 0; q < y->fit->nq; q++) {
        sum += square[q];
        largest = fmax(largest, square[q]);
    }
    error[0] = sqrt(sum / fmax(1, (double)y->fit->nq));
    error[1] = sqrt(largest);
}

enum pm_status pm_fit_points(const struct pm_map *map, ptrdiff_t n, const struct pm_fit *fit,
                             double *psi, double error[2], struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct system y = {.fit = fit, .n = n};
    double *sum = NULL, *res = NULL, *square = NULL, total = 0;

    for (ptrdiff_t q = 0; q < fit->nq; q++)
        total += fit->weight[q];
    y.scale = (double)n / total;
    PM_TRY(PM_NEW(sum, n, err));
    PM_TRY(PM_NEW(res, fit->nq, err));
    PM_TRY(PM_NEW(square, fit->nq, err));
    PM_TRY(gather(&y, map, err));
    PM_TRY(analyse(&y, err));
    for (int axis = 0; axis < 3; axis++) {
        if (axis == 0 || fit->fixed != NULL)
            PM_TRY(factor(&y, axis, sum, err));
        for (int it = 0; it < fit->iterations; it++)
            PM_TRY(sweep(&y, axis, psi, res, sum, err));
    }
    measure(&y, psi, res, square, error);
done:
    release(&y);
    pm_free(sum);
    pm_free(res);
    pm_free(square);
    return status;
}
