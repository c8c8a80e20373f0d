#include "tools/invkin/box.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum { ROWS = 2 * BOX_MOST };

/* The problem with the rows of the regularisation below those of A. */
struct problem {
    int m, n;
    double A[ROWS][BOX_MOST], b[ROWS];
    const double *low, *high;
    int bound[BOX_MOST]; /* -1 at low, 1 at high, 0 free */
};

static void residual(const struct problem *s, const double *d, double *r)
{
    for (int i = 0; i < s->m; i++) {
        r[i] = s->b[i];
        for (int j = 0; j < s->n; j++)
            r[i] += s->A[i][j] * d[j];
    }
}

/* z: the minimum over the free variables, the others as in d. */
static void solve_free(const struct problem *s, const double *d, double *z)
{
    double qr[ROWS * BOX_MOST], rhs[ROWS], tau[BOX_MOST], x[BOX_MOST], rest[ROWS];
    double fixed[BOX_MOST] = {0};
    int column[BOX_MOST], n = 0;
    for (int j = 0; j < s->n; j++) {
        fixed[j] = s->bound[j] != 0 ? d[j] : 0.0;
        if (s->bound[j] == 0)
            column[n++] = j;
    }
    memcpy(z, fixed, (size_t)s->n * sizeof *z);
    if (n == 0)
        return;
    residual(s, fixed, rhs);
    for (int i = 0; i < s->m; i++)
        for (int k = 0; k < n; k++)
            qr[n * i + k] = s->A[i][column[k]];
    gsl_matrix_view Q = gsl_matrix_view_array(qr, (size_t)s->m, (size_t)n);
    gsl_vector_view t = gsl_vector_view_array(tau, (size_t)n);
    gsl_vector_view y = gsl_vector_view_array(x, (size_t)n);
    gsl_vector_view r = gsl_vector_view_array(rhs, (size_t)s->m);
    gsl_vector_view e = gsl_vector_view_array(rest, (size_t)s->m);
    gsl_linalg_QR_decomp(&Q.matrix, &t.vector);
    gsl_linalg_QR_lssolve(&Q.matrix, &t.vector, &r.vector, &y.vector, &e.vector);
    for (int k = 0; k < n; k++)
        z[column[k]] = -x[k];
}

/* d towards z as far as the box allows; what stops it is bound. Returns 1 where d = z. */
static int advance(struct problem *s, const double *z, double *d)
{
    double step = 1.0;
    int first = -1;
    for (int j = 0; j < s->n; j++) {
        const double end = z[j] < s->low[j] ? s->low[j] : s->high[j];
        if (s->bound[j] != 0 || (z[j] >= s->low[j] && z[j] <= s->high[j]))
            continue;
        if ((end - d[j]) / (z[j] - d[j]) < step || first < 0) {
            step = fmax(0.0, (end - d[j]) / (z[j] - d[j]));
            first = j;
        }
    }
    for (int j = 0; j < s->n; j++)
        if (s->bound[j] == 0)
            d[j] += step * (z[j] - d[j]);
    if (first < 0)
        return 1;
    s->bound[first] = z[first] < s->low[first] ? -1 : 1;
    d[first] = s->bound[first] < 0 ? s->low[first] : s->high[first];
    return 0;
}

/* Frees the variable whose bound holds back most; 0 if none does. */
static int release(struct problem *s, const double *d)
{
    double r[ROWS], most = 0.0;
    int which = -1;
    residual(s, d, r);
    for (int j = 0; j < s->n; j++) {
        double slope = 0.0, size = 0.0;
        for (int i = 0; i < s->m; i++) {
            slope += s->A[i][j] * r[i];
            size += fabs(s->A[i][j] * r[i]);
        }
        slope *= s->bound[j];
        if (slope > 1e-12 * size && slope > most && s->high[j] > s->low[j]) {
            most = slope;
            which = j;
        }
    }
    if (which >= 0)
        s->bound[which] = 0;
    return which >= 0;
}

void box_least_squares(int m, int n, const double *A, const double *b, const double *low,
                       const double *high, double *d)
{
    struct problem s = {.m = m + n, .n = n, .low = low, .high = high};
    double z[BOX_MOST], largest = 0.0;
    int settled;
    for (int i = 0; i < m; i++) {
        s.b[i] = b[i];
        for (int j = 0; j < n; j++) {
            s.A[i][j] = A[n * i + j];
            largest = fmax(largest, fabs(A[n * i + j]));
        }
    }
    for (int j = 0; j < n; j++) {
        s.A[m + j][j] = largest > 0.0 ? 1e-6 * largest : 1.0;
        d[j] = 0.0;
    }
    /* More changes than active sets there are would be a cycle of rounding. */
    for (int k = 0; k < 6561; k++) {
        solve_free(&s, d, z);
        settled = advance(&s, z, d);
        if (settled && !release(&s, d))
            break;
    }
}
