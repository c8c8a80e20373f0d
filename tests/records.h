/* Small valid records of every kind for tests of files and tools: one curved tetrahedron, two
 * chambers. */
#ifndef RECORDS_H
#define RECORDS_H

#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/files/sens.h"
#include "common/files/state.h"
#include "common/files/step.h"
#include "common/files/surfaces.h"
#include "common/files/sweep.h"
#include "common/files/work.h"
#include "common/mechanics/tet10.h"

static const char sample_case_text[] =
    "[case]\nname = sample\n"
    "[material]\nmu = 0.5\n"
    "[body]\nheight = 100\nwall = 3\n"
    "[chamber1]\nshape = sphere\ncenter = 15, 0, 50\nradius = 10\n"
    "[symmetry]\ngroup = mirror-x\n"
    "[workspace]\nmeasure = 2T\n";

static inline double sample_number(ptrdiff_t i)
{
    return (double)((7 * i + 3) % 11) / 8 - 0.5;
}

static inline enum pm_status sample_numbers(double **p, ptrdiff_t n, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(PM_NEW(*p, n, err));
    for (ptrdiff_t i = 0; i < n; i++)
        (*p)[i] = sample_number(i);
done:
    return status;
}

static inline enum pm_status sample_surface(struct pm_surface *s, int32_t type, struct pm_err *err)
{
    enum pm_status status;
    s->type = type;
    s->nu = s->nv = type == PM_SURFACE_BSPLINE ? 4 : 0;
    s->n = type == PM_SURFACE_BSPLINE ? 16 : 6;
    s->nt = 2;
    PM_TRY(sample_numbers(&s->phi, 3 * s->n, err));
    PM_TRY(sample_numbers(&s->Phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->free, 3 * s->n, err));
    PM_TRY(PM_NEW(s->d0, s->n, err));
    PM_TRY(PM_NEW(s->tri, 3 * s->nt, err));
    for (ptrdiff_t i = 0; i < s->n; i++) {
        s->free[3 * i] = 1;
        s->d0[i] = type == PM_SURFACE_SPHERE ? 1 : 0;
    }
    for (int i = 0; i < 6; i++)
        s->tri[i] = i % 4;
done:
    return status;
}

static inline enum pm_status sample_surfaces(struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_surfaces){.ns = 0, .reference_point = {0, 0, 100}};
    PM_TRY(pm_case_parse(sample_case_text, "sample", &s->pcase, err));
    PM_TRY(PM_NEW(s->s, 3, err));
    s->ns = 3;
    PM_TRY(PM_NEW(s->offset, 4, err));
    for (int k = 0; k < 3; k++) {
        PM_TRY(sample_surface(&s->s[k], k == 0 ? PM_SURFACE_BSPLINE : PM_SURFACE_SPHERE, err));
        s->offset[k + 1] = s->offset[k] + s->s[k].n;
    }
    ptrdiff_t N = s->offset[3];
    PM_TRY(PM_NEW(s->perm, 2 * N, err));
    for (ptrdiff_t i = 0; i < N; i++) {
        s->perm[i] = (int32_t)i;
        s->perm[N + i] = (int32_t)(N - 1 - i);
    }
done:
    return status;
}

static inline enum pm_status sample_mesh(struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    static const int32_t faces[4][6] = {
        {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}};
    static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    *m = (struct pm_mesh){.nn = 10,
                          .ne = 1,
                          .nf = 4,
                          .nc = 2,
                          .npe = 10,
                          .npf = 6,
                          .nw = 4,
                          .N = 28,
                          .min_jacobian = 0.5,
                          .coarse = 0.01};
    PM_TRY(pm_case_parse(sample_case_text, "sample", &m->pcase, err));
    PM_TRY(PM_NEW(m->x, 30, err));
    PM_TRY(PM_NEW(m->x_generated, 30, err));
    PM_TRY(PM_NEW(m->tet, 10, err));
    PM_TRY(PM_NEW(m->tri, 24, err));
    PM_TRY(PM_NEW(m->tri_tag, 4, err));
    PM_TRY(PM_NEW(m->surface, 10, err));
    PM_TRY(PM_NEW(m->S, 30, err));
    PM_TRY(PM_NEW(m->wptr, 11, err));
    PM_TRY(PM_NEW(m->wcol, 4, err));
    PM_TRY(PM_NEW(m->wval, 4, err));
    for (int a = 0; a < 10; a++) {
        for (int i = 0; i < 3; i++)
            m->x[3 * a + i] =
                a < 4
                    ? corner[a][i]
                    : (corner[pm_tet10_edge[a - 4][0]][i] + corner[pm_tet10_edge[a - 4][1]][i]) / 2;
        m->tet[a] = a;
        m->surface[a] = a < 2 ? a : -1;
        m->wptr[a + 1] = a < 2 ? 2 * (a + 1) : 4;
    }
    memcpy(m->x_generated, m->x, 30 * sizeof *m->x);
    memcpy(m->tri, faces, sizeof faces);
    m->tri_tag[0] = PM_FACE_BASE;
    m->tri_tag[1] = PM_FACE_TIP;
    m->tri_tag[2] = 2;
    for (int i = 0; i < 4; i++) {
        m->wcol[i] = 7 * i;
        m->wval[i] = 0.5;
    }
    m->reference_point[2] = 100;
done:
    return status;
}

static inline enum pm_status sample_state(struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_state){.element = "tet10",
                           .load = 1,
                           .energy = 2.5,
                           .residual = 1e-9,
                           .min_det_F = 0.9,
                           .load_steps = 3,
                           .newton_steps = 9,
                           .factorisations = 11,
                           .backoffs = 1,
                           .stable = 1,
                           .contact = {.intersections = 2, .at = {1, 2, 3}, .surface = {1, 2}}};
    PM_TRY(sample_mesh(&s->mesh, err));
    PM_TRY(sample_numbers(&s->pressure, 2, err));
    PM_TRY(sample_numbers(&s->u, 30, err));
    PM_TRY(sample_numbers(&s->J, 12, err));
    PM_TRY(sample_numbers(&s->volume, 2, err));
    PM_TRY(sample_numbers(&s->volume0, 2, err));
    for (int i = 0; i < 6; i++)
        s->U[i] = s->reaction[i] = sample_number(i);
done:
    return status;
}

static inline enum pm_status sample_sweep(struct pm_sweep *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_sweep){.element = "tet10"};
    PM_TRY(sample_mesh(&s->mesh, err));
    PM_TRY(pm_sweep_allocate(s, 3, err));
    PM_TRY(PM_NEW(s->reason, 16, err));
    memcpy(s->reason, "\n\nbuckled", 10);
    for (ptrdiff_t i = 0; i < 3; i++) {
        s->reached[i] = i < 2;
        s->factorisations[i] = 3 - i;
        s->intersections[i] = i == 1;
        s->energy[i] = s->residual[i] = s->min_det_F[i] = s->gap[i] = s->closeness[i] =
            sample_number(i);
    }
    for (ptrdiff_t i = 0; i < 6; i++)
        s->pressure[i] = s->volume[i] = sample_number(i);
    for (ptrdiff_t i = 0; i < 36; i++)
        s->J[i] = s->U[i / 2] = sample_number(i);
    for (ptrdiff_t i = 0; i < 90; i++)
        s->displacement[i] = sample_number(i);
done:
    return status;
}

static inline enum pm_status sample_work(struct pm_work *w, struct pm_err *err)
{
    enum pm_status status;
    *w = (struct pm_work){.value = 12.5,
                          .objective = 11.5,
                          .amplification = 2.25,
                          .name = "2T",
                          .unit = "mm2",
                          .orientation = -1,
                          .quadrature_error = -1,
                          .min_det = 1,
                          .max_det = 2,
                          .ng = 4,
                          .nc = 2};
    PM_TRY(pm_case_parse(sample_case_text, "sample", &w->pcase, err));
    PM_TRY(PM_NEW(w->load, 4, err));
    for (int g = 0; g < 4; g++)
        w->load[g] = g;
    PM_TRY(sample_numbers(&w->pressure, 8, err));
    PM_TRY(sample_numbers(&w->U, 24, err));
    PM_TRY(sample_numbers(&w->J, 48, err));
    PM_TRY(sample_numbers(&w->w, 4, err));
    PM_TRY(sample_numbers(&w->dw_dU, 24, err));
    PM_TRY(sample_numbers(&w->dw_dJ, 48, err));
    PM_TRY(PM_NEW(w->intersections, 4, err));
    w->intersections[2] = 3;
    PM_TRY(sample_numbers(&w->gap, 4, err));
    PM_TRY(sample_numbers(&w->closeness_at, 4, err));
    PM_TRY(sample_numbers(&w->dw_dG, 4, err));
done:
    return status;
}

static inline enum pm_status sample_sens(struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_sens){.N = 28, .load = 2, .identity_scaling = 1e-12};
    PM_TRY(pm_case_parse(sample_case_text, "sample", &s->pcase, err));
    PM_TRY(sample_numbers(&s->gradient, 84, err));
done:
    return status;
}

static inline enum pm_status sample_step(struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    *s = (struct pm_step){.verdict = "continue",
                          .value = 12.5,
                          .weight = {1, 2},
                          .radius = 0.25,
                          .gain = 0.5,
                          .penalty = {0.1, 0.2},
                          .ntrials = 2};
    PM_TRY(sample_surfaces(&s->trial, err));
    PM_TRY(sample_surfaces(&s->accepted, err));
    PM_TRY(sample_numbers(&s->gradient, 84, err));
    PM_TRY(PM_NEW(s->trials, 2, err));
    s->trials[0] = (struct pm_trial){.accepted = 1, .measure = 12.5, .radius = 0.3};
    s->trials[1] =
        (struct pm_trial){.iteration = 1, .ratio = -0.5, .radius = 0.1, .reason = "no gain"};
done:
    return status;
}

/* A record of any kind. */
union sample {
    struct pm_surfaces surfaces;
    struct pm_mesh mesh;
    struct pm_state state;
    struct pm_work work;
    struct pm_sens sens;
    struct pm_step step;
    struct pm_sweep sweep;
};

static const char *const sample_kinds[] = {"surface", "mesh", "state", "work",
                                           "sens",    "step", "path"};
enum { SAMPLE_KINDS = sizeof sample_kinds / sizeof sample_kinds[0] };

/* Index in sample_kinds, SAMPLE_KINDS for another word. */
static inline int sample_kind(const char *kind)
{
    int k = 0;
    while (k < SAMPLE_KINDS && strcmp(kind, sample_kinds[k]) != 0)
        k++;
    return k;
}

static inline enum pm_status sample_make(const char *kind, union sample *r, struct pm_err *err)
{
    switch (sample_kind(kind)) {
    case 0:
        return sample_surfaces(&r->surfaces, err);
    case 1:
        return sample_mesh(&r->mesh, err);
    case 2:
        return sample_state(&r->state, err);
    case 3:
        return sample_work(&r->work, err);
    case 4:
        return sample_sens(&r->sens, err);
    case 5:
        return sample_step(&r->step, err);
    case 6:
        return sample_sweep(&r->sweep, err);
    default:
        return pm_fail(err, PM_USAGE, "no kind '%s'", kind);
    }
}

static inline enum pm_status sample_load(const char *kind, const char *path, union sample *r,
                                         struct pm_err *err)
{
    switch (sample_kind(kind)) {
    case 0:
        return pm_surfaces_load(path, &r->surfaces, err);
    case 1:
        return pm_mesh_load(path, 0, &r->mesh, err);
    case 2:
        return pm_state_load(path, 0, &r->state, err);
    case 3:
        return pm_work_load(path, 0, &r->work, err);
    case 4:
        return pm_sens_load(path, &r->sens, err);
    case 5:
        return pm_step_load(path, &r->step, err);
    default:
        return pm_sweep_load(path, &r->sweep, err);
    }
}

static inline void sample_release(const char *kind, union sample *r)
{
    switch (sample_kind(kind)) {
    case 0:
        pm_surfaces_release(&r->surfaces);
        break;
    case 1:
        pm_mesh_release(&r->mesh);
        break;
    case 2:
        pm_state_release(&r->state);
        break;
    case 3:
        pm_work_release(&r->work);
        break;
    case 4:
        pm_sens_release(&r->sens);
        break;
    case 5:
        pm_step_release(&r->step);
        break;
    default:
        pm_sweep_release(&r->sweep);
    }
}

/* Writes a record (struct pm_surfaces, pm_mesh .. by kind) as a file of its own. */
static inline enum pm_status sample_write(const char *path, const char *kind, const void *record,
                                          struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    const struct pm_common common = {.tool = "sample", .command = "sample"};
    enum pm_status written = PM_USAGE;
    PM_TRY(pm_h5_create(path, kind, &common, NULL, &f, err));
    switch (sample_kind(kind)) {
    case 0:
        written = pm_surfaces_write(f, record, err);
        break;
    case 1:
        written = pm_mesh_write(f, record, err);
        break;
    case 2:
        written = pm_state_write(f, record, err);
        break;
    case 3:
        written = pm_work_write(f, record, err);
        break;
    case 4:
        written = pm_sens_write(f, record, err);
        break;
    case 5:
        written = pm_step_write(f, record, err);
        break;
    default:
        written = pm_sweep_write(f, record, err);
    }
    PM_TRY(written);
    PM_TRY(pm_h5_commit(f, err));
    f = NULL;
done:
    pm_h5_close(f);
    return status;
}

#endif
