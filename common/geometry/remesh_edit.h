/* An editable triangulation on a surface map: splits, collapses and flips of edges. */
#ifndef PM_REMESH_EDIT_H
#define PM_REMESH_EDIT_H

#include "common/geometry/remesh.h"

enum { PM_EDIT_DEGREE = 64 }; /* triangles around a node, at most */

struct pm_edit {
    const struct pm_map *map;
    const double *phi; /* borrowed */
    int32_t type;      /* enum pm_surface_type */
    struct pm_basis basis;
    ptrdiff_t nn, ncap, nt, tcap;
    double *S, *x;   /* (ncap x 3) */
    double *normal;  /* unit surface normal (ncap x 3) */
    double *size;    /* wanted edge length (ncap) */
    uint8_t *rim;    /* as in pm_patch (ncap) */
    int32_t *tri;    /* first id -1: removed (tcap x 3) */
    int32_t *around; /* triangles around a node (ncap x PM_EDIT_DEGREE) */
    int32_t *degree; /* their number; 0: removed (ncap) */
};

/* Takes the control points and their triangulation. */
enum pm_status pm_edit_init(struct pm_edit *m, const struct pm_surface *s, const struct pm_map *map,
                            int surface, struct pm_err *err);
void pm_edit_release(struct pm_edit *m);
/* Place and normal of node a from its S. */
enum pm_status pm_edit_place(struct pm_edit *m, ptrdiff_t a, struct pm_err *err);
/* Splits the edge (a, b) at S (NULL: its middle); *done_it = 0 where a node would get too many
 * triangles. */
enum pm_status pm_edit_split_edge(struct pm_edit *m, ptrdiff_t a, ptrdiff_t b, const double *S,
                                  int *done_it, struct pm_err *err);
/* Removes a triangle. */
void pm_edit_remove(struct pm_edit *m, ptrdiff_t t);
/* Cuts along the plane S_axis = 0 and keeps S_axis >= 0; nodes on the plane get its bit of rim. */
enum pm_status pm_edit_halve(struct pm_edit *m, int axis, struct pm_err *err);
/* Lengths that edges keep, in parts of the wanted one. */
extern const double pm_edit_longest, pm_edit_shortest;
/* Splits the longest edge of every triangle that has one longer than `ratio` times the wanted
 * length; *count edges. */
enum pm_status pm_edit_split(struct pm_edit *m, double ratio, ptrdiff_t *count, struct pm_err *err);
/* Splits the longest edge of every triangle that the surface leaves by more than `tolerance` mm at
 * the middles of its edges or near its own, until there is none, in at most 13 rounds; *off: the
 * largest distance that the last round saw [mm]. */
enum pm_status pm_edit_hold(struct pm_edit *m, double tolerance, double *off, struct pm_err *err);
/* Collapses edges shorter than pm_edit_shortest times the wanted length where topology,
 * orientation, normals and the lengths of the new edges allow; returns their number. */
ptrdiff_t pm_edit_collapse(struct pm_edit *m);
/* Delaunay flips in configuration; returns their number. */
ptrdiff_t pm_edit_flip(struct pm_edit *m);
/* Smallest over the triangles around a of (unit normal of the facet) . (mean surface normal of its
 * nodes), -1 where one is folded in the parameter. */
double pm_edit_worst(const struct pm_edit *m, ptrdiff_t a);
/* Length of the edge (a, b) [mm]. */
double pm_edit_length(const struct pm_edit *m, ptrdiff_t a, ptrdiff_t b);
/* Area of all triangles [mm2]. */
double pm_edit_area(const struct pm_edit *m);
/* Number of triangles over that of equilateral ones with edges of the wanted length. */
double pm_edit_crowding(const struct pm_edit *m);
/* Drops what was removed and hands the arrays over. */
enum pm_status pm_edit_finish(struct pm_edit *m, struct pm_patch *p, struct pm_err *err);

#endif
