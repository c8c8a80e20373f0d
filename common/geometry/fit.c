#include "common/geometry/fit.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/base/sparse.h"
#include "common/files/record.h"

/* C (nq x n) by rows and by columns, and the lower triangle of C^T W C + alpha I in elimination
 * order. */
struct pm_fitter {
    ptrdiff_t nq, n;
    double alpha;
    double *weight;        /* scaled to the sum n (nq) */
    uint8_t *fixed;        /* (n x 3) or NULL */
    ptrdiff_t *ptr, *tptr; /* (nq + 1), (n + 1) */
    int32_t *col, *trow;   /* control points of a row, rows of a control point */
    double *c, *tc;
    ptrdiff_t *adj_ptr, *adj; /* control points that share a sample, ascending, self left out */
    ptrdiff_t *perm, *place;  /* perm[k]: control point eliminated at k; place: its inverse */
    ptrdiff_t *lptr, *lrow;
    double *value;
    struct pm_cholesky *factor[3]; /* of the coordinates, */
    int same[3];                   /* where these, the least, have the same */
    double *res, *rhs;             /* scratch (nq x 3), (n x 3) */
};

void pm_fitter_free(struct pm_fitter *y)
{
    if (y == NULL)
        return;
    void *all[] = {y->weight, y->fixed, y->ptr,     y->tptr, y->col,  y->trow,
                   y->c,      y->tc,    y->adj_ptr, y->adj,  y->perm, y->place,
                   y->lptr,   y->lrow,  y->value,   y->res,  y->rhs,  y};

    for (int axis = 0; axis < 3; axis++)
        pm_cholesky_free(y->factor[axis]);
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        pm_free(all[k]);
}

/* Rows of weights of all samples, order 0, and their transpose. */
static enum pm_status gather(struct pm_fitter *y, const struct pm_map *map, const double *S,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis b = {0};
    ptrdiff_t nq = y->nq, nw = 0, k;

    PM_TRY(PM_NEW(y->ptr, nq + 1, err));
    PM_TRY(PM_NEW(y->tptr, y->n + 2, err));
    for (ptrdiff_t q = 0; q < nq; q++) { /* sizes first */
        PM_TRY(pm_map_basis(map, &S[3 * q], 0, &b, err));
        y->ptr[q + 1] = nw += b.n;
    }
    PM_TRY(PM_NEW(y->col, nw, err));
    PM_TRY(PM_NEW(y->trow, nw, err));
    PM_TRY(PM_NEW(y->c, nw, err));
    PM_TRY(PM_NEW(y->tc, nw, err));
    for (ptrdiff_t q = 0; q < nq; q++) {
        PM_TRY(pm_map_basis(map, &S[3 * q], 0, &b, err));
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
static ptrdiff_t neighbours(const struct pm_fitter *y, ptrdiff_t m, ptrdiff_t *mark,
                            ptrdiff_t *list)
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
static enum pm_status lower_triangle(struct pm_fitter *y, ptrdiff_t *next, struct pm_err *err)
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
done:
    return status;
}

static enum pm_status analyse(struct pm_fitter *y, struct pm_err *err)
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

static int is_fixed(const struct pm_fitter *y, ptrdiff_t m, int axis)
{
    return y->fixed != NULL && y->fixed[3 * m + axis];
}

/* Factors the system of one coordinate; a fixed control point has a unit row. */
static enum pm_status factor(struct pm_fitter *y, int axis, struct pm_err *err)
{
    enum pm_status status;
    double *sum = y->rhs;
    ptrdiff_t column;
    int definite;

    for (ptrdiff_t k = 0; k < y->n; k++) {
        ptrdiff_t m = y->perm[k];
        for (ptrdiff_t e = y->lptr[k]; e < y->lptr[k + 1]; e++)
            sum[y->lrow[e]] = 0;
        for (ptrdiff_t t = y->tptr[m]; t < y->tptr[m + 1]; t++) {
            ptrdiff_t q = y->trow[t];
            double w = y->weight[q] * y->tc[t];
            for (ptrdiff_t e = y->ptr[q]; e < y->ptr[q + 1]; e++)
                sum[y->place[y->col[e]]] += w * y->c[e];
        }
        for (ptrdiff_t e = y->lptr[k]; e < y->lptr[k + 1]; e++) {
            ptrdiff_t j = y->lrow[e];
            int off = is_fixed(y, m, axis) || is_fixed(y, y->perm[j], axis);
            y->value[e] = j == k ? (off ? 1 : sum[j] + y->alpha) : off ? 0 : sum[j];
        }
    }
    PM_TRY(pm_cholesky_new(y->n, y->lptr, y->lrow, &y->factor[axis], err));
    PM_TRY(pm_cholesky_factor(y->factor[axis], y->value, &definite, &column, err));
    if (!definite)
        status =
            pm_fail(err, PM_NUMERIC, "fit is singular at control point %td: alpha %g is too small",
                    y->perm[column], y->alpha);
done:
    return status;
}

/* The least coordinate with the same fixed control points. */
static int same_as(const struct pm_fitter *y, int axis)
{
    for (int other = 0; other < axis; other++) {
        ptrdiff_t m = 0;
        while (m < y->n && is_fixed(y, m, axis) == is_fixed(y, m, other))
            m++;
        if (m == y->n)
            return other;
    }
    return axis;
}

enum pm_status pm_fitter_new(const struct pm_map *map, ptrdiff_t n, const struct pm_fit *fit,
                             struct pm_fitter **fitter, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_fitter *y = NULL;
    double total = 0;

    *fitter = NULL;
    PM_TRY(PM_NEW(y, 1, err));
    y->n = n;
    y->nq = fit->nq;
    y->alpha = fit->alpha;
    PM_TRY(pm_copy_array(&y->weight, fit->weight, y->nq, sizeof *y->weight, err));
    if (fit->fixed != NULL)
        PM_TRY(pm_copy_array(&y->fixed, fit->fixed, 3 * n, sizeof *y->fixed, err));
    for (ptrdiff_t q = 0; q < y->nq; q++)
        total += y->weight[q];
    for (ptrdiff_t q = 0; q < y->nq; q++)
        y->weight[q] *= (double)n / total;
    PM_TRY(PM_NEW(y->res, 3 * y->nq, err));
    PM_TRY(PM_NEW(y->rhs, 3 * n, err));
    PM_TRY(gather(y, map, fit->S, err));
    PM_TRY(analyse(y, err));
    for (int axis = 0; axis < 3; axis++)
        if ((y->same[axis] = same_as(y, axis)) == axis)
            PM_TRY(factor(y, axis, err));
    *fitter = y;
    y = NULL;
done:
    pm_fitter_free(y);
    return status;
}

/* target - C psi. */
static void residual(const struct pm_fitter *y, const double *target, const double *psi)
{
    for (ptrdiff_t q = 0; q < y->nq; q++) {
        double r[3] = {target[3 * q], target[3 * q + 1], target[3 * q + 2]};
        for (ptrdiff_t e = y->ptr[q]; e < y->ptr[q + 1]; e++)
            for (int j = 0; j < 3; j++)
                r[j] -= y->c[e] * psi[3 * (ptrdiff_t)y->col[e] + j];
        memcpy(&y->res[3 * q], r, sizeof r);
    }
}

/* One sweep: psi += (C^T W C + alpha)^-1 C^T W (target - C psi). */
static enum pm_status sweep(const struct pm_fitter *y, const double *target, double *psi,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;

    residual(y, target, psi);
    for (ptrdiff_t k = 0; k < y->n; k++) { /* coordinate after coordinate */
        ptrdiff_t m = y->perm[k];
        double sum[3] = {0};
        for (ptrdiff_t t = y->tptr[m]; t < y->tptr[m + 1]; t++) {
            const double w = y->weight[y->trow[t]] * y->tc[t];
            for (int j = 0; j < 3; j++)
                sum[j] += w * y->res[3 * (ptrdiff_t)y->trow[t] + j];
        }
        for (int j = 0; j < 3; j++)
            y->rhs[j * y->n + k] = is_fixed(y, m, j) ? 0 : sum[j];
    }
    for (int axis = 0, next; axis < 3; axis = next) {
        for (next = axis + 1; next < 3 && y->same[next] == y->same[axis];)
            next++;
        PM_TRY(pm_cholesky_solve(y->factor[y->same[axis]], &y->rhs[axis * y->n], next - axis, err));
    }
    for (ptrdiff_t k = 0; k < y->n; k++)
        for (int j = 0; j < 3; j++)
            psi[3 * y->perm[k] + j] += y->rhs[j * y->n + k];
done:
    return status;
}

enum pm_status pm_fitter_solve(struct pm_fitter *fitter, const double *target, int iterations,
                               double *psi, double error[2], struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double sum = 0, largest = 0;

    for (int it = 0; it < iterations; it++)
        PM_TRY(sweep(fitter, target, psi, err));
    residual(fitter, target, psi);
    for (ptrdiff_t q = 0; q < fitter->nq; q++) {
        const double *r = &fitter->res[3 * q], square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        sum += square;
        largest = fmax(largest, square);
    }
    error[0] = sqrt(sum / fmax(1, (double)fitter->nq));
    error[1] = sqrt(largest);
done:
    return status;
}

enum pm_status pm_fit_points(const struct pm_map *map, ptrdiff_t n, const struct pm_fit *fit,
                             double *psi, double error[2], struct pm_err *err)
{
    struct pm_fitter *y = NULL;
    enum pm_status status = pm_fitter_new(map, n, fit, &y, err);

    if (status == PM_OK)
        status = pm_fitter_solve(y, fit->target, fit->iterations, psi, error, err);
    pm_fitter_free(y);
    return status;
}
