#include "tools/surfremesh/chamber.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/remesh.h"

enum { TRIES = 4 };

/* Planes S_j = 0 that mirror operations keep for chamber k (0-based). Its rotations, if any, must
 * be their products. */
static enum pm_status mirrors(const struct pm_symmetry *y, ptrdiff_t k, int mirror[3],
                              struct pm_err *err)
{
    ptrdiff_t kept = 0, made = 1;

    memset(mirror, 0, 3 * sizeof *mirror);
    for (ptrdiff_t g = 0; g < y->nops; g++) {
        const double *Q = y->Q[g];
        int minus = (Q[0] < 0) + (Q[4] < 0) + (Q[8] < 0);
        if (y->chamber[g][k] != k)
            continue;
        kept++;
        if (fabs(Q[0]) == 1 && fabs(Q[4]) == 1 && fabs(Q[8]) == 1 && minus == 1)
            mirror[Q[0] < 0 ? 0 : Q[4] < 0 ? 1 : 2] = 1;
    }
    for (int j = 0; j < 3; j++)
        made *= mirror[j] ? 2 : 1;
    if (kept != made)
        return pm_fail(
            err, PM_NUMERIC,
            "cannot remesh chamber %td: %td operations keep it, its coordinate mirrors make %td",
            k + 1, kept, made);
    return PM_OK;
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

/* Remeshed, whole again, with a count of nodes within 3 % of `wanted` where four tries suffice. */
static enum pm_status spread(const struct pm_surface *s, ptrdiff_t k, const int mirror[3],
                             double wanted, double size, struct pm_patch *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (int attempt = 0; attempt < TRIES; attempt++) {
        const struct pm_remesh_opts o = {.size = size,
                                         .size_min = size,
                                         .crest = 1,
                                         .growth = 1,
                                         .sweeps = 12,
                                         .mirror = {mirror[0], mirror[1], mirror[2]}};
        pm_patch_release(p);
        PM_TRY(pm_remesh(s, (int)k, &o, p, err));
        for (int j = 2; j >= 0; j--)
            if (mirror[j])
                PM_TRY(reflect(p, j, err));
        if (fabs((double)p->nn / wanted - 1) < 0.03)
            break;
        size *= sqrt((double)p->nn / wanted);
    }
done:
    return status;
}

static enum pm_status take(const struct pm_surface *from, const struct pm_patch *p,
                           struct pm_surface *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};

    *to = (struct pm_surface){.type = PM_SURFACE_SPHERE, .n = p->nn, .nt = p->nt};
    PM_TRY(PM_NEW(to->phi, 3 * to->n, err));
    PM_TRY(PM_NEW(to->free, 3 * to->n, err));
    PM_TRY(PM_NEW(to->Phi, 3 * to->n, err));
    PM_TRY(PM_NEW(to->d0, to->n, err));
    PM_TRY(PM_NEW(to->tri, 3 * to->nt, err));
    memset(to->free, 1, 3 * (size_t)to->n);
    memcpy(to->Phi, p->S, 3 * (size_t)to->n * sizeof *to->Phi);
    memcpy(to->tri, p->tri, 3 * (size_t)to->nt * sizeof *to->tri);
    PM_TRY(pm_map_new(from, &map, err));
    for (ptrdiff_t i = 0; i < to->n; i++)
        PM_TRY(
            pm_map_point(map, from->phi, &to->Phi[3 * i], &work, &to->phi[3 * i], NULL, NULL, err));
    PM_TRY(pm_map_support(to->n, to->Phi, PM_MAP_NEIGHBOURS, to->d0, err));
done:
    pm_map_free(map);
    pm_basis_release(&work);
    return status;
}

enum pm_status pm_chamber_remesh(const struct pm_surfaces *s, ptrdiff_t k, double spacing,
                                 struct pm_surface *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_patch p = {0};
    struct pm_spacing now;
    int mirror[3];

    PM_TRY(mirrors(&s->pcase.symmetry, k - 1, mirror, err));
    PM_TRY(pm_spacing_of(&s->s[k], &now, err));
    PM_TRY(
        spread(&s->s[k], k, mirror, now.area / (sqrt(0.75) * spacing * spacing), spacing, &p, err));
    PM_TRY(take(&s->s[k], &p, to, err));
done:
    pm_patch_release(&p);
    return status;
}

static double distance(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Heron's formula, safe against rounding of flat triangles. */
static double area_of(double a, double b, double c)
{
    double h = (a + b + c) / 2;

    return sqrt(fmax(0, h * (h - a) * (h - b) * (h - c)));
}

enum pm_status pm_spacing_of(const struct pm_surface *s, struct pm_spacing *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *x = NULL, square = 0;

    *out = (struct pm_spacing){0};
    PM_TRY(pm_map_new(s, &map, err));
    PM_TRY(PM_NEW(x, 3 * s->n, err));
    for (ptrdiff_t i = 0; i < s->n; i++)
        PM_TRY(pm_map_point(map, s->phi, &s->Phi[3 * i], &work, &x[3 * i], NULL, NULL, err));
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double l[3];
        for (int j = 0; j < 3; j++) {
            l[j] = distance(&x[3 * (ptrdiff_t)s->tri[3 * t + j]],
                            &x[3 * (ptrdiff_t)s->tri[3 * t + (j + 1) % 3]]);
            out->mean += l[j] / (3 * (double)s->nt);
            square += l[j] * l[j] / (3 * (double)s->nt);
            out->longest = fmax(out->longest, l[j]);
        }
        out->area += area_of(l[0], l[1], l[2]);
    }
    out->cv = sqrt(fmax(0, square - out->mean * out->mean)) / out->mean;
    out->longest /= out->mean;
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(x);
    return status;
}
