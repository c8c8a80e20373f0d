#include "common/mechanics/krylov.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"

enum { MOST_STEPS = 64 };

/* One column with its Lanczos coefficients. */
struct column {
    double *x, *r, *p; /* solution, residual, direction (nq); borrowed */
    double rz, rr0, alpha;
    int steps, open;
    double diagonal[MOST_STEPS], off[MOST_STEPS];
};

static double dot(ptrdiff_t n, const double *a, const double *b)
{
    double s = 0.0;
    for (ptrdiff_t k = 0; k < n; k++)
        s += a[k] * b[k];
    return s;
}

/* y = K x, lower triangle by columns */
static void multiply(const struct pm_model *m, const double *x, double *y)
{
    const struct pm_pattern *p = &m->pattern;
    memset(y, 0, (size_t)p->n * sizeof *y);
    for (ptrdiff_t c = 0; c < p->n; c++) {
        double sum = 0.0, xc = x[c];
        for (ptrdiff_t k = p->ptr[c]; k < p->ptr[c + 1]; k++) {
            ptrdiff_t r = p->row[k];
            if (r < c)
                continue; /* full diagonal blocks: above the diagonal */
            double v = m->value[k];
            y[r] += v * xc;
            sum += r > c ? v * x[r] : 0.0;
        }
        y[c] += sum;
    }
}

static enum pm_status ritz(const struct column *c, struct pm_krylov_report *report,
                           struct pm_err *err)
{
    int steps = c->steps;
    double T[MOST_STEPS * MOST_STEPS] = {0}, value[MOST_STEPS];
    size_t n = (size_t)steps;
    gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(n);
    if (space == NULL)
        return pm_fail(err, PM_SYSTEM, "out of memory");
    for (int i = 0; i < steps; i++) {
        T[i * steps + i] = c->diagonal[i];
        if (i > 0)
            T[i * steps + i - 1] = T[(i - 1) * steps + i] = c->off[i];
    }
    gsl_matrix_view A = gsl_matrix_view_array(T, n, n);
    gsl_vector_view e = gsl_vector_view_array(value, n);
    gsl_eigen_symm(&A.matrix, &e.vector, space);
    gsl_eigen_symm_free(space);
    for (int i = 0; i < steps; i++) {
        report->least = fmin(report->least, value[i]);
        report->largest = fmax(report->largest, value[i]);
    }
    return PM_OK;
}

/* One step of column c with its preconditioned residual z; false: negative curvature. */
static int advance(const struct pm_model *m, struct column *c, const double *z, double *Kp)
{
    int step = c->steps++;
    double rz = dot(m->nq, c->r, z), beta = step > 0 ? rz / c->rz : 0.0, last = c->alpha;
    for (ptrdiff_t k = 0; k < m->nq; k++)
        c->p[k] = z[k] + beta * c->p[k];
    multiply(m, c->p, Kp);
    double pKp = dot(m->nq, c->p, Kp);
    c->rz = rz;
    if (!(pKp > 0.0))
        return 0;
    c->alpha = rz / pKp;
    c->diagonal[step] = 1.0 / c->alpha + (step > 0 ? beta / last : 0.0);
    c->off[step] = step > 0 ? sqrt(beta) / last : 0.0;
    for (ptrdiff_t k = 0; k < m->nq; k++) {
        c->x[k] += c->alpha * c->p[k];
        c->r[k] -= c->alpha * Kp[k];
    }
    return 1;
}

static enum pm_status iterate(struct pm_model *m, struct column *col, double *z, ptrdiff_t n,
                              double tolerance, int limit, double *Kp,
                              struct pm_krylov_report *report, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (;; report->steps++) {
        int open = 0;
        for (ptrdiff_t k = 0; k < n; k++) {
            col[k].open = dot(m->nq, col[k].r, col[k].r) > tolerance * tolerance * col[k].rr0;
            open |= col[k].open;
        }
        report->good = !open;
        if (!open || report->steps == limit)
            break;
        memcpy(z, col[0].r, (size_t)(n * m->nq) * sizeof *z); /* columns are adjacent */
        PM_TRY(pm_cholesky_solve(m->factor, z, n, err));
        for (ptrdiff_t k = 0; k < n; k++)
            if (col[k].open && !advance(m, &col[k], z + k * m->nq, Kp)) {
                report->least = -1.0;
                goto done;
            }
    }
    for (ptrdiff_t k = 0; k < n; k++)
        if (col[k].steps > 0)
            PM_TRY(ritz(&col[k], report, err));
done:
    return status;
}

enum pm_status pm_krylov_solve(struct pm_model *m, double *x, ptrdiff_t n, double tolerance,
                               int limit, struct pm_krylov_report *report, struct pm_err *err)
{
    enum pm_status status;
    struct column *col = NULL;
    double *store = NULL;
    ptrdiff_t nq = m->nq;
    *report = (struct pm_krylov_report){.least = 1.0, .largest = 1.0};
    PM_TRY(PM_NEW(col, n, err));
    PM_TRY(PM_NEW(store, (3 * n + 1) * nq, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        col[k].x = x + k * nq;
        col[k].r = store + k * nq;
        col[k].p = store + (n + k) * nq;
    }
    memcpy(store, x, (size_t)(n * nq) * sizeof *x);
    memset(x, 0, (size_t)(n * nq) * sizeof *x);
    for (ptrdiff_t k = 0; k < n; k++)
        col[k].rr0 = dot(nq, col[k].r, col[k].r);
    PM_TRY(iterate(m, col, store + 2 * n * nq, n, tolerance,
                   limit < MOST_STEPS ? limit : MOST_STEPS, store + 3 * n * nq, report, err));
done:
    pm_free(col);
    pm_free(store);
    return status;
}
