/* Slender bodies with pleated chambers on a lattice of quadratic tetrahedra, as gmsh 2.2 files:
 * equal from run to run, and exact mirror images of themselves. beam finger|bellows|pair
 * whole|half|quarter PITCHES FILE.msh finger: one chamber on a flat back, bends towards that.
 * bellows: a square tube, stretches; it alone has a quarter. pair: two chambers back to back, one
 * the image of the other. A half has y >= 0, a quarter x >= 0 too. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/lattice.h"

enum { BODY = 1, BASE, TIP, EXTERIOR, CHAMBER1, CHAMBER2, SYM_X, SYM_Y, GROUPS = 8 };
static const char *const group_name[GROUPS + 1] = {
    "", "body", "base", "tip", "exterior", "chamber1", "chamber2", "symmetry-x", "symmetry-y"};
enum { MOST_PLANES = 8, PITCH_CELLS = 4, MOST_PITCHES = 64 };

/* Planes between cells from 0 outwards; from plane `from` to plane `to` there is a chamber. */
struct axis {
    int n, from, to, mirrored;
    double at[MOST_PLANES]; /* (n) [mm] */
};

/* The walls of the chamber stand out by `fold` in the middle of a pitch, where x lies beyond the
 * chamber's beginning. */
struct beam {
    const char *name;
    struct axis x, y;
    double fold_x, fold_y, pitch, cap; /* [mm] */
    int chambers;
    int pitches, half, quarter;
};

static const struct beam beams[] = {
    {"finger", {5, 1, 3, 0, {0, 1, 3.5, 6, 7}}, {3, 0, 1, 1, {0, 3, 4}}, 3, 1, 6, 2, 1, 0, 0, 0},
    {"bellows", {3, 0, 1, 1, {0, 4, 5}}, {3, 0, 1, 1, {0, 4, 5}}, 2, 2, 6, 2, 1, 0, 0, 0},
    {"pair", {5, 1, 3, 1, {0, 1, 3.5, 6, 7}}, {3, 0, 1, 1, {0, 3, 4}}, 3, 1, 6, 2, 2, 0, 0, 0}};

/* Cell of a mirrored axis, counted outwards from 0. */
static int outward(const struct axis *a, int cell)
{
    const int middle = a->n - 1;
    return !a->mirrored ? cell : cell < middle ? middle - 1 - cell : cell - middle;
}

static int hollow(const struct beam *b, const int cell[3])
{
    const int i = outward(&b->x, cell[0]), j = outward(&b->y, cell[1]);
    return i >= b->x.from && i < b->x.to && j >= b->y.from && j < b->y.to && cell[2] > 0 &&
           cell[2] <= PITCH_CELLS * b->pitches;
}

static int solid(const void *data, const int cell[3])
{
    const struct beam *b = data;
    return !hollow(b, cell) && !(b->half && cell[1] < b->y.n - 1) &&
           !(b->quarter && cell[0] < b->x.n - 1);
}

/* Distance from the middle, and its sign. */
static double straight(const struct axis *a, int fine, double *sign)
{
    const int s = a->mirrored ? fine - 2 * (a->n - 1) : fine, d = s < 0 ? -s : s, k = d / 2;
    *sign = s < 0 ? -1 : 1;
    return d % 2 == 0 ? a->at[k] : 0.5 * (a->at[k] + a->at[k + 1]);
}

/* 0 where the chamber begins, 1 from where it ends. */
static double ramp(const struct axis *a, double d)
{
    return fmin(fmax((d - a->at[a->from]) / (a->at[a->to] - a->at[a->from]), 0), 1);
}

static void place(const struct beam *b, const int fine[3], double x[3])
{
    const int nz = 2 * PITCH_CELLS * b->pitches, k = fine[2] - 2;
    const double pi = acos(-1), inside = fmin(fmax(k, 0), nz), length = b->pitch * b->pitches;
    const double wave = (1 - cos(pi * inside / PITCH_CELLS)) / 2;
    double sx, sy;
    const double dx = straight(&b->x, fine[0], &sx), dy = straight(&b->y, fine[1], &sy);
    const double along = ramp(&b->x, dx), beside = b->x.from == 0 ? 1 : along;
    x[0] = sx * (dx + b->fold_x * wave * along);
    x[1] = sy * (dy + b->fold_y * wave * beside * ramp(&b->y, dy));
    x[2] = length * inside / nz + b->cap * 0.5 * (k < 0 ? k : k > nz ? k - nz : 0);
}

static int group_of(const struct beam *b, const struct lattice *l, const struct lattice_face *f)
{
    int next[3] = {f->cell[0], f->cell[1], f->cell[2]}, inside = 1;
    next[f->axis] += f->side == 1 ? 1 : -1;
    for (int i = 0; i < 3; i++)
        inside &= next[i] >= 0 && next[i] < l->n[i];
    if (!inside)
        return f->axis < 2 ? EXTERIOR : f->side == 0 ? BASE : TIP;
    if (b->quarter && next[0] < b->x.n - 1)
        return SYM_X;
    if (b->half && next[1] < b->y.n - 1)
        return SYM_Y;
    return b->chambers == 2 && next[0] < b->x.n - 1 ? CHAMBER2 : CHAMBER1;
}

/* All elements: counted (f NULL; their nodes marked) or written with the numbers of the nodes. */
static int elements(const struct beam *b, const struct lattice *l, int32_t *number, FILE *f)
{
    int count = 0;
    for (int at = 0; at < 6 * l->n[0] * l->n[1] * l->n[2]; at++) {
        const int t = at % 6, c = at / 6;
        const int cell[3] = {c % l->n[0], c / l->n[0] % l->n[1], c / l->n[0] / l->n[1]};
        struct lattice_face face[2];
        int32_t node[10];
        if (!lattice_solid(l, cell))
            continue;
        lattice_tet(l, cell, t, node);
        const int faces = lattice_faces(l, cell, t, face);
        for (int k = 0; k <= faces; k++) {
            const int32_t *v = k == 0 ? node : face[k - 1].node;
            const int group = k == 0 ? BODY : group_of(b, l, &face[k - 1]);
            count++;
            if (f != NULL)
                fprintf(f, "%d %d 2 %d %d", count, k == 0 ? 11 : 9, group, group);
            for (int i = 0; i < (k == 0 ? 10 : 6); i++)
                if (f != NULL)
                    fprintf(f, " %d", number[v[i]]);
                else
                    number[v[i]] = 1;
            if (f != NULL)
                fprintf(f, "\n");
        }
    }
    return count;
}

static void write_22(const struct beam *b, const struct lattice *l, int32_t *number, FILE *f)
{
    const int32_t nn = (2 * l->n[0] + 1) * (2 * l->n[1] + 1) * (2 * l->n[2] + 1);
    const int count = elements(b, l, number, NULL);
    int32_t used = 0;
    for (int32_t a = 0; a < nn; a++)
        number[a] = number[a] != 0 ? ++used : 0;
    fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", GROUPS);
    for (int g = 1; g <= GROUPS; g++)
        fprintf(f, "%d %d \"%s\"\n", g == BODY ? 3 : 2, g, group_name[g]);
    fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", used);
    for (int32_t a = 0; a < nn; a++) {
        int fine[3];
        double x[3];
        lattice_fine(l, a, fine);
        place(b, fine, x);
        if (number[a] != 0)
            fprintf(f, "%d %.17g %.17g %.17g\n", number[a], x[0], x[1], x[2]);
    }
    fprintf(f, "$EndNodes\n$Elements\n%d\n", count);
    elements(b, l, number, f);
    fprintf(f, "$EndElements\n");
}

static int write_beam(struct beam b, const char *path)
{
    const int nx = b.x.n - 1, ny = b.y.n - 1;
    const struct lattice l = {
        .n = {b.x.mirrored ? 2 * nx : nx, 2 * ny, PITCH_CELLS * b.pitches + 2},
        .mirror = {b.x.mirrored ? nx : 0, ny, 0},
        .solid = solid,
        .data = &b};
    const ptrdiff_t nodes = (ptrdiff_t)(2 * l.n[0] + 1) * (2 * l.n[1] + 1) * (2 * l.n[2] + 1);
    int32_t *number = calloc((size_t)nodes, sizeof *number);
    if (number == NULL)
        return 1;
    FILE *f = fopen(path, "wb");
    if (f == NULL) {
        free(number);
        return 1;
    }
    write_22(&b, &l, number, f);
    free(number);
    return fclose(f) != 0;
}

int main(int argc, char **argv)
{
    for (size_t k = 0; argc == 5 && k < sizeof beams / sizeof beams[0]; k++) {
        struct beam b = beams[k];
        b.pitches = (int)strtol(argv[3], NULL, 10);
        b.quarter = strcmp(argv[2], "quarter") == 0;
        b.half = b.quarter || strcmp(argv[2], "half") == 0;
        if (strcmp(argv[1], b.name) == 0 && b.pitches > 0 && b.pitches <= MOST_PITCHES &&
            (b.half || strcmp(argv[2], "whole") == 0) && !(b.quarter && b.x.from > 0))
            return write_beam(b, argv[4]);
    }
    fprintf(stderr, "usage: beam finger|bellows|pair whole|half|quarter PITCHES FILE.msh\n");
    return 2;
}
