/* The surfaces of a design: exterior (surface 0) and chambers (1..n), with their symmetry orbits.
 * Kinds `surface` and `step` hold them. */
#ifndef PM_SURFACES_H
#define PM_SURFACES_H

#include "common/files/case.h"
#include "common/files/h5.h"

enum pm_surface_type {
    PM_SURFACE_BSPLINE =
        0, /* tube, periodic x clamped cubic; parameter S = (cos t, sin t, v), v in [0, 1] */
    PM_SURFACE_SPHERE = 1, /* closed map [paper 52-59]; parameter S on the unit sphere */
};

struct pm_surface {
    int32_t type;  /* enum pm_surface_type */
    ptrdiff_t n;   /* control points */
    double *phi;   /* control points in space           (n x 3)  [mm] */
    uint8_t *free; /* 1: coordinate is a design variable (n x 3)  [1] */
    /* sphere map */
    double *Phi; /* reference control points on the unit sphere (n x 3) [1]; B-spline: (cos t, sin
                    t, v) at the Greville abscissae */
    double *d0;  /* support radii, chord metric        (n)      [1]; B-spline: zeros */
    /* B-spline: n = nu * nv, control point a around and b along is a + nu*b; rows b = 0 and nv-1
     * are the planar rims */
    ptrdiff_t nu, nv;
    double spacing[2]; /* B-spline: mean edge of the grid around and along at the start, to which a
                          reconstruction returns [mm]; 0: the numbers stay */
    ptrdiff_t nt;
    int32_t *tri; /* triangulation of the control points, normal n of the map (outward of the closed
                     surface) (nt x 3) */
};

struct pm_surfaces {
    struct pm_case pcase;
    ptrdiff_t ns;         /* surfaces: 1 + chambers */
    struct pm_surface *s; /* (ns) */
    ptrdiff_t *offset; /* global index of control point i of surface k is offset[k] + i; offset[ns]
                          = N (ns + 1) */
    int32_t *perm;     /* symmetry: operation g takes control point i to perm[g*N + i] (nops x N) */
    double reference_point[3]; /* of the end-effector [mm] */
};

enum pm_status pm_surfaces_read(struct pm_h5 *f, struct pm_surfaces *s, struct pm_err *err);
/* A second set of surfaces in the same file under the group `at` ("/accepted"), with the same case.
 */
enum pm_status pm_surfaces_read_at(struct pm_h5 *f, const char *at, struct pm_surfaces *s,
                                   struct pm_err *err);
enum pm_status pm_surfaces_write_at(struct pm_h5 *f, const char *at, const struct pm_surfaces *s,
                                    struct pm_err *err);
enum pm_status pm_surfaces_load(const char *path, struct pm_surfaces *s,
                                struct pm_err *err); /* kinds "surface step" */
enum pm_status pm_surfaces_write(struct pm_h5 *f, const struct pm_surfaces *s, struct pm_err *err);
enum pm_status pm_surfaces_copy(const struct pm_surfaces *from, struct pm_surfaces *to,
                                struct pm_err *err);
/* Room for n control points, all free, and nt triangles; everything else is 0. */
enum pm_status pm_surface_new(int32_t type, ptrdiff_t n, ptrdiff_t nt, struct pm_surface *s,
                              struct pm_err *err);
enum pm_status pm_surface_copy(const struct pm_surface *from, struct pm_surface *to,
                               struct pm_err *err);
void pm_surface_release(struct pm_surface *s);
/* All control points as one (N x 3) array, and back. */
void pm_surfaces_gather(const struct pm_surfaces *s, double *phi);
void pm_surfaces_scatter(struct pm_surfaces *s, const double *phi);
void pm_surfaces_release(struct pm_surfaces *s);

#endif
