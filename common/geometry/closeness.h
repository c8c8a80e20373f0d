/* How close a deformed body comes to itself, as a smooth function of its nodes. */
#ifndef PM_CLOSENESS_H
#define PM_CLOSENESS_H

#include "common/files/mesh.h"

/* From the middle s of each triangle of the boundary (as in contact.h) at x + u (nn x 3) [mm], of
 * area A and normal n, a ray along n through air meets the boundary, or its image across a symmetry
 * plane, after g at a triangle of normal m:
 *
 *   G = sum_s A/d^2 cos^2 b(g/d),  cos = -n.m > 0,  b(x) = (1 - x)^2 for x < 1, else 0
 *
 * of the whole body: a half model counts twice [model 7.1]. d: gap_min of the case [mm]; 0 gives
 * G = 0. It says nothing of bodies that pierce themselves.
 * The terms are kept apart by region: those whose triangles hang together, or meet, make up one;
 * the last part takes all but the largest of them. G is their sum. dG_dx (PM_CLOSENESS_PARTS x nn x
 * 3) = derivatives of the parts by the positions of the nodes [1/mm], NULL: not wanted. About nf
 * log nf. */
enum { PM_CLOSENESS_PARTS = 8 };
enum pm_status pm_closeness(const struct pm_mesh *m, const double *u, double G[PM_CLOSENESS_PARTS],
                            double *dG_dx, struct pm_err *err);
/* The same of a skin that is already there (skin.h). */
struct pm_skin;
enum pm_status pm_closeness_of(const struct pm_skin *s, double G[PM_CLOSENESS_PARTS], double *dG_dx,
                               struct pm_err *err);
double pm_closeness_sum(const double G[PM_CLOSENESS_PARTS]);

/* Factor of the objective, exp(-0.01 sum_g mult_g G_g) [model 7.1]; and d ln(factor)/dG_g for one
 * state of the symmetric whole. */
double pm_closeness_factor(double sum);
double pm_closeness_slope(int multiplicity);

#endif
