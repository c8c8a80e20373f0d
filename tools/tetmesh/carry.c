#include "tools/tetmesh/carry.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/cloud.h"
#include "common/geometry/samples.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/middle.h"
#include "tools/tetmesh/weights.h"

static const double ON_PLANE = 1e-9; /* [mm] */

struct carrying {
    const struct pm_surfaces *s;
    struct pm_mesh *m;
    struct pm_middles middles;
    int32_t *ends; /* of the edge of a mid-side node on a surface, -1 of others (nn x 2) */
    double *S;     /* new parameters (nn x 3) */
    double *off;   /* way from a node to its foot (nn) [mm] */
    double *t;     /* (nn) */
};

static void release(struct carrying *c)
{
    pm_middles_release(&c->middles);
    pm_free(c->ends);
    pm_free(c->S);
    pm_free(c->off);
    pm_free(c->t);
}

static enum pm_status init(struct carrying *c, unsigned planes, struct pm_err *err)
{
    static const int side[3][2] = {{0, 1}, {1, 2}, {2, 0}};
    enum pm_status status;
    const struct pm_mesh *m = c->m;

    PM_TRY(pm_middles_init(&c->middles, c->s, planes, err));
    PM_TRY(PM_NEW(c->ends, 2 * m->nn, err));
    PM_TRY(PM_NEW(c->S, 3 * m->nn, err));
    PM_TRY(PM_NEW(c->off, m->nn, err));
    PM_TRY(PM_NEW(c->t, m->nn, err));
    memset(c->ends, 0xff, (size_t)(2 * m->nn) * sizeof *c->ends);
    for (ptrdiff_t k = 0; k < 3 * m->nf; k++) {
        const int32_t *v = m->tri + 6 * (k / 3), a = v[3 + k % 3];
        for (int j = 0; j < 2 && m->tri_tag[k / 3] >= 0; j++)
            c->ends[2 * a + j] = v[side[k % 3][j]];
    }
done:
    return status;
}

/* Rims (remesh.h) of node a. */
static unsigned rims_of(const struct carrying *c, ptrdiff_t a)
{
    const int32_t type = c->s->s[c->m->surface[a]].type;
    const double *S = c->m->S + 3 * a, *x = c->m->x + 3 * a;
    unsigned rims = 0;
    if (type == PM_SURFACE_BSPLINE)
        rims = S[2] == 0 ? 1 : S[2] == 1 ? 2 : 0;
    for (int j = 0; j < 2; j++)
        if (c->middles.planes >> j & 1 && fabs(x[j]) < ON_PLANE)
            rims |= pm_rim_plane(type, j);
    return rims;
}

static double distance(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

/* The foot of node a from S on, with steps for edges of `chord` mm; r (3): the foot [mm]. */
static enum pm_status find_foot(struct carrying *c, ptrdiff_t a, double chord, const double *S,
                                double r[3], struct pm_err *err)
{
    enum pm_status status;
    const int32_t k = c->m->surface[a];
    double *to = c->S + 3 * a;

    memmove(to, S, 3 * sizeof *to);
    PM_TRY(pm_middle_foot(&c->middles, k, rims_of(c, a), c->m->x + 3 * a, chord, to, err));
    PM_TRY(
        pm_map_point(c->middles.map[k], c->s->s[k].phi, to, &c->middles.basis, r, NULL, NULL, err));
    c->off[a] = distance(r, c->m->x + 3 * a);
    c->t[a] = 1;
done:
    return status;
}

/* Feet of the vertices on surface k, from the nearest of its samples. */
static enum pm_status find_vertices(struct carrying *c, const struct pm_cloud *nodes,
                                    const struct pm_samples *samples, const double *x, ptrdiff_t k,
                                    struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *m = c->m;
    const ptrdiff_t first = samples->first[k];
    const struct pm_look look = {.cutoff = INFINITY};
    struct pm_cloud *to = NULL;
    unsigned char *wanted = NULL;
    int32_t *found = NULL;
    double *far = NULL, r[3];

    PM_TRY(PM_NEW(wanted, m->nn, err));
    PM_TRY(PM_NEW(found, m->nn, err));
    PM_TRY(PM_NEW(far, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        wanted[a] = m->surface[a] == k && c->ends[2 * a] < 0;
    PM_TRY(pm_cloud_new(samples->first[k + 1] - first, x + 3 * first, NULL, &to, err));
    pm_cloud_look(nodes, wanted, to, &look, found, far);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (wanted[a])
            PM_TRY(
                find_foot(c, a, m->pcase.mesh_size, samples->S + 3 * (first + found[a]), r, err));
done:
    pm_cloud_free(to);
    pm_free(wanted);
    pm_free(found);
    pm_free(far);
    return status;
}

static enum pm_status find_all_vertices(struct carrying *c, struct pm_err *err)
{
    enum pm_status status;
    struct pm_samples samples = {0};
    struct pm_cloud *nodes = NULL;
    double *phi = NULL, *x = NULL;

    PM_TRY(pm_samples_new(c->s, HUGE_VAL, 2, &samples, err));
    PM_TRY(PM_NEW(phi, 3 * c->s->offset[c->s->ns], err));
    PM_TRY(PM_NEW(x, 3 * samples.n, err));
    pm_surfaces_gather(c->s, phi);
    pm_samples_all(&samples, phi, x, NULL);
    PM_TRY(pm_cloud_new(c->m->nn, c->m->x, NULL, &nodes, err));
    for (ptrdiff_t k = 0; k < c->s->ns; k++)
        PM_TRY(find_vertices(c, nodes, &samples, x, k, err));
done:
    pm_samples_release(&samples);
    pm_cloud_free(nodes);
    pm_free(phi);
    pm_free(x);
    return status;
}

/* After the vertices, of which none lies further off than `furthest` mm. */
static enum pm_status find_middle(struct carrying *c, ptrdiff_t a, double furthest,
                                  struct pm_err *err)
{
    enum pm_status status;
    const int32_t type = c->s->s[c->m->surface[a]].type, *v = c->ends + 2 * a;
    const double *x = c->m->x, *xa = x + 3 * v[0], *xb = x + 3 * v[1];
    double S[3], r[3], along = 0, length2 = 0;

    pm_map_middle(type, c->S + 3 * v[0], c->S + 3 * v[1], S);
    PM_TRY(find_foot(c, a, distance(xa, xb), S, r, err));
    if (c->off[a] <= furthest)
        return PM_OK;
    for (int i = 0; i < 3; i++) {
        const double middle = (xa[i] + xb[i]) / 2;
        along += (x[3 * a + i] - middle) * (r[i] - middle);
        length2 += (r[i] - middle) * (r[i] - middle);
    }
    c->t[a] = length2 > 0 ? fmin(fmax(along / length2, 0), 1) : 1;
done:
    return status;
}

static enum pm_status weigh(struct carrying *c, struct pm_err *err)
{
    enum pm_status status;
    struct pm_mesh *m = c->m;
    struct pm_weights w = {0};
    double x[3];

    memcpy(m->S, c->S, (size_t)(3 * m->nn) * sizeof *m->S);
    PM_TRY(pm_weights_init(&w, c->s, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (m->surface[a] >= 0)
            PM_TRY(pm_weights_add_node(&w, c->middles.map, m, a, c->ends + 2 * a, c->t[a], err));
        PM_TRY(pm_weights_close_row(&w, x, err));
    }
    pm_free(m->wptr);
    pm_free(m->wcol);
    pm_free(m->wval);
    pm_weights_finish(&w, m);
    m->N = c->s->offset[c->s->ns];
done:
    pm_weights_release(&w);
    return status;
}

enum pm_status pm_mesh_carry(const struct pm_surfaces *s, unsigned planes, struct pm_mesh *m,
                             struct pm_carry_report *r, struct pm_err *err)
{
    enum pm_status status;
    struct carrying c = {.s = s, .m = m};

    *r = (struct pm_carry_report){0};
    PM_TRY(init(&c, planes, err));
    PM_TRY(find_all_vertices(&c, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        r->furthest = fmax(r->furthest, c.off[a]);
    m->max_damping = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (c.ends[2 * a] >= 0) {
            PM_TRY(find_middle(&c, a, r->furthest, err));
            m->max_damping = fmax(m->max_damping, 1 - c.t[a]);
            r->damped += c.t[a] < 1;
        }
    PM_TRY(weigh(&c, err));
done:
    release(&c);
    return status;
}
