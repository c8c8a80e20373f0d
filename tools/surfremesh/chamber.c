#include "tools/surfremesh/chamber.h"

#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/record.h"
#include "common/geometry/hemispheres.h"
#include "common/geometry/parametrise.h"
#include "common/geometry/remesh.h"
#include "common/geometry/springs.h"
#include "tools/surfremesh/spacing.h"

enum { TRIES = 4 };

/* The count of control points may be off the wanted one by this part. */
static const double COUNT_OFF = 0.03;

/* Coordinates R S in which the mirror planes that keep a chamber are coordinate planes. */
struct frame {
    double R[9];
    int turned;    /* 0: R is the unit matrix */
    int mirror[3]; /* 1: the plane (R S)_j = 0 is one */
};

/* The unit normal of a reflection Q = I - 2 n n^T; 0 where Q is none. */
static int reflection(const double Q[9], double n[3])
{
    const double square[3] = {(1 - Q[0]) / 2, (1 - Q[4]) / 2, (1 - Q[8]) / 2};
    const int j = square[0] >= square[1] ? (square[0] >= square[2] ? 0 : 2)
                                         : (square[1] >= square[2] ? 1 : 2);
    double off = fabs(square[0] + square[1] + square[2] - 1);

    for (int i = 0; i < 3 && square[j] > 0; i++)
        n[i] = (i == j ? square[j] : -Q[3 * i + j] / 2) / sqrt(square[j]);
    for (int i = 0; i < 9 && square[j] > 0; i++)
        off = fmax(off, fabs(Q[i] - (i % 4 == 0) + 2 * n[i / 3] * n[i % 3]));
    return square[j] > 0 && off < 1e-9;
}

/* Takes n for the row of its largest free component, unless it leans to one that is taken. */
static void add_plane(struct frame *f, const double n[3])
{
    int row = -1;

    for (int j = 0; j < 3; j++) {
        const double *r = &f->R[3 * j];
        if (f->mirror[j] && fabs(r[0] * n[0] + r[1] * n[1] + r[2] * n[2]) > 1e-9)
            return;
        if (!f->mirror[j] && (row < 0 || fabs(n[j]) > fabs(n[row])))
            row = j;
    }
    if (row < 0)
        return;
    memcpy(&f->R[3 * row], n, 3 * sizeof *n);
    f->mirror[row] = 1;
    f->turned |= fabs(n[row]) != 1;
}

/* The other rows: the coordinate axes made orthogonal to those before, z first; a rotation, no
 * reflection: triangles keep their sense. */
static void complete(struct frame *f)
{
    int taken[3] = {f->mirror[0], f->mirror[1], f->mirror[2]};

    for (int j = 2; j >= 0; j--) {
        double *r = &f->R[3 * j], length = 0;
        if (taken[j])
            continue;
        for (int i = 0; i < 3; i++)
            r[i] = i == j;
        for (int k = 0; k < 3; k++) {
            const double *q = &f->R[3 * k], dot = q[0] * r[0] + q[1] * r[1] + q[2] * r[2];
            for (int i = 0; i < 3 && taken[k]; i++)
                r[i] -= dot * q[i];
        }
        for (int i = 0; i < 3; i++)
            length += r[i] * r[i];
        for (int i = 0; i < 3; i++)
            r[i] /= sqrt(length);
        taken[j] = 1;
    }
    const double *R = f->R;
    const double det = R[0] * (R[4] * R[8] - R[5] * R[7]) - R[1] * (R[3] * R[8] - R[5] * R[6]) +
                       R[2] * (R[3] * R[7] - R[4] * R[6]);
    const int row = f->mirror[0] ? 0 : f->mirror[1] ? 1 : 2;
    for (int i = 3 * row; i < 3 * row + 3 && det < 0; i++)
        f->R[i] = -f->R[i];
}

/* The operations that keep chamber k (0-based) must be its reflections and their products, the
 * planes at right angles. */
static enum pm_status find_frame(const struct pm_symmetry *y, ptrdiff_t k, struct frame *f,
                                 struct pm_err *err)
{
    ptrdiff_t kept = 0, made = 1;
    double n[3];

    *f = (struct frame){.turned = 0};
    for (ptrdiff_t g = 0; g < y->nops; g++) {
        if (y->chamber[g][k] != k)
            continue;
        kept++;
        if (reflection(y->Q[g], n))
            add_plane(f, n);
    }
    complete(f);
    for (int j = 0; j < 3; j++)
        made *= f->mirror[j] ? 2 : 1;
    if (kept != made)
        return pm_fail(err, PM_NUMERIC,
                       "cannot remesh chamber %td: %td operations keep it, expected reflections in "
                       "planes at right angles and their products",
                       k + 1, kept);
    return PM_OK;
}

/* n points x by R, or back by its transpose. What is on a plane but for rounding, in parts of the
 * terms of the sum, is put on it. */
static void turn(const struct frame *f, int back, ptrdiff_t n, double *x)
{
    for (ptrdiff_t i = 0; i < n && f->turned; i++) {
        double y[3] = {0}, size[3] = {0};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                const double term = f->R[back ? 3 * k + j : 3 * j + k] * x[3 * i + k];
                y[j] += term;
                size[j] += fabs(term);
            }
        for (int j = 0; j < 3; j++)
            x[3 * i + j] = !back && f->mirror[j] && fabs(y[j]) < 1e-12 * size[j] ? 0 : y[j];
    }
}

/* The patch and its reflection in the plane S_axis = 0: nodes on the plane are shared. */
static enum pm_status reflect(struct pm_patch *p, int axis, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_patch q = {0};
    int32_t *image = NULL;

    PM_TRY(PM_NEW(image, p->nn, err));
    PM_TRY(PM_NEW(q.S, 6 * p->nn, err));
    PM_TRY(PM_NEW(q.tri, 6 * p->nt, err));
    memcpy(q.S, p->S, 3 * (size_t)p->nn * sizeof *q.S);
    q.nn = p->nn;
    for (ptrdiff_t a = 0; a < p->nn; a++) {
        image[a] = (int32_t)a;
        if (p->S[3 * a + axis] == 0)
            continue;
        memcpy(&q.S[3 * q.nn], &p->S[3 * a], 3 * sizeof *q.S);
        q.S[3 * q.nn + axis] = -q.S[3 * q.nn + axis];
        image[a] = (int32_t)q.nn++;
    }
    for (ptrdiff_t t = 0; t < p->nt; t++) {
        const int32_t *v = &p->tri[3 * t], w[3] = {image[v[0]], image[v[2]], image[v[1]]};
        memcpy(&q.tri[3 * t], v, sizeof w);
        memcpy(&q.tri[3 * (p->nt + t)], w, sizeof w);
    }
    q.nt = 2 * p->nt;
    pm_patch_release(p);
    *p = q;
    memset(&q, 0, sizeof q);
done:
    pm_patch_release(&q);
    pm_free(image);
    return status;
}

/* Half, quarter or eighth of the new nodes with edges near `size`; the paper's points stay what
 * they are while their number is near enough. */
static enum pm_status distribute(const struct pm_surface *s, ptrdiff_t k,
                                 enum surfremesh_method method, const int mirror[3], double size,
                                 int as_many, struct pm_patch *p, struct pm_err *err)
{
    const struct pm_springs_opts paper = {.size = as_many ? 0 : size,
                                          .volume = 0.01,
                                          .sweeps = 100,
                                          .mirror = {mirror[0], mirror[1], mirror[2]}};
    const struct pm_remesh_opts even = {.size = size,
                                        .size_min = size,
                                        .crest = 1,
                                        .growth = 1,
                                        .sweeps = 12,
                                        .mirror = {mirror[0], mirror[1], mirror[2]}};

    pm_patch_release(p);
    return method == SURFREMESH_PAPER ? pm_springs(s, (int)k, &paper, p, err)
                                      : pm_remesh(s, (int)k, &even, p, err);
}

/* New nodes, whole, and within 3 % of `wanted` where the tries suffice. */
static enum pm_status spread(const struct pm_surface *s, ptrdiff_t k, enum surfremesh_method method,
                             const int mirror[3], double wanted, double size, struct pm_patch *p,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double last = 0, step = 0, slope = -2; /* of log count over log size: less on few points */

    for (int attempt = 0; attempt < TRIES; attempt++) {
        const int as_many = attempt == 0 && fabs((double)s->n / wanted - 1) < COUNT_OFF;
        PM_TRY(distribute(s, k, method, mirror, size, as_many, p, err));
        for (int j = 2; j >= 0; j--)
            if (mirror[j])
                PM_TRY(reflect(p, j, err));
        const double error = log((double)p->nn / wanted);
        if (fabs(error) < COUNT_OFF)
            break;
        if (attempt > 0)
            slope = fmax(-3, fmin(-0.7, (error - last) / step));
        last = error;
        step = -error / slope;
        size *= exp(step);
    }
done:
    return status;
}

/* Near conformal parameters of the nodes p by their places on the old surface. */
static enum pm_status conformal(const struct pm_surface *s, const struct frame *f,
                                struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    struct pm_trimesh m = {.nn = p->nn, .nt = p->nt, .tri = p->tri};

    PM_TRY(PM_NEW(m.x, 3 * m.nn, err));
    PM_TRY(pm_map_new(s, &map, err));
    for (ptrdiff_t a = 0; a < m.nn; a++)
        PM_TRY(pm_map_point(map, s->phi, &p->S[3 * a], &work, &m.x[3 * a], NULL, NULL, err));
    turn(f, 0, m.nn, m.x);
    PM_TRY(pm_parametrise_sphere(&m, f->mirror, p->S, err));
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(m.x);
    return status;
}

/* New parameters for the nodes p; those they carry go to *carried. */
static enum pm_status refine(const struct pm_surface *s, ptrdiff_t k, enum surfremesh_method method,
                             const struct frame *f, struct pm_patch *p, double **carried,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int passes;

    if (method == SURFREMESH_REMESH)
        return PM_OK;
    PM_TRY(pm_copy_array(carried, p->S, 3 * p->nn, sizeof *p->S, err));
    if (method == SURFREMESH_CONFORMAL)
        return conformal(s, f, p, err);
    PM_TRY(pm_hemispheres(p->nn, p->S, p->nt, p->tri, &passes, err));
    pm_log(2, "surface %td: %d of 2 hemispheres refined", k, passes);
done:
    return status;
}

/* The new surface of the nodes p, whose parameters of the old one are `carried`. */
static enum pm_status take(const struct pm_surface *from, const struct pm_patch *p,
                           const double *carried, struct pm_surface *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};

    PM_TRY(pm_surface_new(PM_SURFACE_SPHERE, p->nn, p->nt, to, err));
    memcpy(to->Phi, p->S, 3 * (size_t)to->n * sizeof *p->S);
    memcpy(to->tri, p->tri, 3 * (size_t)to->nt * sizeof *p->tri);
    PM_TRY(pm_map_new(from, &map, err));
    for (ptrdiff_t i = 0; i < to->n; i++)
        PM_TRY(
            pm_map_point(map, from->phi, &carried[3 * i], &work, &to->phi[3 * i], NULL, NULL, err));
    PM_TRY(pm_map_support(to->n, to->Phi, PM_MAP_NEIGHBOURS, to->d0, err));
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status pm_chamber_remesh(const struct pm_surfaces *s, ptrdiff_t k,
                                 enum surfremesh_method method, double spacing,
                                 struct pm_surface *to, double **carried, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surface turned = s->s[k]; /* the map knows distances on the sphere only */
    struct pm_patch p = {0};
    struct pm_spacing now;
    struct frame f;

    *carried = NULL;
    turned.Phi = NULL;
    PM_TRY(find_frame(&s->pcase.symmetry, k - 1, &f, err));
    PM_TRY(pm_copy_array(&turned.Phi, s->s[k].Phi, 3 * turned.n, sizeof *turned.Phi, err));
    turn(&f, 0, turned.n, turned.Phi);
    PM_TRY(pm_spacing_of(&turned, &now, err));
    const double wanted = now.area / (sqrt(0.75) * spacing * spacing);
    PM_TRY(spread(&turned, k, method, f.mirror, wanted, spacing, &p, err));
    PM_TRY(refine(&turned, k, method, &f, &p, carried, err));
    turn(&f, 1, p.nn, p.S);
    if (*carried != NULL)
        turn(&f, 1, p.nn, *carried);
    PM_TRY(take(&s->s[k], &p, *carried != NULL ? *carried : p.S, to, err));
done:
    pm_patch_release(&p);
    pm_free(turned.Phi);
    return status;
}
