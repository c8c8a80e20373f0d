/* The only user of gmshc.h. */
#include "tools/tetmesh/volume_gmsh.h"

#include <assert.h>
#include <gmshc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/tetmesh/isolate.h"

enum {
    GMSH_TRIANGLE = 2,
    GMSH_TRIANGLE_6 = 9,
    GMSH_TETRAHEDRON = 4,
    GMSH_TETRAHEDRON_10 = 11,
    ALGORITHM_DELAUNAY = 1,
    ALGORITHM_HXT = 10
};

/* gmsh's last message as our failure. */
static enum pm_status translate(const char *what, struct pm_err *err)
{
    char *text = NULL;
    int ierr = 0;
    gmshLoggerGetLastError(&text, &ierr);
    const enum pm_status status =
        pm_fail(err, PM_NUMERIC, "%s: gmsh says '%s'", what, text != NULL ? text : "nothing");
    gmshFree(text);
    return status;
}

#define GMSH(call, what)                                                                           \
    do {                                                                                           \
        int ierr = 0;                                                                              \
        call;                                                                                      \
        if (ierr != 0) {                                                                           \
            status = translate(what, err);                                                         \
            goto done;                                                                             \
        }                                                                                          \
    } while (0)

/* gmsh orders vertices by their addresses, so its meshes depend on what was freed before: FLTK,
 * which it starts, allocates as it finds the preferences of the user, and these are shared by all
 * processes. Taking all free pieces off the heap makes later addresses ascend. The process ends
 * soon. */
static void settle_heap(void)
{
    enum { SMALLEST = 16, LARGEST = 1024, PIECES = 1000 };
    static void *chain;
    for (size_t size = SMALLEST; size <= LARGEST; size += SMALLEST)
        for (int k = 0; k < PIECES; k++) {
            void **piece = malloc(size);
            if (piece == NULL)
                return;
            *piece = chain;
            chain = piece;
        }
}

static enum pm_status start(struct pm_err *err)
{
    enum pm_status status = PM_OK;
    static const struct {
        const char *name;
        double value;
    } options[] = {{"General.Terminal", 0},        {"General.NumThreads", 1},
                   {"General.AbortOnError", 0},    {"Mesh.MaxNumThreads3D", 1},
                   {"Mesh.Renumber", 0},           {"Mesh.Optimize", 1},
                   {"Mesh.MeshSizeFromPoints", 1}, {"Mesh.MeshSizeExtendFromBoundary", 1}};
    GMSH(gmshInitialize(0, NULL, 0, &ierr), "cannot start gmsh");
    for (size_t k = 0; k < sizeof options / sizeof options[0]; k++)
        GMSH(gmshOptionSetNumber(options[k].name, options[k].value, &ierr), "cannot set up gmsh");
    settle_heap();
done:
    return status;
}

static enum pm_status blob(struct pm_blob *b, ptrdiff_t n, size_t size, struct pm_err *err)
{
    b->data = pm_calloc(n, size, err);
    b->bytes = n * (ptrdiff_t)size;
    return b->data != NULL ? PM_OK : PM_SYSTEM;
}

/* Nodes of the current model, tag t at place t - 1 for t <= fixed, others after in the order of
 * their tags. place (highest tag + 1): where each tag went. */
static enum pm_status get_nodes(ptrdiff_t fixed, struct pm_blob *x, int32_t **place,
                                size_t *highest, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    size_t *tag = NULL, n = 0, nx = 0, np = 0;
    double *coord = NULL, *param = NULL;
    GMSH(gmshModelMeshGetNodes(&tag, &n, &coord, &nx, &param, &np, -1, -1, 0, 0, &ierr),
         "no nodes");
    *highest = 0;
    for (size_t k = 0; k < n; k++)
        *highest = tag[k] > *highest ? tag[k] : *highest;
    if (n > (size_t)INT32_MAX || *highest > 64 * n + 1000) {
        status = pm_fail(err, PM_NUMERIC, "gmsh numbers %zu nodes up to %zu", n, *highest);
        goto done;
    }
    PM_TRY(blob(x, 3 * (ptrdiff_t)n, sizeof(double), err));
    PM_TRY(PM_NEW(*place, *highest + 1, err));
    for (size_t t = 0; t <= *highest; t++)
        (*place)[t] = -1;
    for (size_t k = 0; k < n; k++)
        (*place)[tag[k]] = 0;
    int32_t next = 0;
    for (size_t t = 1; t <= *highest; t++)
        if ((*place)[t] == 0)
            (*place)[t] = next++;
    if (fixed > 0 && (*highest < (size_t)fixed || (*place)[fixed] != fixed - 1))
        PM_TRY(pm_fail(err, PM_NUMERIC, "gmsh dropped nodes of the surface"));
    for (size_t k = 0; k < n; k++)
        memcpy((double *)x->data + 3 * (*place)[tag[k]], coord + 3 * k, 3 * sizeof(double));
done:
    gmshFree(tag);
    gmshFree(coord);
    gmshFree(param);
    return status;
}

/* Elements of one type in places of nodes. */
static enum pm_status get_elements(int type, int corners, const int32_t *place, size_t highest,
                                   struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    size_t *element = NULL, ne = 0, *node = NULL, nn = 0;
    assert(place != NULL);
    GMSH(gmshModelMeshGetElementsByType(type, &element, &ne, &node, &nn, -1, 0, 1, &ierr),
         "no elements");
    if (ne == 0 || nn != ne * (size_t)corners)
        PM_TRY(pm_fail(err, PM_NUMERIC, "gmsh made no elements"));
    PM_TRY(blob(out, (ptrdiff_t)nn, sizeof(int32_t), err));
    for (size_t k = 0; k < nn; k++) {
        if (node[k] > highest || place[node[k]] < 0)
            PM_TRY(
                pm_fail(err, PM_NUMERIC, "gmsh refers to node %zu, which does not exist", node[k]));
        ((int32_t *)out->data)[k] = place[node[k]];
    }
done:
    gmshFree(element);
    gmshFree(node);
    return status;
}

struct planar_job {
    const struct pm_outline *in;
    double size;
};

/* Points, lines and loops of the outline; loop (nloops) gets their tags. */
static enum pm_status draw(const struct planar_job *job, int *curve, int *loop, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_outline *in = job->in;
    for (int k = 0; k < (int)in->nn; k++) {
        const double *p = in->x + 2 * k;
        GMSH(gmshModelGeoAddPoint(p[0], p[1], 0, job->size, k + 1, &ierr), "planar face");
        curve[k] = k + 1;
    }
    for (int l = 0; l < (int)in->nloops; l++) {
        const int first = (int)in->first[l], n = (int)in->first[l + 1] - first;
        for (int k = 0; k < n; k++) {
            const int line = first + k + 1, next = first + (k + 1) % n + 1;
            GMSH(gmshModelGeoAddLine(line, next, line, &ierr), "planar face");
            GMSH(gmshModelGeoMeshSetTransfiniteCurve(line, 2, "Progression", 1, &ierr),
                 "planar face");
        }
        loop[l] = l + 1;
        GMSH(gmshModelGeoAddCurveLoop(curve + first, (size_t)n, loop[l], 0, &ierr), "planar face");
    }
done:
    return status;
}

static enum pm_status planar_job(const void *arg, struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct planar_job *job = arg;
    const struct pm_outline *in = job->in;
    struct pm_blob x = {NULL, 0};
    int32_t *place = NULL;
    int *curve = NULL, *loop = NULL;
    size_t highest = 0;
    PM_TRY(start(err));
    PM_TRY(PM_NEW(curve, in->nn, err));
    PM_TRY(PM_NEW(loop, in->nloops, err));
    PM_TRY(draw(job, curve, loop, err));
    GMSH(gmshModelGeoAddPlaneSurface(loop, (size_t)in->nloops, 1, &ierr), "planar face");
    GMSH(gmshModelGeoSynchronize(&ierr), "planar face");
    GMSH(gmshModelMeshGenerate(2, &ierr), "cannot mesh a planar face");
    PM_TRY(get_nodes(in->nn, &x, &place, &highest, err));
    PM_TRY(get_elements(GMSH_TRIANGLE, 3, place, highest, &out[1], err));
    const ptrdiff_t nn = x.bytes / (ptrdiff_t)(3 * sizeof(double));
    PM_TRY(blob(&out[0], 2 * nn, sizeof(double), err));
    for (ptrdiff_t k = 0; k < 2 * nn; k++)
        ((double *)out[0].data)[k] = ((double *)x.data)[3 * (k / 2) + k % 2];
    /* gmsh numbers the nodes of points first and in their order */
    for (ptrdiff_t k = 0; k < 2 * in->nn; k++)
        if (fabs(((double *)out[0].data)[k] - in->x[k]) > 1e-9)
            PM_TRY(pm_fail(err, PM_NUMERIC, "gmsh moved corner %td of a planar face", k / 2));
done:
    pm_free(x.data);
    pm_free(curve);
    pm_free(loop);
    pm_free(place);
    return status;
}

enum pm_status pm_gmsh_planar(const struct pm_outline *in, double size, double timeout,
                              struct pm_planar *out, struct pm_err *err)
{
    struct pm_blob b[PM_MAX_BLOBS];
    const struct planar_job job = {in, size};
    const enum pm_status status = pm_isolate(planar_job, &job, timeout, b, err);
    *out = (struct pm_planar){0};
    if (status != PM_OK)
        return status;
    out->nn = b[0].bytes / (ptrdiff_t)(2 * sizeof(double));
    out->nt = b[1].bytes / (ptrdiff_t)(3 * sizeof(int32_t));
    out->x = b[0].data;
    out->tri = b[1].data;
    b[0].data = b[1].data = NULL;
    pm_blobs_release(b);
    return status;
}

/* One discrete surface per shell; a shell's nodes belong to its first triangle's surface. */
static enum pm_status add_shell(const struct pm_gmsh_input *in, int32_t shell, uint8_t *given,
                                struct pm_err *err)
{
    enum pm_status status = PM_OK;
    size_t *tag = NULL, *node = NULL, n = 0, nn = 0;
    double *coord = NULL;
    PM_TRY(PM_NEW(tag, in->nn, err));
    PM_TRY(PM_NEW(coord, 3 * in->nn, err));
    PM_TRY(PM_NEW(node, 3 * in->nt, err));
    for (ptrdiff_t t = 0; t < in->nt; t++) {
        for (int k = 0; k < 3 && in->shell[t] == shell; k++) {
            const int32_t a = in->tri[3 * t + k];
            node[nn++] = (size_t)a + 1;
            if (given[a])
                continue;
            given[a] = 1;
            tag[n] = (size_t)a + 1;
            memcpy(coord + 3 * n, in->x + 3 * a, 3 * sizeof *coord);
            n++;
        }
    }
    const int surface = shell + 1;
    GMSH(gmshModelAddDiscreteEntity(2, surface, NULL, 0, &ierr), "surface");
    GMSH(gmshModelMeshAddNodes(2, surface, tag, n, coord, 3 * n, NULL, 0, &ierr), "surface");
    GMSH(gmshModelMeshAddElementsByType(surface, GMSH_TRIANGLE, NULL, 0, node, nn, &ierr),
         "surface");
done:
    pm_free(tag);
    pm_free(coord);
    pm_free(node);
    return status;
}

static enum pm_status fill(const struct pm_gmsh_input *in, int algorithm, struct pm_blob *out,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    uint8_t *given = NULL;
    int32_t *place = NULL;
    int *loop = NULL;
    size_t highest = 0;
    GMSH(gmshClear(&ierr), "clear");
    GMSH(gmshOptionSetNumber("Mesh.Algorithm3D", algorithm, &ierr), "algorithm");
    PM_TRY(PM_NEW(given, in->nn, err));
    PM_TRY(PM_NEW(loop, in->nshells, err));
    for (int32_t s = 0; s < in->nshells; s++)
        PM_TRY(add_shell(in, s, given, err));
    for (int32_t s = 0; s < in->nshells; s++) {
        int surface = s + 1;
        loop[s] = surface;
        GMSH(gmshModelGeoAddSurfaceLoop(&surface, 1, surface, &ierr), "surface loop");
    }
    GMSH(gmshModelGeoAddVolume(loop, (size_t)in->nshells, 1, &ierr), "volume");
    GMSH(gmshModelGeoSynchronize(&ierr), "volume");
    GMSH(gmshModelMeshGenerate(3, &ierr), "cannot fill the body with tetrahedra");
    PM_TRY(get_nodes(in->nn, &out[0], &place, &highest, err));
    if (memcmp(out[0].data, in->x, (size_t)(3 * in->nn) * sizeof(double)) != 0)
        PM_TRY(pm_fail(err, PM_NUMERIC, "gmsh moved nodes of the surface"));
    PM_TRY(get_elements(GMSH_TETRAHEDRON, 4, place, highest, &out[1], err));
done:
    pm_free(given);
    pm_free(loop);
    pm_free(place);
    return status;
}

static enum pm_status volume_job(const void *arg, struct pm_blob *out, struct pm_err *err)
{
    struct pm_err first = {.status = PM_OK};
    enum pm_status status = start(err);
    if (status != PM_OK)
        return status;
    if (fill(arg, ALGORITHM_HXT, out, &first) == PM_OK)
        return PM_OK;
    pm_blobs_release(out);
    status = fill(arg, ALGORITHM_DELAUNAY, out, err);
    if (status == PM_OK)
        status = blob(&out[2], (ptrdiff_t)strlen(first.text) + 1, 1, err);
    if (status == PM_OK)
        memcpy(out[2].data, first.text, (size_t)out[2].bytes);
    return status;
}

enum pm_status pm_gmsh_volume(const struct pm_gmsh_input *in, double timeout, struct pm_tetra *out,
                              struct pm_err *err)
{
    struct pm_blob b[PM_MAX_BLOBS];
    const enum pm_status status = pm_isolate(volume_job, in, timeout, b, err);
    *out = (struct pm_tetra){0};
    if (status != PM_OK)
        return status;
    out->nn = b[0].bytes / (ptrdiff_t)(3 * sizeof(double));
    out->ne = b[1].bytes / (ptrdiff_t)(4 * sizeof(int32_t));
    out->x = b[0].data;
    out->tet = b[1].data;
    out->delaunay = b[2].bytes > 0;
    snprintf(out->why, sizeof out->why, "%.*s", (int)b[2].bytes,
             b[2].bytes > 0 ? (const char *)b[2].data : "");
    b[0].data = b[1].data = NULL;
    pm_blobs_release(b);
    return status;
}

/* Growing list of node numbers and group numbers. */
struct list {
    int64_t *v;
    ptrdiff_t n, capacity;
};

static enum pm_status append(struct list *l, const size_t *from, size_t n, struct pm_err *err)
{
    if (l->n + (ptrdiff_t)n > l->capacity) {
        const ptrdiff_t capacity = 2 * (l->n + (ptrdiff_t)n);
        int64_t *v = pm_realloc(l->v, capacity, sizeof *v, err);
        if (v == NULL)
            return PM_SYSTEM;
        l->v = v;
        l->capacity = capacity;
    }
    for (size_t k = 0; k < n; k++)
        l->v[l->n++] = (int64_t)from[k];
    return PM_OK;
}

struct reading {
    struct list tet, tri, group;
    struct list used; /* surface entities already taken */
    int corners;
    int32_t ng;
    char (*name)[PM_GROUP_NAME];
};

static enum pm_status take_volume(struct reading *r, const int *type, size_t ntypes,
                                  size_t *const *node, const size_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (size_t k = 0; k < ntypes; k++) {
        const int corners = type[k] == GMSH_TETRAHEDRON      ? 4
                            : type[k] == GMSH_TETRAHEDRON_10 ? 10
                                                             : 0;
        if (corners == 0 || (r->corners != 0 && r->corners != corners))
            PM_TRY(pm_fail(
                err, PM_INPUT,
                "group 'body' holds elements of gmsh type %d%s, expected only 4-node (type 4) "
                "or only 10-node (type 11) tetrahedra",
                type[k], corners == 0 ? "" : " beside others"));
        r->corners = corners;
        PM_TRY(append(&r->tet, node[k], n[k], err));
    }
done:
    return status;
}

static enum pm_status take_surface(struct reading *r, const int *type, size_t ntypes,
                                   size_t *const *node, const size_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const size_t group = (size_t)r->ng;
    for (size_t k = 0; k < ntypes; k++) {
        const size_t corners = type[k] == GMSH_TRIANGLE ? 3 : type[k] == GMSH_TRIANGLE_6 ? 6 : 0;
        if (corners == 0)
            return pm_fail(err, PM_INPUT,
                           "group '%s' holds elements of gmsh type %d, expected triangles",
                           r->name[r->ng], type[k]);
        for (size_t t = 0; t < n[k] / corners; t++) {
            PM_TRY(append(&r->tri, node[k] + corners * t, 3, err));
            PM_TRY(append(&r->group, &group, 1, err));
        }
    }
done:
    return status;
}

static enum pm_status take_entity(struct reading *r, int dim, int entity, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int *type = NULL;
    size_t ntypes = 0, **element = NULL, *ne = NULL, nne = 0, **node = NULL, *n = NULL, nn = 0;
    GMSH(gmshModelMeshGetElements(&type, &ntypes, &element, &ne, &nne, &node, &n, &nn, dim, entity,
                                  &ierr),
         "elements");
    if (dim == 3)
        PM_TRY(take_volume(r, type, ntypes, node, n, err));
    else
        PM_TRY(take_surface(r, type, ntypes, node, n, err));
done:
    gmshFree(type);
    for (size_t k = 0; k < nne; k++)
        gmshFree(element[k]);
    for (size_t k = 0; k < nn; k++)
        gmshFree(node[k]);
    gmshFree(element);
    gmshFree(ne);
    gmshFree(node);
    gmshFree(n);
    return status;
}

/* The elements of one physical group; groups without a name and volumes that are not `body` are
 * passed over. */
static enum pm_status take_group(struct reading *r, int dim, int tag, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    char *name = NULL;
    int *entity = NULL;
    size_t n = 0;
    GMSH(gmshModelGetPhysicalName(dim, tag, &name, &ierr), "group");
    if (name == NULL || name[0] == '\0' || dim < 2 || (dim == 3 && strcmp(name, "body") != 0))
        goto done;
    if (dim == 2)
        snprintf(r->name[r->ng], PM_GROUP_NAME, "%s", name);
    GMSH(gmshModelGetEntitiesForPhysicalGroup(dim, tag, &entity, &n, &ierr), "group");
    for (size_t k = 0; k < n; k++) {
        for (ptrdiff_t j = 0; j < r->used.n && dim == 2; j++)
            if (r->used.v[j] == entity[k])
                PM_TRY(pm_fail(err, PM_INPUT, "group '%s' shares surface %d with another group",
                               name, entity[k]));
        PM_TRY(take_entity(r, dim, entity[k], err));
        const size_t used = (size_t)entity[k];
        if (dim == 2)
            PM_TRY(append(&r->used, &used, 1, err));
    }
    r->ng += dim == 2;
done:
    gmshFree(name);
    gmshFree(entity);
    return status;
}

static int by_value(const void *a, const void *b)
{
    const int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

/* Node numbers -> places in the ascending list of all nodes. */
static enum pm_status number(const struct list *l, const int64_t *tag, size_t n,
                             struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(blob(out, l->n, sizeof(int32_t), err));
    for (ptrdiff_t k = 0; k < l->n; k++) {
        const int64_t *found = bsearch(&l->v[k], tag, n, sizeof *tag, by_value);
        if (found == NULL)
            PM_TRY(pm_fail(err, PM_INPUT, "an element refers to node %lld, which does not exist",
                           (long long)l->v[k]));
        ((int32_t *)out->data)[k] = (int32_t)(found - tag);
    }
done:
    return status;
}

/* out[0] node numbers, ascending, out[1] their positions. */
static enum pm_status read_nodes(struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    size_t *tag = NULL, n = 0, nx = 0, np = 0;
    double *x = NULL, *param = NULL;
    GMSH(gmshModelMeshGetNodes(&tag, &n, &x, &nx, &param, &np, -1, -1, 0, 0, &ierr), "nodes");
    PM_TRY(blob(&out[0], (ptrdiff_t)n, sizeof(int64_t), err));
    PM_TRY(blob(&out[1], (ptrdiff_t)nx, sizeof(double), err));
    int64_t *sorted = out[0].data;
    for (size_t k = 0; k < n; k++)
        sorted[k] = (int64_t)tag[k];
    qsort(sorted, n, sizeof *sorted, by_value);
    for (size_t k = 1; k < n; k++)
        if (sorted[k] == sorted[k - 1])
            PM_TRY(pm_fail(err, PM_INPUT, "node number %lld occurs twice", (long long)sorted[k]));
    for (size_t k = 0; k < n; k++) {
        const int64_t t = (int64_t)tag[k];
        const int64_t *at = bsearch(&t, sorted, n, sizeof *sorted, by_value);
        memcpy((double *)out[1].data + 3 * (at - sorted), x + 3 * k, 3 * sizeof *x);
    }
done:
    gmshFree(tag);
    gmshFree(x);
    gmshFree(param);
    return status;
}

/* gmsh may go on after an error: any is one. */
static enum pm_status open_file(const char *path, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    char *text = NULL;
    GMSH(gmshOpen(path, &ierr), "it cannot be read");
    GMSH(gmshLoggerGetLastError(&text, &ierr), "it cannot be read");
    if (text != NULL && text[0] != '\0')
        status = pm_fail(err, PM_INPUT, "it cannot be read: gmsh says '%s'", text);
done:
    gmshFree(text);
    return status;
}

static enum pm_status read_job(const void *arg, struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct reading r = {.corners = 0};
    int *group = NULL;
    size_t n = 0;
    PM_TRY(start(err));
    PM_TRY(open_file(arg, err));
    GMSH(gmshModelGetPhysicalGroups(&group, &n, -1, &ierr), "groups");
    PM_TRY(blob(&out[5], (ptrdiff_t)n + 1, PM_GROUP_NAME, err));
    r.name = out[5].data;
    for (size_t k = 0; k + 1 < n; k += 2)
        PM_TRY(take_group(&r, group[k], group[k + 1], err));
    if (r.corners == 0)
        PM_TRY(pm_fail(err, PM_INPUT, "there is no physical group 'body' with tetrahedra"));
    out[5].bytes = r.ng * (ptrdiff_t)PM_GROUP_NAME;
    PM_TRY(read_nodes(out, err));
    const size_t nn = (size_t)out[0].bytes / sizeof(int64_t);
    PM_TRY(number(&r.tet, out[0].data, nn, &out[2], err));
    PM_TRY(number(&r.tri, out[0].data, nn, &out[3], err));
    PM_TRY(blob(&out[4], r.group.n, sizeof(int32_t), err));
    for (ptrdiff_t k = 0; k < r.group.n; k++)
        ((int32_t *)out[4].data)[k] = (int32_t)r.group.v[k];
    PM_TRY(blob(&out[6], 1, sizeof r.corners, err));
    memcpy(out[6].data, &r.corners, sizeof r.corners);
done:
    gmshFree(group);
    pm_free(r.tet.v);
    pm_free(r.tri.v);
    pm_free(r.group.v);
    pm_free(r.used.v);
    return status;
}

void pm_msh_release(struct pm_msh *m)
{
    pm_free(m->tag);
    pm_free(m->x);
    pm_free(m->tet);
    pm_free(m->tri);
    pm_free(m->group);
    pm_free(m->name);
    *m = (struct pm_msh){0};
}

enum pm_status pm_gmsh_read(const char *path, struct pm_msh *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_blob b[PM_MAX_BLOBS] = {{0}};
    *out = (struct pm_msh){0};
    PM_TRY(pm_isolate(read_job, path, 0, b, err));
    memcpy(&out->corners, b[6].data, sizeof out->corners);
    out->nn = b[0].bytes / (ptrdiff_t)sizeof(int64_t);
    out->ne = b[2].bytes / (ptrdiff_t)sizeof(int32_t) / out->corners;
    out->nt = b[4].bytes / (ptrdiff_t)sizeof(int32_t);
    out->ng = b[5].bytes / PM_GROUP_NAME;
    out->tag = b[0].data;
    out->x = b[1].data;
    out->tet = b[2].data;
    out->tri = b[3].data;
    out->group = b[4].data;
    out->name = b[5].data;
    for (int k = 0; k < 6; k++)
        b[k].data = NULL;
done:
    pm_blobs_release(b);
    /* whatever gmsh made of it: the file is to blame */
    if (status == PM_NUMERIC)
        status = err->status = PM_INPUT;
    return status;
}
