/* The 10-node tetrahedron and the 6-node triangle: shape functions and quadrature.
 * Node order (gmsh): vertices 0-3, edges (01)(12)(20)(30)(23)(13); triangle: vertices, edges
 * (01)(12)(20). */
#ifndef PM_TET10_H
#define PM_TET10_H

#include <stddef.h>

enum { PM_TET_POINTS = 4, PM_TRI_POINTS = 6 };

/* Vertices of the edges, in the order of their nodes. */
extern const int pm_tet10_edge[6][2];
/* Reference coordinates and weights (sum 1/6) of the 4-point rule, exact to degree 2. */
extern const double pm_tet_xi[PM_TET_POINTS][3];
extern const double pm_tet_weight[PM_TET_POINTS];
/* The same of the 6-point triangle rule, exact to degree 4 (sum 1/2). */
extern const double pm_tri_xi[PM_TRI_POINTS][2];
extern const double pm_tri_weight[PM_TRI_POINTS];

void pm_tet10_shape_gradient(const double xi[3], double dN[30]);    /* dN_a/dxi_j (10 x 3) */
void pm_tri6_shape(const double xi[2], double N[6], double dN[12]); /* dN_a/dxi_j (6 x 2) */

/* Gradients with respect to X (10 x 3) at reference point xi: dN (10 x 3); returns det dX/dxi. */
double pm_tet10_gradient(const double *X, const double xi[3], double dN[30]);

#endif
