/* What the sub-problem knows of contact: the closeness G_g of every region where a state is close
 * to itself, by the derivative of its root (Gauss-Newton: exact where a gap changes linearly), so
 * that no gain is promised beyond G = 0,
 *
 *   sum_g a_g (G_g(d) - G_g),  G_g(d) = <sqrt(G_g) + dG_g.d / (2 sqrt(G_g))>^2  [model 8]
 */
#ifndef TRSTEP_GAPS_H
#define TRSTEP_GAPS_H

#include "common/files/step.h"

/* Rise of the sum along d (N x 3); slope (N x 3) += factor times its derivative unless NULL. */
double gaps_at(const struct pm_step *s, const double *d, double factor, double *slope);

/* The closeness of region g of the accepted trial, weight a = -d objective / dG: appended to s;
 * gradient (N x 3) is copied. */
enum pm_status gaps_add(struct pm_step *s, double weight, double value, const double *gradient,
                        struct pm_err *err);
enum pm_status gaps_copy(const struct pm_step *from, struct pm_step *to, struct pm_err *err);

#endif
