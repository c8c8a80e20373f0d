/* Differential geometry of one point of a surface and its variation [model 6.2], from the
 * derivatives r_a (2 x 3) and r_ab (3 x 3: 11, 12, 22) of surface_map.h. n = r_1 x r_2 / A points
 * out of the closed surface. */
#ifndef PM_CURVATURE_H
#define PM_CURVATURE_H

struct pm_curvature {
    double n[3];  /* unit normal */
    double A;     /* area element: mm2 per unit of parameter area */
    double gi[3]; /* inverse metric g^11, g^12, g^22 */
    double H, K;  /* mean (negative on convex bodies) [1/mm] and Gauss curvature [1/mm2] */
    double Q;     /* c1^2 + c2^2 [1/mm2] */
};

/* r_ab may be NULL: H, K, Q are 0 then. A = 0 (a fold) leaves infinite values. */
void pm_curvature_at(const double r_a[6], const double *r_ab, struct pm_curvature *c);
/* Q and its gradient: dQ = sum_a Q_a[a].dr_a + sum_k Q_ab[k].dr_k, k = 11, 12, 22 (both mixed terms
 * are in 12), so that dQ/dphi^m = sum_a c_a Q_a + sum_k c_ab Q_ab. Q_a (2 x 3), Q_ab (3 x 3). */
double pm_curvature_gradient(const double r_a[6], const double r_ab[9], double Q_a[6],
                             double Q_ab[9]);
/* A and its gradient: dA = sum_a A_a[a].dr_a, A_a (2 x 3). */
double pm_area_gradient(const double r_a[6], double A_a[6]);

#endif
