#include "tools/tetmesh/curve.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/extension.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/quality.h"
#include "tools/tetmesh/relocate.h"
#include "tools/tetmesh/weights.h"

const double pm_curve_bound = 0.2;
static const double room_mean_ratio = 0.2, least_mean_ratio = 0.05;

struct curving {
    const struct pm_surfaces *s;
    const struct pm_shell *shell;
    struct pm_mesh *m;
    struct pm_edges edges;
    ptrdiff_t nv;     /* vertices; mid-side nodes follow in the order of their edges */
    int32_t *owner;   /* surface of an edge, -1 inside the solid or a cap (edges.n) */
    double *straight; /* straight node positions (nn x 3) [mm] */
    double *shift;    /* full displacement from there (nn x 3) [mm] */
    double *t;        /* its factor (nn) */
    struct pm_middles *middles;
};

static void release(struct curving *c)
{
    pm_edges_release(&c->edges);
    pm_free(c->owner);
    pm_free(c->straight);
    pm_free(c->shift);
    pm_free(c->t);
}

/* Node of the middle of (a, b). */
static int32_t middle(const struct curving *c, int32_t a, int32_t b)
{
    return (int32_t)(c->nv + pm_edges_find(&c->edges, a, b));
}

static enum pm_status connect(struct curving *c, const struct pm_tetra *tetra, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    m->ne = tetra->ne;
    m->nn = c->nv + c->edges.n;
    m->npe = 10;
    m->npf = 6;
    PM_TRY(PM_NEW(m->tet, 10 * m->ne, err));
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        int32_t *v = m->tet + 10 * e;
        memcpy(v, tetra->tet + 4 * e, 4 * sizeof *v);
        for (int k = 0; k < 6; k++)
            v[4 + k] = middle(c, v[pm_tet10_edge[k][0]], v[pm_tet10_edge[k][1]]);
    }
    PM_TRY(PM_NEW(c->straight, 3 * m->nn, err));
    memcpy(c->straight, tetra->x, (size_t)(3 * c->nv) * sizeof *c->straight);
    for (ptrdiff_t k = 0; k < c->edges.n; k++)
        for (int i = 0; i < 3; i++)
            c->straight[3 * (c->nv + k) + i] =
                (tetra->x[3 * c->edges.low[k] + i] + tetra->x[3 * c->edges.high[k] + i]) / 2;
done:
    return status;
}

/* The shell's triangles as faces out of the solid; every one must be a free face of the tetrahedra.
 */
static enum pm_status add_faces(struct curving *c, const struct pm_tetra *tetra, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    int32_t *face = NULL, *element = NULL;
    ptrdiff_t n = 0;
    PM_TRY(pm_boundary_faces(tetra->ne, tetra->tet, &n, &face, &element, err));
    m->nf = c->shell->nt;
    if (n != m->nf)
        PM_TRY(pm_fail(err, PM_NUMERIC,
                       "the tetrahedra have %td free faces, the surfaces %td triangles", n, m->nf));
    PM_TRY(PM_NEW(m->tri, 6 * m->nf, err));
    PM_TRY(PM_NEW(m->tri_tag, m->nf, err));
    PM_TRY(PM_NEW(c->owner, c->edges.n, err));
    memset(c->owner, 0xff, (size_t)c->edges.n * sizeof *c->owner);
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *v = c->shell->tri + 3 * f;
        const int flip = c->shell->tag[f] > 0; /* chambers: out of the cavity -> out of the solid */
        int32_t *w = m->tri + 6 * f;
        m->tri_tag[f] = c->shell->tag[f];
        for (int k = 0; k < 3; k++)
            w[k] = v[flip ? (3 - k) % 3 : k];
        for (int k = 0; k < 3; k++) {
            const ptrdiff_t e = pm_edges_find(&c->edges, w[k], w[(k + 1) % 3]);
            if (e < 0)
                PM_TRY(pm_fail(err, PM_NUMERIC, "the tetrahedra lack edge %d-%d of the surfaces",
                               (int)w[k], (int)w[(k + 1) % 3]));
            w[3 + k] = (int32_t)(c->nv + e);
            if (m->tri_tag[f] >= 0)
                c->owner[e] = m->tri_tag[f];
        }
    }
done:
    pm_free(face);
    pm_free(element);
    return status;
}

/* Parameters, owners and full displacements of the surface nodes. */
static enum pm_status find_feet(struct curving *c, struct pm_curve_report *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    const struct pm_shell *shell = c->shell;
    PM_TRY(PM_NEW(m->surface, m->nn, err));
    PM_TRY(PM_NEW(m->S, 3 * m->nn, err));
    PM_TRY(PM_NEW(c->shift, 3 * m->nn, err));
    PM_TRY(PM_NEW(c->t, m->nn, err));
    memset(m->surface, 0xff, (size_t)m->nn * sizeof *m->surface);
    memcpy(m->surface, shell->surface, (size_t)shell->nn * sizeof *m->surface);
    memcpy(m->S, shell->S, (size_t)(3 * shell->nn) * sizeof *m->S);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        c->t[a] = 1;
    for (ptrdiff_t e = 0; e < c->edges.n; e++) {
        const ptrdiff_t a = c->edges.low[e], b = c->edges.high[e], n = c->nv + e, k = c->owner[e];
        const struct pm_edge_ends ends = {{c->straight + 3 * a, c->straight + 3 * b},
                                          {m->S + 3 * a, m->S + 3 * b}};
        double x[3];
        if (k < 0)
            continue;
        PM_TRY(pm_middle_find(c->middles, k, &ends, m->S + 3 * n, x, err));
        m->surface[n] = (int32_t)k;
        for (int i = 0; i < 3; i++)
            c->shift[3 * n + i] = x[i] - c->straight[3 * n + i];
        r->surface_middles++;
    }
done:
    return status;
}

/* Carries the shift of the surface into the interior. */
static enum pm_status extend(struct curving *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_extension *ext = NULL;
    struct pm_mesh straight = *c->m;
    straight.x_generated = c->straight;
    PM_TRY(pm_extension_new(&straight, &ext, err));
    PM_TRY(pm_extension_apply(ext, c->shift, err));
done:
    pm_extension_free(ext);
    return status;
}

static void move(const struct curving *c)
{
    for (ptrdiff_t a = 0; a < c->m->nn; a++)
        for (int i = 0; i < 3; i++)
            c->m->x[3 * a + i] = c->straight[3 * a + i] + c->t[a] * c->shift[3 * a + i];
}

/* One sweep over the elements: factors of those below the bound *= 0.7. Returns their number. */
static ptrdiff_t damp(struct curving *c)
{
    struct pm_mesh *m = c->m;
    ptrdiff_t bad = 0;
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        double X[30];
        pm_quality_gather(m, m->x, e, X);
        if (pm_quality_scaled(X) >= pm_curve_bound)
            continue;
        bad++;
        for (int k = 0; k < 10; k++)
            c->t[m->tet[10 * e + k]] *= 0.7;
    }
    return bad;
}

void pm_curve_quality(const struct pm_mesh *m, const double *x, double *scaled, double *mean_ratio)
{
    *scaled = *mean_ratio = 1;
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        double X[30];
        pm_quality_gather(m, x, e, X);
        *scaled = fmin(*scaled, pm_quality_scaled(X));
        *mean_ratio = fmin(*mean_ratio, pm_quality_mean_ratio(X));
    }
}

/* Vertices inside make room for curved edges, and the middles of edges between them; damping may
 * still draw these back to their chords. Not where straight elements would suffer by that. */
static enum pm_status make_room(struct curving *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_relocate_opts o = {pm_curve_bound, room_mean_ratio, {NULL, NULL}};
    struct pm_mesh *m = c->m;
    ptrdiff_t left;
    double scaled, mean_ratio;
    move(c);
    PM_TRY(pm_relocate(&o, m, &left, err));
    pm_curve_quality(m, m->x, &scaled, &mean_ratio);
    if (mean_ratio < least_mean_ratio)
        goto done;
    for (ptrdiff_t i = 0; i < 3 * c->nv; i++)
        if (m->surface[i / 3] < 0) {
            c->straight[i] = m->x[i];
            c->shift[i] = 0;
        }
    for (ptrdiff_t e = 0; e < c->edges.n; e++)
        for (int i = 0; i < 3; i++) {
            const ptrdiff_t a = 3 * c->edges.low[e] + i, b = 3 * c->edges.high[e] + i,
                            n = 3 * (c->nv + e) + i;
            c->straight[n] = (c->straight[a] + c->straight[b]) / 2;
            if (m->surface[c->nv + e] < 0)
                c->shift[n] = m->x[n] - c->straight[n];
        }
done:
    return status;
}

static enum pm_status untangle(struct curving *c, struct pm_curve_report *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    ptrdiff_t bad = 1;
    PM_TRY(PM_NEW(m->x, 3 * m->nn, err));
    PM_TRY(make_room(c, err));
    for (r->sweeps = 0; bad > 0; r->sweeps++) {
        move(c);
        bad = damp(c);
        if (r->sweeps == 0)
            r->bad = bad;
        if (r->sweeps == 40)
            PM_TRY(pm_fail(err, PM_NUMERIC, "%td elements stay below a scaled Jacobian of %g", bad,
                           pm_curve_bound));
    }
    m->max_damping = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (a < c->nv || m->surface[a] < 0)
            continue;
        const double *d = c->shift + 3 * a;
        m->max_damping = fmax(m->max_damping, 1 - c->t[a]);
        r->off = fmax(r->off, (1 - c->t[a]) * sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        r->damped += c->t[a] < 1;
    }
done:
    return status;
}

/* Rows of weights of all surface nodes; their positions are then exactly those rows times phi, but
 * for the coordinates that are 0 on mirror planes. */
static enum pm_status weigh(struct curving *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    struct pm_weights w = {0};
    m->N = c->s->offset[c->s->ns];
    PM_TRY(pm_weights_init(&w, c->s, m->nn, err));
    for (ptrdiff_t n = 0; n < m->nn; n++) {
        const ptrdiff_t e = n - c->nv;
        const int32_t ends[2] = {e < 0 ? -1 : c->edges.low[e], e < 0 ? -1 : c->edges.high[e]};
        if (m->surface[n] >= 0)
            PM_TRY(pm_weights_add_node(&w, c->middles->map, m, n, ends, e < 0 ? 1 : c->t[n], err));
        PM_TRY(pm_weights_close_row(&w, m->x + 3 * n, err));
    }
    pm_weights_finish(&w, m);
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (ptrdiff_t k = 0; k < m->npf && m->tri_tag[f] <= PM_FACE_SYM_X; k++)
            m->x[3 * (ptrdiff_t)m->tri[m->npf * f + k] + PM_FACE_SYM_X - m->tri_tag[f]] = 0;
done:
    pm_weights_release(&w);
    return status;
}

enum pm_status pm_curve_mesh(struct pm_middles *middles, const struct pm_shell *shell,
                             const struct pm_tetra *tetra, struct pm_mesh *m,
                             struct pm_curve_report *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct curving c = {
        .s = middles->s, .shell = shell, .m = m, .nv = tetra->nn, .middles = middles};
    *r = (struct pm_curve_report){0};
    m->nc = middles->s->ns - 1;
    PM_TRY(pm_edges_new(tetra->nn, tetra->ne, tetra->tet, &c.edges, err));
    PM_TRY(connect(&c, tetra, err));
    PM_TRY(add_faces(&c, tetra, err));
    PM_TRY(find_feet(&c, r, err));
    PM_TRY(extend(&c, err));
    PM_TRY(untangle(&c, r, err));
    PM_TRY(weigh(&c, err));
    PM_TRY(PM_NEW(m->x_generated, 3 * m->nn, err));
    memcpy(m->x_generated, m->x, (size_t)(3 * m->nn) * sizeof *m->x);
done:
    release(&c);
    return status;
}
