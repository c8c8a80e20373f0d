#include "common/actuation/determinant.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* By hand: the LU decomposition of GSL 2.7 divides by a pivot that is zero. */
double pm_det(int n, const double *A)
{
    double lu[PM_MAX_DETERMINANT * PM_MAX_DETERMINANT], det = 1;

    assert(n >= 1 && n <= PM_MAX_DETERMINANT);
    memcpy(lu, A, (size_t)(n * n) * sizeof *lu);
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(lu[n * i + k]) > fabs(lu[n * pivot + k]))
                pivot = i;
        if (lu[n * pivot + k] == 0)
            return 0;
        for (int j = k; j < n && pivot != k; j++) {
            const double swap = lu[n * k + j];
            lu[n * k + j] = lu[n * pivot + j];
            lu[n * pivot + j] = swap;
        }
        det *= pivot != k ? -lu[n * k + k] : lu[n * k + k];
        for (int i = k + 1; i < n; i++)
            for (int j = k + 1; j < n; j++)
                lu[n * i + j] -= lu[n * i + k] / lu[n * k + k] * lu[n * k + j];
    }
    return det;
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
