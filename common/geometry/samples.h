/* Fixed sample points of all surfaces with their weights of control points: surface integrals,
 * curvature and distances as functions of the control points. */
#ifndef PM_SAMPLES_H
#define PM_SAMPLES_H

#include "common/geometry/surface_map.h"

struct pm_samples {
    ptrdiff_t n, nw;  /* samples, stored weights */
    ptrdiff_t *first; /* samples of surface k are first[k] .. first[k + 1] - 1 (ns + 1) */
    int32_t *surface; /* (n) */
    double *S;        /* parameter (n x 3) */
    double *w;        /* share of the parameter domain (n) [1]: integral of f dA = sum w A f */
    double *area;     /* share of the surface at creation, w A (n) [mm2] */
    double *metric;   /* g_11, g_12, g_22 at creation or last pm_samples_metric (n x 3) [mm2] */
    ptrdiff_t *ptr;   /* rows of weights (n + 1) */
    int32_t *col;     /* GLOBAL control point (nw) */
    double *c;        /* r    = sum c phi    (nw) */
    double *c_a;      /* r_a  = sum c_a phi  (nw x 2) */
    double *c_ab;     /* r_ab = sum c_ab phi (nw x 3: 11, 12, 22) */
};

/* Every triangle of control points is cut into equal parts with edges <= spacing [mm] on the
 * present surface, at least `cuts` a side, with one sample in the middle of each: deterministic,
 * and dense where control points are. */
enum pm_status pm_samples_new(const struct pm_surfaces *s, double spacing, ptrdiff_t cuts,
                              struct pm_samples *samples, struct pm_err *err);
/* The same for curvatures: denser where a surface bends sharply and, behind the samples of each
 * surface, one without weight (w = area = 0) at every control point, where splines bend most. */
enum pm_status pm_samples_with_nodes(const struct pm_surfaces *s, double spacing, ptrdiff_t cuts,
                                     struct pm_samples *samples, struct pm_err *err);
void pm_samples_release(struct pm_samples *samples);
/* Parameters S (cuts^2 nt x 3) of the samples that pm_samples_new takes with spacing HUGE_VAL, were
 * the corners of the triangles at Phi (n x 3) instead of s->Phi: where a point of one
 * parametrisation lies in another. */
void pm_samples_parameters(const struct pm_surface *s, const double *Phi, ptrdiff_t cuts,
                           double *S);
/* r (3), r_a (2 x 3), r_ab (3 x 3) of sample i for control points phi (N x 3, global); NULL where
 * not wanted. */
void pm_samples_at(const struct pm_samples *samples, ptrdiff_t i, const double *phi, double *r,
                   double *r_a, double *r_ab);
/* The metric of sample i where its tangents are r_a (2 x 3). */
void pm_samples_metric(struct pm_samples *samples, ptrdiff_t i, const double *r_a);
/* x (n x 3) and unit normals (n x 3, out of the closed surface; NULL: not wanted) of all samples.
 */
void pm_samples_all(const struct pm_samples *samples, const double *phi, double *x, double *normal);

struct pm_pair {
    int32_t i, j;    /* -1: none */
    double distance; /* [mm] */
};
/* The closest two samples of surfaces a < b, closer than `cutoff`: pair[a * ns + b] (ns x ns). */
enum pm_status pm_samples_closest(const struct pm_samples *samples, ptrdiff_t ns, const double *x,
                                  double cutoff, struct pm_pair *pair, struct pm_err *err);

/* What a sample faces: `other` is a surface, or an end of the two ways out of its own one. */
enum { PM_NEAR_OUTSIDE = -1, PM_NEAR_INSIDE = -2 };
struct pm_near {
    int32_t i, j; /* sample, nearest sample there */
    int32_t other;
    double distance; /* [mm] */
    double along;    /* on its own surface: estimate of the distance along it [mm] */
};
/* For every sample i with from[i]: the nearest sample on each other surface, and on its own,
 * further than `geodesic` mm along it (estimate by the metric of the samples), the nearest that it
 * faces, within 60 degrees of both normals, through the outside and through the inside of the
 * closed surface. They are closer than cutoff[0] through the solid, cutoff[1] through a void, which
 * is inside chambers and outside the exterior. Of equally near ones the first. Sorted by i, then
 * other; *near is new memory (pm_free). About n log n. */
enum pm_status pm_samples_near(const struct pm_samples *samples, ptrdiff_t ns, const double *x,
                               const double *normal, const unsigned char *from,
                               const double cutoff[2], double geodesic, struct pm_near **near,
                               ptrdiff_t *n, struct pm_err *err);

#endif
