#include "tools/meshexport/compare.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/cavity.h"
#include "common/mechanics/rotation.h"
#include "tools/meshexport/deck.h"

/* A row `node ux uy uz`. */
static int read_row(const char *line, ptrdiff_t n, ptrdiff_t *node, double u[3])
{
    char *end;
    *node = strtol(line, &end, 10) - 1;
    if (end == line || *node < 0 || *node >= n)
        return 0;
    for (int i = 0; i < 3; i++) {
        const char *from = end;
        u[i] = strtod(from, &end);
        if (end == from || !isfinite(u[i]))
            return 0;
    }
    return 1;
}

/* The last block counts, and must be at the end of the second step. */
static enum pm_status read_blocks(FILE *f, const char *path, ptrdiff_t n, double *u, uint8_t *seen,
                                  struct pm_err *err)
{
    static const char head[] = " displacements (vx,vy,vz) for set NALL and time";
    char line[256];
    double time = 0.0, row[3];
    ptrdiff_t node, missing = 0;
    while (fgets(line, sizeof line, f) != NULL) {
        if (strncmp(line, head, sizeof head - 1) == 0) {
            memset(seen, 0, (size_t)n);
            time = strtod(line + sizeof head - 1, NULL);
        } else if (time > 0.0 && read_row(line, n, &node, row)) {
            seen[node] = 1;
            memcpy(u + 3 * node, row, sizeof row);
        }
    }
    if (ferror(f))
        return pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", path, strerror(errno));
    if (fabs(time - 2.0) > 1e-6)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': last displacements of set NALL at time %g, expected 2: "
                       "did CalculiX reach the end?",
                       path, time);
    while (missing < n && seen[missing])
        missing++;
    if (missing < n)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': no displacement of node %td, expected %td nodes: is it of "
                       "this mesh?",
                       path, missing + 1, n);
    return PM_OK;
}

enum pm_status compare_read(const char *path, ptrdiff_t n, double *u, struct pm_err *err)
{
    enum pm_status status;
    uint8_t *seen = NULL;
    FILE *f = fopen(path, "rb");
    if (f == NULL)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno));
    PM_TRY(PM_NEW(seen, n, err));
    PM_TRY(read_blocks(f, path, n, u, seen, err));
done:
    pm_free(seen);
    fclose(f);
    return status;
}

/* Volumes of the chambers [model 2] at the displacements u (nn x 3). */
static void volumes(const struct pm_mesh *m, const double *u, double *V)
{
    double origin[3] = {0};
    for (ptrdiff_t f = 0; f < m->nf; f++)
        if (m->tri_tag[f] <= PM_FACE_SYM_X) {
            const int axis = PM_FACE_SYM_X - m->tri_tag[f];
            origin[axis] = m->x[3 * (ptrdiff_t)m->tri[m->npf * f] + axis];
        }
    struct pm_cavity face;
    pm_cavity_set(&face, (int)m->npf);
    memset(V, 0, (size_t)m->nc * sizeof *V);
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        double x[3 * PM_MOST_FACE_NODES], vec[3 * PM_MOST_FACE_NODES];
        const int32_t *t = m->tri + m->npf * f;
        if (m->tri_tag[f] < 1)
            continue;
        for (ptrdiff_t k = 0; k < 3 * m->npf; k++) {
            const ptrdiff_t at = 3 * (ptrdiff_t)t[k / 3] + k % 3;
            x[k] = m->x[at] + u[at] - origin[k % 3];
        }
        pm_cavity_vec(&face, x, x, vec);
        for (ptrdiff_t k = 0; k < 3 * m->npf; k++)
            V[m->tri_tag[f] - 1] -= x[k] * vec[k] / 6;
    }
}

static double norm(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double distance(const double *a, const double *b)
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return norm(d);
}

/* Largest distance of a node of the end-effector from the motion that the rotation node tells: zero
 * if that is a rotation vector. */
static double rigid_defect(const struct pm_mesh *m, const unsigned char *sets, const double *u)
{
    const double *t = u + 3 * m->nn, *theta = t + 3;
    struct pm_rotation r;
    double worst = 0.0;
    pm_rotation_at(theta, 0, &r);
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        double want[3];
        if (sets[a] != DECK_TIP)
            continue;
        for (int i = 0; i < 3; i++) {
            want[i] = t[i] + m->reference_point[i] - m->x[3 * a + i];
            for (int j = 0; j < 3; j++)
                want[i] += r.R[3 * i + j] * (m->x[3 * a + j] - m->reference_point[j]);
        }
        worst = fmax(worst, distance(want, u + 3 * a));
    }
    return worst;
}

static void print_row(const char *name, double here, double there, double difference)
{
    printf("%s\t%.9g\t%.9g\t%.3e\n", name, here, there, difference);
}

static double ratio(double difference, double size)
{
    return size > 0.0 ? difference / size : difference;
}

enum pm_status compare_print(const struct pm_state *s, const double *u, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = &s->mesh;
    const double *U = u + 3 * m->nn;
    double *V = NULL, swell = 0.0, far = 0.0, off = 0.0;
    unsigned char *sets = NULL;
    PM_TRY(PM_NEW(V, m->nc, err));
    PM_TRY(deck_node_sets(m, &sets, err));
    volumes(m, u, V);
    const double size[] = {norm(s->U), norm(s->U + 3)};
    printf("quantity\tfesolve\tcalculix\trelative_difference\n");
    for (int i = 0; i < 6; i++) {
        const char name[] = {'U', (char)('1' + i), '\0'};
        print_row(name, s->U[i], U[i], ratio(fabs(U[i] - s->U[i]), size[i / 3]));
    }
    print_row("translation", size[0], norm(U), ratio(distance(U, s->U), size[0]));
    print_row("rotation", size[1], norm(U + 3), ratio(distance(U + 3, s->U + 3), size[1]));
    for (ptrdiff_t r = 0; r < m->nc; r++)
        swell = fmax(swell, fabs(s->volume[r] - s->volume0[r]));
    for (ptrdiff_t r = 0; r < m->nc; r++) {
        const char name[] = {'V', (char)('1' + r), '\0'};
        print_row(name, s->volume[r], V[r], ratio(fabs(V[r] - s->volume[r]), swell));
    }
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        far = fmax(far, norm(s->u + 3 * a));
        off = fmax(off, distance(s->u + 3 * a, u + 3 * a));
    }
    print_row("nodes", far, off, ratio(off, far));
    print_row("rigid_end", 0.0, rigid_defect(m, sets, u), ratio(rigid_defect(m, sets, u), far));
done:
    pm_free(V);
    pm_free(sets);
    return status;
}
