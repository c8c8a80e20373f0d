/* Volume of a chamber as a cubic form of the node positions of its tri6 faces [model 2].
 * Here the normal of the face is the one of its node order; a chamber face of a mesh points out of
 * the solid, that is into the cavity: its volume is MINUS the sum of these. x relative to x0 (on
 * every symmetry plane). */
#ifndef PM_CAVITY_H
#define PM_CAVITY_H

/* vec(b, c) (6 x 3): V = x.vec(x,x)/6, dV/dx = vec(x,x)/2, d2V v = vec(x,v), d3V[v,w,.] = vec(v,w).
 */
void pm_cavity_vec(const double b[18], const double c[18], double out[18]);
/* s_ab (6 x 6 x 3): the Hessian blocks are H_ab e = s_ab x e. */
void pm_cavity_hessian(const double x[18], double s[108]);

#endif
