#include "common/mechanics/krylov.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tensor.h"

enum { MOST_STEPS = 200 };

/* gamma b b^T added to K and to the matrix of the factor; b NULL: not. */
struct stiffening {
    const double *b;
    double *z; /* factor^-1 b (nq) */
    double gamma, bz;
};

/* One column with its Lanczos coefficients. */
struct column {
    double *x, *r, *p; /* solution, residual, direction (nq); borrowed */
    double rz, rr0, alpha;
    int steps, open;
    double diagonal[MOST_STEPS], off[MOST_STEPS];
};

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
    enum pm_status status;
    size_t n = (size_t)steps;
    double *T = NULL, *value = NULL;
    gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(n);
    PM_TRY(PM_NEW(T, steps * steps, err));
    PM_TRY(PM_NEW(value, steps, err));
    if (space == NULL)
        PM_TRY(pm_fail(err, PM_SYSTEM, "out of memory"));
    for (int i = 0; i < steps; i++) {
        T[i * steps + i] = c->diagonal[i];
        if (i > 0)
            T[i * steps + i - 1] = T[(i - 1) * steps + i] = c->off[i];
    }
    gsl_matrix_view A = gsl_matrix_view_array(T, n, n);
    gsl_vector_view e = gsl_vector_view_array(value, n);
    gsl_eigen_symm(&A.matrix, &e.vector, space);
    for (int i = 0; i < steps; i++) {
        report->least = fmin(report->least, value[i]);
        report->largest = fmax(report->largest, value[i]);
    }
done:
    gsl_eigen_symm_free(space);
    pm_free(T);
    pm_free(value);
    return status;
}

/* One step of column c with its preconditioned residual z; false: negative curvature. */
static int advance(const struct pm_model *m, const struct stiffening *st, struct column *c,
                   const double *z, double *Kp)
{
    int step = c->steps++;
    double rz = pm_dot(m->nq, c->r, z), beta = step > 0 ? rz / c->rz : 0.0, last = c->alpha;
    for (ptrdiff_t k = 0; k < m->nq; k++)
        c->p[k] = z[k] + beta * c->p[k];
    multiply(m, c->p, Kp);
    if (st->b != NULL) {
        double s = st->gamma * pm_dot(m->nq, st->b, c->p);
        for (ptrdiff_t k = 0; k < m->nq; k++)
            Kp[k] += s * st->b[k];
    }
    double pKp = pm_dot(m->nq, c->p, Kp);
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

/* z (nq x n) = (factor + gamma b b^T)^-1 z (Sherman and Morrison) */
static enum pm_status precondition(struct pm_model *m, const struct stiffening *st, double *z,
                                   ptrdiff_t n, struct pm_err *err)
{
    enum pm_status status = pm_cholesky_solve(m->factor, z, n, err);
    for (ptrdiff_t k = 0; k < n && st->b != NULL && status == PM_OK; k++) {
        double *x = z + k * m->nq,
               s = st->gamma * pm_dot(m->nq, st->b, x) / (1.0 + st->gamma * st->bz);
        for (ptrdiff_t i = 0; i < m->nq; i++)
            x[i] -= s * st->z[i];
    }
    return status;
}

static enum pm_status iterate(struct pm_model *m, const struct stiffening *st, struct column *col,
                              double *z, ptrdiff_t n, double tolerance, int limit, double *Kp,
                              struct pm_krylov_report *report, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (;; report->steps++) {
        int open = 0;
        for (ptrdiff_t k = 0; k < n; k++) {
            col[k].open = pm_dot(m->nq, col[k].r, col[k].r) > tolerance * tolerance * col[k].rr0;
            open |= col[k].open;
        }
        report->good = !open;
        if (!open || report->steps == limit)
            break;
        memcpy(z, col[0].r, (size_t)(n * m->nq) * sizeof *z); /* columns are adjacent */
        PM_TRY(precondition(m, st, z, n, err));
        for (ptrdiff_t k = 0; k < n; k++)
            if (col[k].open && !advance(m, st, &col[k], z + k * m->nq, Kp)) {
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

static enum pm_status solve(struct pm_model *m, const struct stiffening *st, double *x, ptrdiff_t n,
                            double tolerance, int limit, struct pm_krylov_report *report,
                            struct pm_err *err)
{
    enum pm_status status;
    struct column *col = NULL;
    double *store = NULL;
    ptrdiff_t nq = m->nq;
    *report = (struct pm_krylov_report){.least = 1.0, .largest = 1.0, .gamma = st->gamma};
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
        col[k].rr0 = pm_dot(nq, col[k].r, col[k].r);
    PM_TRY(iterate(m, st, col, store + 2 * n * nq, n, tolerance,
                   limit < MOST_STEPS ? limit : MOST_STEPS, store + 3 * n * nq, report, err));
done:
    pm_free(col);
    pm_free(store);
    return status;
}

enum pm_status pm_krylov_solve(struct pm_model *m, double *x, ptrdiff_t n, double tolerance,
                               int limit, struct pm_krylov_report *report, struct pm_err *err)
{
    return solve(m, &(struct stiffening){.b = NULL}, x, n, tolerance, limit, report, err);
}

enum pm_status pm_krylov_solve_stiffened(struct pm_model *m, const double *b, double *x,
                                         ptrdiff_t n, double tolerance, int limit,
                                         struct pm_krylov_report *report, struct pm_err *err)
{
    enum pm_status status;
    struct stiffening st = {.b = b};
    PM_TRY(PM_NEW(st.z, m->nq, err));
    memcpy(st.z, b, (size_t)m->nq * sizeof *b);
    PM_TRY(pm_cholesky_solve(m->factor, st.z, 1, err));
    st.bz = pm_dot(m->nq, b, st.z);
    st.gamma = 10.0 / st.bz;
    PM_TRY(solve(m, &st, x, n, tolerance, limit, report, err));
done:
    pm_free(st.z);
    return status;
}
