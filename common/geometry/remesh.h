/* Isotropic remeshing of a surface in its parameter space: nodes carry S, their place is r(S), so
 * every node of the result lies on the surface exactly (Botsch & Kobbelt, A remeshing approach to
 * multiresolution modeling, 2004). The rims v = 0 and v = 1 of a tube keep v exactly; rim nodes
 * slide along them. */
#ifndef PM_REMESH_H
#define PM_REMESH_H

#include "common/geometry/surface_map.h"

struct pm_remesh_opts {
    double size;      /* wanted edge length [mm] */
    double size_min;  /* its lower bound where the surface is curved [mm] */
    double crest;     /* edge length <= crest / curvature [1] */
    double chord;     /* edge length <= sqrt(8 chord / curvature), 0: no such bound [mm] */
    double tolerance; /* of the surface from its triangles, 0: none [mm] */
    double growth;    /* largest change of the wanted length per unit length [1] */
    int sweeps;
    /* a further upper bound of the length at a place with this outward unit normal, or NULL */
    double (*bound)(const void *data, const double x[3], const double normal[3], double curvature);
    const void *data;
    int mirror[3]; /* 1: mesh only S_j >= 0; nodes on the plane S_j = 0 stay on it (tube: x, y) */
};

/* A triangulated surface with parameters. */
struct pm_patch {
    ptrdiff_t nn, nt;
    double *S;        /* surface parameter                               (nn x 3) */
    double *x;        /* r(S)                                            (nn x 3) [mm] */
    double *size;     /* wanted edge length                              (nn)     [mm] */
    uint8_t *rim;     /* bits: B-spline: 1 on v = 0, 2 on v = 1; pm_rim_plane; 0 elsewhere (nn) */
    int32_t *tri;     /* normal out of the closed surface                (nt x 3) */
    ptrdiff_t splits; /* triangles more for the tolerance */
    double off;       /* distance of the surface from them, 0 where there is no tolerance [mm] */
};

/* Size h = min(size, crest / largest principal curvature, bound) >= size_min at nodes and in the
 * middle of edges, limited in growth; edges end up within about [4/5, 4/3] h, 1.05 to 1.3 triangles
 * for each equilateral one with edges h. Starts from the triangulation of the control points.
 * PM_INPUT where that triangulation is unusable (folded in the parameter, not a manifold) or the
 * sizes ask for more than 2e5 nodes,
 * PM_NUMERIC where the map fails. `surface` is its number in messages. Cost: some 20 evaluations
 * per node, 40 where size_min < size. */
enum pm_status pm_remesh(const struct pm_surface *s, int surface, const struct pm_remesh_opts *o,
                         struct pm_patch *p, struct pm_err *err);
void pm_patch_release(struct pm_patch *p);
/* Wanted edge length by size, crest and chord alone where the derivatives of the surface are r_a
 * (2 x 3) and r_ab (3 x 3) [mm]. */
double pm_remesh_length(const struct pm_remesh_opts *o, const double r_a[6], const double r_ab[9]);
/* The bit in `rim` of the mirror plane S_axis = 0. */
uint8_t pm_rim_plane(int32_t type, int axis);
/* Puts S back on the rims of these bits: v of a tube, mirror planes. */
void pm_rim_constrain(int32_t type, unsigned rim, double S[3]);
/* > 0 where the parameters a, b, c turn counter-clockwise seen from outside the reference shape. */
double pm_parameter_orientation(int32_t type, const double a[3], const double b[3],
                                const double c[3]);

#endif
