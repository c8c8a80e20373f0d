/* Least squares within a box. */
#ifndef INVKIN_BOX_H
#define INVKIN_BOX_H

enum { BOX_MOST = 8 };

/* d (n) that minimises |A d + b|^2 for low <= d <= high (n), A (m x n), 1 <= m, n <= BOX_MOST, low
 * <= 0 <= high; where several do, nearly the shortest one: (1e-6 |A|)^2 |d|^2 is added, |A| the
 * largest entry. Exact otherwise: active sets, each by a QR factorisation. */
void box_least_squares(int m, int n, const double *A, const double *b, const double *low,
                       const double *high, double *d);

#endif
