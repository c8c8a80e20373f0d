/* Bodies of hexahedral cells, each cut into six quadratic tetrahedra along its long diagonal
 * (Kuhn). The nodes are the points of a lattice twice as fine as the cells. Cells below `mirror`
 * have the images of the cuts of those above it, so that the mesh is its own mirror image. */
#ifndef LATTICE_H
#define LATTICE_H

#include <stdint.h>
#include <string.h>

#include "common/mechanics/tet10.h"

struct lattice {
    int n[3];      /* cells along each axis */
    int mirror[3]; /* cells below it are cut as images of those above; 0: none */
    int (*solid)(const void *data, const int cell[3]);
    const void *data;
};

/* A face on the boundary: side `side` (0 low, 1 high) of `cell` along `axis`. */
struct lattice_face {
    int cell[3], axis, side;
    int32_t node[6]; /* outward, edges (01)(12)(20) */
};

static inline int32_t lattice_node(const struct lattice *l, const int fine[3])
{
    return fine[0] + (2 * l->n[0] + 1) * (fine[1] + (2 * l->n[1] + 1) * fine[2]);
}

static inline void lattice_fine(const struct lattice *l, int32_t node, int fine[3])
{
    fine[0] = node % (2 * l->n[0] + 1);
    fine[1] = node / (2 * l->n[0] + 1) % (2 * l->n[1] + 1);
    fine[2] = node / (2 * l->n[0] + 1) / (2 * l->n[1] + 1);
}

static inline int lattice_solid(const struct lattice *l, const int cell[3])
{
    for (int i = 0; i < 3; i++)
        if (cell[i] < 0 || cell[i] >= l->n[i])
            return 0;
    return l->solid(l->data, cell);
}

/* Vertices of tetrahedron t = 0..5 of a cell in fine coordinates, v0 and v3 on the diagonal, along
 * axis[0], axis[1], axis[2] in turn; 1 or -1: its orientation. */
static inline int lattice_vertices(const struct lattice *l, const int cell[3], int t, int v[4][3],
                                   int axis[3])
{
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                    {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
    int step[3], sign = t < 3 ? 1 : -1;
    memcpy(axis, order[t], sizeof order[t]);
    for (int i = 0; i < 3; i++) {
        step[i] = cell[i] < l->mirror[i] ? -2 : 2;
        sign = step[i] < 0 ? -sign : sign;
        v[0][i] = 2 * cell[i] + (step[i] < 0 ? 2 : 0);
    }
    for (int k = 0; k < 3; k++) {
        memcpy(v[k + 1], v[k], sizeof v[k]);
        v[k + 1][axis[k]] += step[axis[k]];
    }
    return sign;
}

static inline int32_t lattice_middle(const struct lattice *l, const int a[3], const int b[3])
{
    const int m[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    return lattice_node(l, m);
}

/* Tetrahedron t of a cell, positive, edges (01)(12)(20)(30)(23)(13). */
static inline void lattice_tet(const struct lattice *l, const int cell[3], int t, int32_t node[10])
{
    int v[4][3], axis[3], at[4] = {0, 1, 2, 3};
    if (lattice_vertices(l, cell, t, v, axis) < 0) {
        at[1] = 2;
        at[2] = 1;
    }
    for (int k = 0; k < 4; k++)
        node[k] = lattice_node(l, v[at[k]]);
    for (int k = 0; k < 6; k++)
        node[4 + k] = lattice_middle(l, v[at[pm_tet10_edge[k][0]]], v[at[pm_tet10_edge[k][1]]]);
}

/* Its faces on the boundary, at most two; how many. */
static inline int lattice_faces(const struct lattice *l, const int cell[3], int t,
                                struct lattice_face face[2])
{
    int v[4][3], axis[3], n = 0;
    const int sign = lattice_vertices(l, cell, t, v, axis);
    for (int k = 0; k < 2; k++) { /* v0 v1 v2 faces along -axis[2], v1 v2 v3 along axis[0] */
        const int a = axis[k == 0 ? 2 : 0], out = (v[3][a] > v[0][a]) == (k == 1) ? 1 : -1;
        int next[3] = {cell[0], cell[1], cell[2]}, c[3] = {k, k + 1, k + 2};
        next[a] += out;
        if (lattice_solid(l, next))
            continue;
        struct lattice_face *f = &face[n++];
        *f = (struct lattice_face){.axis = a, .side = out > 0};
        memcpy(f->cell, cell, sizeof f->cell);
        if ((sign > 0) == (k == 0)) {
            c[1] = k + 2;
            c[2] = k + 1;
        }
        for (int i = 0; i < 3; i++) {
            f->node[i] = lattice_node(l, v[c[i]]);
            f->node[3 + i] = lattice_middle(l, v[c[i]], v[c[(i + 1) % 3]]);
        }
    }
    return n;
}

#endif
