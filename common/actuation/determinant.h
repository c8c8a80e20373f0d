/* Determinant and cofactors of small square matrices, singular ones included. */
#ifndef PM_DETERMINANT_H
#define PM_DETERMINANT_H

enum { PM_MAX_DETERMINANT = 8 };

/* det A, A (n x n), 1 <= n <= PM_MAX_DETERMINANT. */
double pm_det(int n, const double *A);
/* cof_ij = d det A / d A_ij (n x n), from minors: exact where A is singular. */
void pm_cofactors(int n, const double *A, double *cof);

#endif
