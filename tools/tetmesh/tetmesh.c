#include "tools/tetmesh/tetmesh.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "tools/tetmesh/coarse.h"
#include "tools/tetmesh/curve.h"
#include "tools/tetmesh/flat.h"
#include "tools/tetmesh/import_msh.h"
#include "tools/tetmesh/mirror.h"
#include "tools/tetmesh/reuse.h"
#include "tools/tetmesh/shell.h"
#include "tools/tetmesh/split.h"
#include "tools/tetmesh/volume_gmsh.h"
#include "tools/tetmesh/walls.h"

/* Crests get finer by this factor, while edges are longer than their radii. */
static const double FINER = 0.8;

/* What is asked of a new mesh. */
struct sizes {
    double size, timeout; /* [mm], [s] */
    long layers;
};

/* Shells for gmsh: chambers that mirror planes cut belong to the outer one. */
static int32_t number_parts(const struct pm_surfaces *s, const struct pm_mirrors *y,
                            const struct pm_shell *shell, int32_t *part)
{
    int32_t of[PM_MAX_CHAMBERS + 1] = {0}, n = 1;
    for (ptrdiff_t k = 1; k < s->ns; k++) {
        int kept;
        const unsigned cut = pm_mirrors_cut(y, s, k, &kept);
        of[k] = kept && cut == 0 ? n++ : 0;
    }
    for (ptrdiff_t t = 0; t < shell->nt; t++)
        part[t] = shell->tag[t] > 0 ? of[shell->tag[t]] : 0;
    return n;
}

struct shells {
    struct pm_shell flat, bent;
};

static void shells_release(struct shells *s)
{
    pm_shell_release(&s->flat);
    pm_shell_release(&s->bent);
}

static enum pm_status build(struct pm_middles *middles, const struct pm_mirrors *y,
                            const struct pm_shell_opts *o, struct shells *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(pm_shell_build(middles->s, y, o, &s->flat, err));
    PM_TRY(pm_shell_bend(middles, &s->flat, &s->bent, err));
done:
    return status;
}

/* Builds them again with edges as the distances in *s ask. */
static enum pm_status rebuild(struct pm_middles *middles, const struct pm_mirrors *y, long layers,
                              int apart, struct pm_shell_opts o, struct shells *s,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_walls walls = {.bent = NULL};
    struct shells first = *s;
    *s = (struct shells){.flat = {.nn = 0}};
    PM_TRY(pm_walls_init(&walls, &first.bent, layers, apart, o.size, err));
    o.walls = &walls;
    PM_TRY(build(middles, y, &o, s, err));
done:
    pm_walls_release(&walls);
    shells_release(&first);
    return status;
}

/* The surfaces as triangles that pass all checks; where facets meet, again with shorter ones:
 * there, then on all crests as well. */
static enum pm_status triangulate(struct pm_middles *middles, const struct pm_mirrors *y,
                                  const struct sizes *sizes, struct shells *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t nchambers = middles->s->ns - 1;
    struct pm_shell_opts o = {
        .size = sizes->size, .crest = middles->s->pcase.mesh_crest, .timeout = sizes->timeout};
    PM_TRY(build(middles, y, &o, s, err));
    if (sizes->layers > 0)
        PM_TRY(rebuild(middles, y, sizes->layers, 0, o, s, err));
    status = pm_shell_check(&s->flat, &s->bent, nchambers, err);
    for (int k = 0; status == PM_INPUT && (k == 0 || o.crest > 1); k++) {
        if (k == 0) {
            pm_log(1, "%s: shorter edges there", err->text);
        } else {
            o.crest *= FINER;
            pm_log(1, "%s: edges of %.3g times the radii of crests", err->text, o.crest);
        }
        *err = (struct pm_err){.status = PM_OK};
        PM_TRY(rebuild(middles, y, sizes->layers, 1, o, s, err));
        status = pm_shell_check(&s->flat, &s->bent, nchambers, err);
    }
done:
    return status;
}

/* The part of the body on the positive sides of the planes of y. */
static enum pm_status generate(const struct pm_surfaces *s, const struct pm_mirrors *y,
                               const struct sizes *sizes, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_middles middles = {.s = NULL};
    struct shells shells = {.flat = {.nn = 0}};
    struct pm_shell *shell = &shells.flat;
    struct pm_tetra tetra = {0};
    struct pm_curve_report r;
    int32_t *part = NULL;
    ptrdiff_t left = 0;
    PM_TRY(pm_middles_init(&middles, s, y->planes, err));
    PM_TRY(triangulate(&middles, y, sizes, &shells, err));
    PM_TRY(pm_flat_cuts(shell, sizes->size, sizes->timeout, err));
    PM_TRY(PM_NEW(part, shell->nt, err));
    const int32_t parts = number_parts(s, y, shell, part);
    const struct pm_gmsh_input in = {shell->nn, shell->nt, shell->x, shell->tri, part, parts};
    PM_TRY(pm_gmsh_volume(&in, sizes->timeout, &tetra, err));
    if (tetra.delaunay)
        pm_warn("the HXT mesher failed (%s): meshed by Delaunay", tetra.why);
    PM_TRY(pm_split_two_faces(shell, &tetra, &left, err));
    pm_log(2, "%td tetrahedra keep two faces on one surface", left);
    PM_TRY(pm_curve_mesh(&middles, shell, &tetra, m, &r, err));
    m->origin = PM_ORIGIN_GENERATED;
    m->delaunay = tetra.delaunay;
    pm_log(1,
           "%td of %td mid-side nodes on surfaces damped by up to %.3g, %.2g mm off them (%td bad "
           "elements, %d sweeps)",
           r.damped, r.surface_middles, m->max_damping, r.off, r.bad, r.sweeps);
done:
    pm_middles_release(&middles);
    shells_release(&shells);
    pm_free(tetra.x);
    pm_free(tetra.tet);
    pm_free(part);
    return status;
}

static double edge_length(const struct tetmesh_opts *o, const struct pm_surfaces *s)
{
    return o->size > 0 ? o->size : s->pcase.mesh_size;
}

/* A new mesh: of the part that all mirrors leave, and its images at those that do not bound the
 * model. */
static enum pm_status make_new(const struct tetmesh_opts *o, const struct pm_surfaces *s,
                               const struct pm_mirrors *y, unsigned planes, struct pm_mesh *m,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct sizes sizes = {.size = edge_length(o, s),
                                .timeout = o->timeout,
                                .layers = o->layers >= 0 ? o->layers : s->pcase.mesh_layers};
    double mean_ratio;
    PM_TRY(pm_mirrors_check(s, y, err));
    PM_TRY(generate(s, y, &sizes, m, err));
    for (int axis = 0; axis < 2; axis++)
        if ((y->planes & ~planes) >> axis & 1)
            PM_TRY(pm_mesh_reflect(s, y, axis, m, err));
    pm_curve_quality(m, m->x, &m->min_jacobian, &mean_ratio);
    PM_TRY(pm_coarse_part(s, sizes.size, m, &m->coarse, err));
done:
    return status;
}

/* The previous mesh where it serves, else a new one. */
static enum pm_status make(const struct tetmesh_opts *o, const struct pm_surfaces *s,
                           struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mirrors y;
    pm_mirrors_find(s, &y);
    const unsigned planes = o->whole ? 0 : y.own;
    struct pm_reuse r = {
        .path = o->previous, .s = s, .y = &y, .planes = planes, .size = edge_length(o, s)};
    if (o->previous != NULL)
        PM_TRY(pm_reuse_mesh(&r, m, err));
    if (r.good)
        return PM_OK;
    if (o->keep_mesh)
        return pm_fail(err, PM_NUMERIC, "worn mesh: cannot morph '%s': %s", o->previous, r.why);
    if (o->previous != NULL)
        pm_log(0, "previous mesh '%s' given up, %s: meshing anew", o->previous, r.why);
    PM_TRY(make_new(o, s, &y, planes, m, err));
done:
    return status;
}

static enum pm_status make_or_record(const struct tetmesh_opts *o, const struct pm_surfaces *s,
                                     struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = make(o, s, m, err);
    if ((status == PM_INPUT || status == PM_NUMERIC) && o->record_failure) {
        pm_mesh_release(m);
        snprintf(m->failure, sizeof m->failure, "tetmesh: %.490s", err->text);
        pm_warn("%s", err->text);
        *err = (struct pm_err){0};
        status = PM_OK;
    }
    return status;
}

/* The case of an imported mesh: the file given, or a material alone. */
static enum pm_status import_case(const struct tetmesh_opts *o, struct pm_case *c,
                                  struct pm_err *err)
{
    enum pm_status status;
    char text[1024], material[960];
    struct pm_material m = o->material;
    if (o->case_file != NULL)
        return pm_case_load(o->case_file, c, err);
    if (o->mu > 0) {
        m.law = "neo-hookean";
        m.n = 1;
        m.c[0] = o->mu;
    }
    PM_TRY(pm_material_text(&m, material, sizeof material, err));
    snprintf(text, sizeof text, "[case]\nname = imported\n[material]\n%s", material);
    PM_TRY(pm_case_parse(text, m.preset != NULL ? "--material" : "--law, --parameters", c, err));
    pm_case_warn(c, "--parameters");
done:
    return status;
}

static enum pm_status import(const struct tetmesh_opts *o, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(pm_import_msh(o->import, o->promote, m, err));
    PM_TRY(import_case(o, &m->pcase, err));
    if (m->pcase.nchambers > 0 && m->pcase.nchambers != m->nc)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': it has %td chambers, case '%s' has %td",
                       o->import, m->nc, o->case_file, m->pcase.nchambers));
    if (o->have_reference)
        memcpy(m->reference_point, o->reference, sizeof m->reference_point);
done:
    return status;
}

static enum pm_status mesh_surfaces(const struct tetmesh_opts *o, const char *path,
                                    struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surfaces s = {0};
    PM_TRY(pm_surfaces_load(path, &s, err));
    s.pcase.mesh_crest = o->crest > 0 ? o->crest : s.pcase.mesh_crest;
    PM_TRY(make_or_record(o, &s, m, err));
    pm_case_release(&m->pcase);
    PM_TRY(pm_case_copy(&s.pcase, &m->pcase, err));
    memcpy(m->reference_point, s.reference_point, sizeof m->reference_point);
done:
    pm_surfaces_release(&s);
    return status;
}

enum pm_status tetmesh_check(const struct tetmesh_opts *o, const struct pm_common *common,
                             struct pm_err *err)
{
    const int materials = (o->case_file != NULL) + (o->material.preset != NULL) +
                          (o->material.law != NULL || o->material.n > 0) + (o->mu > 0);
    if ((o->import != NULL) == (common->noperands == 1))
        return pm_fail(err, PM_USAGE, "expected either SURF.h5 or --import FILE.msh");
    if (o->import != NULL && (o->size > 0 || o->crest > 0 || o->layers >= 0 || o->timeout > 0 ||
                              o->previous != NULL || o->record_failure || o->whole))
        return pm_fail(err, PM_USAGE,
                       "--size, --crest, --layers, --timeout, --previous, --record-failure and "
                       "--symmetry none do not go with --import");
    if (o->import == NULL && (o->promote || o->have_reference || o->case_file != NULL ||
                              materials > 0 || o->material.kappa > 0))
        return pm_fail(err, PM_USAGE,
                       "--promote, --reference, --case, --material, --law, --parameters, --mu and "
                       "--kappa need --import");
    if (o->keep_mesh && o->previous == NULL)
        return pm_fail(err, PM_USAGE, "--keep-mesh needs --previous");
    if (o->import != NULL && materials != 1)
        return pm_fail(err, PM_USAGE,
                       "--import needs one of --case, --material, --law with --parameters, --mu");
    if (o->case_file != NULL && o->material.kappa > 0)
        return pm_fail(err, PM_USAGE, "--kappa does not go with --case");
    return pm_material_check(&o->material, err);
}

enum pm_status tetmesh_run(const struct tetmesh_opts *o, const struct pm_common *common,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_mesh m = {.nn = 0};
    struct pm_h5 *out = NULL;
    /* whichever of them are given */
    const char *const extra[] = {o->import != NULL ? o->import : o->previous, o->case_file, NULL};
    PM_TRY(tetmesh_check(o, common, err));
    if (o->import != NULL)
        PM_TRY(import(o, &m, err));
    else
        PM_TRY(mesh_surfaces(o, common->operands[0], &m, err));
    if (m.failure[0] == '\0')
        pm_log(1, "%td nodes, %td tetrahedra, %td unknowns, smallest scaled Jacobian %.3f", m.nn,
               m.ne, 3 * m.nn, m.min_jacobian);
    PM_TRY(pm_h5_create(common->output, "mesh", common, extra, &out, err));
    PM_TRY(pm_mesh_write(out, &m, err));
    status = pm_h5_commit(out, err);
    out = NULL;
done:
    pm_h5_close(out);
    pm_mesh_release(&m);
    return status;
}
