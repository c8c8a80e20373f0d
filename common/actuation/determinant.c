#include "common/actuation/determinant.h"

#include <assert.h>
#include <gsl/gsl_linalg.h>
#include <string.h>

double pm_det(int n, const double *A)
{
    double lu[PM_MAX_DETERMINANT * PM_MAX_DETERMINANT];
    size_t order[PM_MAX_DETERMINANT];
    int signum;

    assert(n >= 1 && n <= PM_MAX_DETERMINANT);
    memcpy(lu, A, (size_t)(n * n) * sizeof *lu);
    gsl_matrix_view m = gsl_matrix_view_array(lu, (size_t)n, (size_t)n);
    gsl_permutation p = {.size = (size_t)n, .data = order};
    gsl_linalg_LU_decomp(&m.matrix, &p, &signum);
    return gsl_linalg_LU_det(&m.matrix, signum);
}

void pm_cofactors(int n, const double *A, double *cof)
{
    double minor[PM_MAX_DETERMINANT * PM_MAX_DETERMINANT];

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            int k = 0;
            for (int a = 0; a < n; a++)
                for (int b = 0; b < n; b++)
                    if (a != i && b != j)
                        minor[k++] = A[n * a + b];
            cof[n * i + j] = ((i + j) % 2 ? -1 : 1) * (n > 1 ? pm_det(n - 1, minor) : 1);
        }
}
