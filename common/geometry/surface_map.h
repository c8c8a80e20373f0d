/* Evaluation of one surface, sphere map [model 6.1] or B-spline tube [model 6.3], in local
 * coordinates: at S the tangent directions are t1, t2 (t1 x t2 = outward normal of the reference
 * shape), derivatives are in normal coordinates (second derivatives of the sphere include -delta_ab
 * dr/dS.S). */
#ifndef PM_SURFACE_MAP_H
#define PM_SURFACE_MAP_H

#include "common/files/surfaces.h"

struct pm_map; /* a surface ready for fast evaluation; borrows the surface's Phi and d0, not phi */

/* Weights of the control points at one S: r = sum c phi, r_a = sum c_a phi, r_ab = sum c_ab phi. */
struct pm_basis {
    ptrdiff_t n;  /* active control points */
    int32_t *id;  /* (n) local index */
    double *c;    /* (n) */
    double *c_a;  /* (n x 2) order >= 1 */
    double *c_ab; /* (n x 3): 11, 12, 22; order 2 */
    ptrdiff_t capacity;
};

enum pm_status pm_map_new(const struct pm_surface *s, struct pm_map **map, struct pm_err *err);
void pm_map_free(struct pm_map *map);
void pm_basis_release(struct pm_basis *b);
/* order 0, 1 or 2. PM_NUMERIC where no control point covers S (Z = 0). */
enum pm_status pm_map_basis(const struct pm_map *map, const double S[3], int order,
                            struct pm_basis *b, struct pm_err *err);
/* r (3), r_a (2 x 3), r_ab (3 x 3: 11, 12, 22) of control points phi from weights of that order;
 * NULL where not wanted. */
void pm_basis_apply(const struct pm_basis *b, const double *phi, double *r, double *r_a,
                    double *r_ab);
/* The same at S. r (3), r_a (2 x 3), r_ab (3 x 3: 11, 12, 22); NULL where not wanted (order
 * follows). */
enum pm_status pm_map_point(const struct pm_map *map, const double *phi, const double S[3],
                            struct pm_basis *work, double *r, double *r_a, double *r_ab,
                            struct pm_err *err);
/* The tangent directions used by c_a: t (2 x 3), and S moved by d along them, back on the reference
 * shape (B-spline: v clamped to [0, 1]). Move uses the same t as the basis. */
void pm_map_tangents(int32_t type, const double S[3], double t[6]);
void pm_map_move(int32_t type, const double S[3], const double d[2], double out[3]);
/* Parameter halfway between two (start of a mid-side node), on the reference shape. */
void pm_map_middle(int32_t type, const double a[3], const double b[3], double out[3]);

/* d0 (n): chord distance to the k-th nearest other control point [paper 56]. Cost n k log n. */
enum pm_status pm_map_support(ptrdiff_t n, const double *Phi, ptrdiff_t k, double *d0,
                              struct pm_err *err);
/* Sum of the kernels of a sphere map at S, 0 in a hole; the map is sound where it is >= 1
 * [model 6.1]. */
enum pm_status pm_map_coverage(const struct pm_map *map, const double S[3], struct pm_basis *work,
                               double *Z, struct pm_err *err);

enum { PM_MAP_NEIGHBOURS = 20 }; /* k of the paper */

#endif
