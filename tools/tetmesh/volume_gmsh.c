/* The only user of gmshc.h. */
#include "tools/tetmesh/volume_gmsh.h"

#include <gmshc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/tetmesh/isolate.h"

enum { GMSH_TRIANGLE = 2, GMSH_TETRAHEDRON = 4, ALGORITHM_DELAUNAY = 1, ALGORITHM_HXT = 10 };

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

struct disc_job {
    ptrdiff_t n;
    const double *loop;
    double size;
};

static enum pm_status disc_job(const void *arg, struct pm_blob *out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct disc_job *job = arg;
    const int n = (int)job->n;
    int32_t *place = NULL;
    int *curve = NULL, loop = 1;
    size_t highest = 0;
    PM_TRY(start(err));
    PM_TRY(PM_NEW(curve, n, err));
    for (int k = 0; k < n; k++) {
        const double *p = job->loop + 3 * k;
        GMSH(gmshModelGeoAddPoint(p[0], p[1], p[2], job->size, k + 1, &ierr), "cap");
    }
    for (int k = 0; k < n; k++) {
        curve[k] = k + 1;
        GMSH(gmshModelGeoAddLine(k + 1, (k + 1) % n + 1, k + 1, &ierr), "cap");
        GMSH(gmshModelGeoMeshSetTransfiniteCurve(k + 1, 2, "Progression", 1, &ierr), "cap");
    }
    GMSH(gmshModelGeoAddCurveLoop(curve, (size_t)n, 1, 0, &ierr), "cap");
    GMSH(gmshModelGeoAddPlaneSurface(&loop, 1, 1, &ierr), "cap");
    GMSH(gmshModelGeoSynchronize(&ierr), "cap");
    GMSH(gmshModelMeshGenerate(2, &ierr), "cannot mesh a cap");
    PM_TRY(get_nodes(n, &out[0], &place, &highest, err));
    PM_TRY(get_elements(GMSH_TRIANGLE, 3, place, highest, &out[1], err));
    /* gmsh numbers the nodes of points first and in their order */
    for (ptrdiff_t k = 0; k < 3 * job->n; k++)
        if (fabs(((const double *)out[0].data)[k] - job->loop[k]) > 1e-9)
            PM_TRY(pm_fail(err, PM_NUMERIC, "gmsh moved node %td of the rim", k / 3));
done:
    pm_free(curve);
    pm_free(place);
    return status;
}

enum pm_status pm_gmsh_disc(ptrdiff_t n, const double *loop, double size, double timeout,
                            struct pm_planar *out, struct pm_err *err)
{
    struct pm_blob b[PM_MAX_BLOBS];
    const struct disc_job job = {n, loop, size};
    const enum pm_status status = pm_isolate(disc_job, &job, timeout, b, err);
    *out = (struct pm_planar){0};
    if (status != PM_OK)
        return status;
    out->nn = b[0].bytes / (ptrdiff_t)(3 * sizeof(double));
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
