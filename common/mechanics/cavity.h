/* Volume of a chamber as a cubic form of the node positions of its faces [model 2].
 * Here the normal of the face is the one of its node order; a chamber face of a mesh points out of
 * the solid, that is into the cavity: its volume is MINUS the sum of these. x relative to x0 (on
 * every symmetry plane). Faces have 3, 6 or 7 nodes (n x 3): vertices, edges (01)(12)(20), cubic
 * bubble. */
#ifndef PM_CAVITY_H
#define PM_CAVITY_H

enum { PM_MOST_FACE_NODES = 7, PM_MOST_FACE_POINTS = 16 };

/* Shape functions at the points of a rule that integrates the form exactly. */
struct pm_cavity {
    int n, nq;
    double weight[PM_MOST_FACE_POINTS];
    double N[PM_MOST_FACE_POINTS][PM_MOST_FACE_NODES];
    double dN[PM_MOST_FACE_POINTS][2 * PM_MOST_FACE_NODES]; /* dN_a/dxi_j (n x 2) */
};

void pm_cavity_set(struct pm_cavity *c, int nodes);
/* vec(b, d) (n x 3): V = x.vec(x,x)/6, dV/dx = vec(x,x)/2, d2V v = vec(x,v), d3V[v,w,.] = vec(v,w).
 */
void pm_cavity_vec(const struct pm_cavity *c, const double *b, const double *d, double *out);
/* s_ab (n x n x 3): the Hessian blocks are H_ab e = s_ab x e. */
void pm_cavity_hessian(const struct pm_cavity *c, const double *x, double *s);

#endif
