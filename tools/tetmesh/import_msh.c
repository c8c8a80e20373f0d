#include "tools/tetmesh/import_msh.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/curve.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/import_check.h"
#include "tools/tetmesh/quality.h"
#include "tools/tetmesh/volume_gmsh.h"

enum { NO_TAG = INT32_MIN };
/* Faces out of the tetrahedron: vertices, middles. */
static const int tet_face[4][6] = {
    {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}};

struct importing {
    struct pm_msh raw;
    struct pm_mesh *m;
    int32_t *place;    /* mesh node of a node of the file, -1: not in the body (raw.nn) */
    int32_t *vertices; /* (ne x 4) */
    int32_t *tag;      /* PM_FACE_* of a group of the file, NO_TAG: not ours (raw.ng) */
};

/* PM_FACE_* of a group's name. */
static int32_t face_tag(const char *name)
{
    static const struct {
        const char *name;
        int32_t tag;
    } known[] = {{"exterior", PM_FACE_EXTERIOR}, {"base", PM_FACE_BASE},
                 {"tip", PM_FACE_TIP},           {"symmetry-x", PM_FACE_SYM_X},
                 {"symmetry-y", PM_FACE_SYM_Y},  {"symmetry-z", PM_FACE_SYM_Z}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(name, known[k].name) == 0)
            return known[k].tag;
    const char *digits = name + 7;
    if (strncmp(name, "chamber", 7) != 0 || *digits < '1' || *digits > '9' ||
        strspn(digits, "0123456789") != strlen(digits))
        return NO_TAG;
    return strlen(digits) > 6 ? INT32_MAX : (int32_t)strtol(digits, NULL, 10);
}

static enum pm_status read_groups(struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int seen[PM_MAX_CHAMBERS + 1] = {0};
    PM_TRY(PM_NEW(c->tag, c->raw.ng, err));
    for (ptrdiff_t g = 0; g < c->raw.ng; g++) {
        c->tag[g] = face_tag(c->raw.name[g]);
        if (c->tag[g] > PM_MAX_CHAMBERS)
            PM_TRY(pm_fail(err, PM_INPUT, "group '%s': expected at most %d chambers",
                           c->raw.name[g], (int)PM_MAX_CHAMBERS));
        if (c->tag[g] > 0)
            seen[c->tag[g]] = 1;
    }
    c->m->nc = 0;
    for (int k = PM_MAX_CHAMBERS; k > 0; k--) {
        if (seen[k] && c->m->nc == 0)
            c->m->nc = k;
        if (!seen[k] && c->m->nc > k)
            PM_TRY(pm_fail(err, PM_INPUT, "there is a group 'chamber%td' but no 'chamber%d'",
                           c->m->nc, k));
    }
done:
    return status;
}

/* Nodes of the body in the order of their numbers. */
static enum pm_status take_nodes(struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    const struct pm_msh *raw = &c->raw;
    PM_TRY(PM_NEW(c->place, raw->nn, err));
    memset(c->place, 0xff, (size_t)raw->nn * sizeof *c->place);
    for (ptrdiff_t k = 0; k < raw->ne * raw->corners; k++)
        c->place[raw->tet[k]] = 0;
    for (ptrdiff_t a = 0; a < raw->nn; a++)
        if (c->place[a] == 0)
            c->place[a] = (int32_t)m->nn++;
    PM_TRY(PM_NEW(m->x, 3 * m->nn, err));
    PM_TRY(PM_NEW(m->tag, m->nn, err));
    for (ptrdiff_t a = 0; a < raw->nn; a++) {
        if (c->place[a] < 0)
            continue;
        memcpy(m->x + 3 * c->place[a], raw->x + 3 * a, 3 * sizeof *m->x);
        m->tag[c->place[a]] = raw->tag[a];
    }
    m->ne = raw->ne;
    m->npe = raw->corners;
    m->npf = raw->corners == 10 ? 6 : 3;
    PM_TRY(PM_NEW(m->tet, m->npe * m->ne, err));
    PM_TRY(PM_NEW(c->vertices, 4 * m->ne, err));
    for (ptrdiff_t k = 0; k < m->npe * m->ne; k++)
        m->tet[k] = c->place[raw->tet[k]];
    for (ptrdiff_t e = 0; e < m->ne; e++)
        memcpy(c->vertices + 4 * e, m->tet + m->npe * e, 4 * sizeof *c->vertices);
done:
    return status;
}

static enum pm_status grow(struct pm_mesh *m, ptrdiff_t nn, struct pm_err *err)
{
    PM_GROW(m->x, 3 * nn, err);
    PM_GROW(m->tag, nn, err);
    PM_GROW(m->tet, 10 * m->ne, err);
    m->nn = nn;
    m->npe = 10;
    m->npf = 6;
    return PM_OK;
}

/* 10 nodes for 4: the middles of the straight edges follow the vertices. */
static enum pm_status promote(struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    struct pm_edges edges = {0};
    const ptrdiff_t nv = m->nn;
    PM_TRY(pm_edges_new(nv, m->ne, c->vertices, &edges, err));
    PM_TRY(grow(m, nv + edges.n, err));
    for (ptrdiff_t k = 0; k < edges.n; k++) {
        double *x = m->x + 3 * (nv + k);
        m->tag[nv + k] = 0;
        for (int i = 0; i < 3; i++)
            x[i] = (m->x[3 * edges.low[k] + i] + m->x[3 * edges.high[k] + i]) / 2;
    }
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        int32_t *v = m->tet + 10 * e;
        memcpy(v, c->vertices + 4 * e, 4 * sizeof *v);
        for (int k = 0; k < 6; k++)
            v[4 + k] = (int32_t)(nv + pm_edges_find(&edges, v[pm_tet10_edge[k][0]],
                                                    v[pm_tet10_edge[k][1]]));
    }
done:
    pm_edges_release(&edges);
    return status;
}

/* Free faces of the tetrahedra, all exterior so far. */
static enum pm_status take_faces(struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    int32_t *face = NULL, *element = NULL;
    PM_TRY(pm_boundary_faces(m->ne, c->vertices, &m->nf, &face, &element, err));
    PM_TRY(PM_NEW(m->tri, m->npf * m->nf, err));
    PM_TRY(PM_NEW(m->tri_tag, m->nf, err));
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *v = m->tet + m->npe * (ptrdiff_t)element[f];
        int side = 0;
        for (int s = 0; s < 4; s++)
            if (v[tet_face[s][0]] == face[3 * f] && v[tet_face[s][1]] == face[3 * f + 1] &&
                v[tet_face[s][2]] == face[3 * f + 2])
                side = s;
        for (ptrdiff_t k = 0; k < m->npf; k++)
            m->tri[m->npf * f + k] = v[tet_face[side][k]];
        m->tri_tag[f] = NO_TAG;
    }
done:
    pm_free(face);
    pm_free(element);
    return status;
}

struct key {
    int32_t v[3];
    ptrdiff_t f;
};

static int ascending(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int by_key(const void *a, const void *b)
{
    const struct key *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->v[k] != q->v[k])
            return p->v[k] < q->v[k] ? -1 : 1;
    return 0;
}

static enum pm_status tag_face(struct importing *c, const struct key *keys, ptrdiff_t t,
                               struct pm_err *err)
{
    struct pm_mesh *m = c->m;
    const int32_t *v = c->raw.tri + 3 * t, g = c->raw.group[t];
    struct key k = {{c->place[v[0]], c->place[v[1]], c->place[v[2]]}, 0};
    if (c->tag[g] == NO_TAG)
        return PM_OK;
    qsort(k.v, 3, sizeof k.v[0], ascending);
    const struct key *found = bsearch(&k, keys, (size_t)m->nf, sizeof k, by_key);
    if (found == NULL)
        return pm_fail(
            err, PM_INPUT,
            "group '%s': the triangle of nodes %lld %lld %lld is not on the boundary of the body",
            c->raw.name[g], (long long)c->raw.tag[v[0]], (long long)c->raw.tag[v[1]],
            (long long)c->raw.tag[v[2]]);
    if (m->tri_tag[found->f] != NO_TAG && m->tri_tag[found->f] != c->tag[g])
        return pm_fail(err, PM_INPUT,
                       "group '%s': the triangle of nodes %lld %lld %lld is in another group too",
                       c->raw.name[g], (long long)c->raw.tag[v[0]], (long long)c->raw.tag[v[1]],
                       (long long)c->raw.tag[v[2]]);
    m->tri_tag[found->f] = c->tag[g];
    return PM_OK;
}

static enum pm_status tag_faces(struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    struct key *keys = NULL;
    PM_TRY(PM_NEW(keys, m->nf, err));
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        memcpy(keys[f].v, m->tri + m->npf * f, sizeof keys[f].v);
        qsort(keys[f].v, 3, sizeof keys[f].v[0], ascending);
        keys[f].f = f;
    }
    qsort(keys, (size_t)m->nf, sizeof *keys, by_key);
    for (ptrdiff_t t = 0; t < c->raw.nt; t++)
        PM_TRY(tag_face(c, keys, t, err));
done:
    pm_free(keys);
    return status;
}

/* Faces in no group are exterior, unless that group is given. */
static enum pm_status tag_others(const struct importing *c, struct pm_err *err)
{
    struct pm_mesh *m = c->m;
    int exterior = 0;
    for (ptrdiff_t g = 0; g < c->raw.ng; g++)
        exterior |= c->tag[g] == PM_FACE_EXTERIOR;
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *v = m->tri + m->npf * f;
        if (m->tri_tag[f] == NO_TAG && exterior)
            return pm_fail(
                err, PM_INPUT, "the boundary face of nodes %lld %lld %lld is in no group",
                (long long)m->tag[v[0]], (long long)m->tag[v[1]], (long long)m->tag[v[2]]);
        if (m->tri_tag[f] == NO_TAG)
            m->tri_tag[f] = PM_FACE_EXTERIOR;
    }
    return PM_OK;
}

/* Centroid of the tip of the whole body: that of the faces of the tip, moved to the symmetry
 * planes. */
static void find_reference(struct pm_mesh *m)
{
    double sum[3] = {0}, area = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        if (m->tri_tag[f] == PM_FACE_TIP)
            pm_quality_face(m, f, &area, sum);
    for (int i = 0; i < 3; i++)
        m->reference_point[i] = area > 0 ? sum[i] / area : 0;
    for (ptrdiff_t f = 0; f < m->nf && area > 0; f++) {
        const int axis = PM_FACE_SYM_X - m->tri_tag[f];
        if (axis >= 0 && axis < 3)
            m->reference_point[axis] = m->x[3 * (ptrdiff_t)m->tri[m->npf * f] + axis];
    }
}

/* No surface, no weights. */
static enum pm_status finish(const struct importing *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh *m = c->m;
    double mean_ratio;
    PM_TRY(PM_NEW(m->surface, m->nn, err));
    memset(m->surface, 0xff, (size_t)m->nn * sizeof *m->surface);
    PM_TRY(PM_NEW(m->S, 3 * m->nn, err));
    PM_TRY(PM_NEW(m->wptr, m->nn + 1, err));
    PM_TRY(PM_NEW(m->wcol, 0, err));
    PM_TRY(PM_NEW(m->wval, 0, err));
    PM_TRY(PM_NEW(m->x_generated, 3 * m->nn, err));
    memcpy(m->x_generated, m->x, (size_t)(3 * m->nn) * sizeof *m->x);
    find_reference(m);
    m->origin = PM_ORIGIN_IMPORTED;
    pm_curve_quality(m, m->x, &m->min_jacobian, &mean_ratio);
    if (m->min_jacobian <= 0)
        pm_warn(
            "an element may be inverted between its nodes: lower bound of the scaled Jacobian %.3f",
            m->min_jacobian);
    for (ptrdiff_t g = 0; g < c->raw.ng; g++)
        if (c->tag[g] == NO_TAG)
            pm_warn("group '%s' is not used", c->raw.name[g]);
done:
    return status;
}

/* gmsh runs other files as scripts: only a mesh may pass. */
static enum pm_status check_header(const char *path, struct pm_err *err)
{
    char head[16] = "";
    FILE *f = fopen(path, "rb");
    if (f == NULL)
        return pm_fail(err, PM_INPUT, "%s", strerror(errno));
    const size_t n = fread(head, 1, sizeof head - 1, f);
    fclose(f);
    if (n < 11 || strncmp(head, "$MeshFormat", 11) != 0)
        return pm_fail(err, PM_INPUT, "it does not begin with $MeshFormat");
    return PM_OK;
}

static enum pm_status import(const char *path, int promote_it, struct pm_mesh *m,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct importing c = {.m = m};
    PM_TRY(check_header(path, err));
    PM_TRY(pm_gmsh_read(path, &c.raw, err));
    if (c.raw.corners == 10 && promote_it)
        PM_TRY(pm_fail(err, PM_USAGE,
                       "--promote: the tetrahedra of group 'body' have 10 nodes already, expected "
                       "4"));
    PM_TRY(read_groups(&c, err));
    PM_TRY(take_nodes(&c, err));
    PM_TRY(pm_import_check_nodes(m, err));
    if (promote_it)
        PM_TRY(promote(&c, err));
    PM_TRY(pm_import_check_elements(m, err));
    PM_TRY(pm_import_check_parts(m, c.vertices, err));
    PM_TRY(pm_import_check_middles(m, c.vertices, err));
    PM_TRY(take_faces(&c, err));
    PM_TRY(tag_faces(&c, err));
    PM_TRY(pm_import_check_held(m, err));
    PM_TRY(tag_others(&c, err));
    PM_TRY(pm_import_check_planes(m, err));
    PM_TRY(pm_import_check_closed(m, err));
    PM_TRY(finish(&c, err));
done:
    pm_msh_release(&c.raw);
    pm_free(c.place);
    pm_free(c.vertices);
    pm_free(c.tag);
    return status;
}

enum pm_status pm_import_msh(const char *path, int promote_it, struct pm_mesh *m,
                             struct pm_err *err)
{
    struct pm_err why = {.status = PM_OK};
    const enum pm_status status = import(path, promote_it, m, &why);
    return status == PM_OK ? PM_OK
                           : pm_fail(err, status, "cannot use '%s': %.400s", path, why.text);
}
