#include "tools/tetmesh/reuse.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/extension.h"
#include "tools/tetmesh/carry.h"
#include "tools/tetmesh/coarse.h"
#include "tools/tetmesh/curve.h"
#include "tools/tetmesh/redamp.h"
#include "tools/tetmesh/relocate.h"
#include "tools/tetmesh/weights.h"

/* What a morphed mesh must keep of the scaled Jacobian and of the mean ratio of the straight
 * tetrahedra: new ones have 0.2 and, where they are curved most, 0.05; those below min_mean_ratio
 * keep a part of what they have. */
static const double min_scaled = 0.1, min_mean_ratio = 0.1, kept_mean_ratio = 0.8;
/* And the part of its surfaces where edges are too long may grow by this: at 0.05 more, measures of
 * evolved designs were 1.4 to 3.9 % off those on a new mesh, at 0.3 more 26 %. */
static const double coarser = 0.03;
/* A mesh below min_scaled is damped to this, so that it bears a further step. */
static const double redamp_scaled = 0.15;
static const double relocated_mean_ratio = 0.15;
/* Of the wanted edge: what the nodes may lie off surfaces of other control points. */
static const double FAR = 0.25;

struct quality {
    double scaled, mean_ratio;
};

/* What the mesh m must keep, by what it was generated with. */
static struct quality least_of(const struct pm_mesh *m)
{
    struct quality q;
    pm_curve_quality(m, m->x_generated, &q.scaled, &q.mean_ratio);
    return (struct quality){min_scaled, fmin(min_mean_ratio, kept_mean_ratio * q.mean_ratio)};
}

static int bears(const struct pm_mesh *m, const struct quality *least, struct quality *q)
{
    pm_curve_quality(m, m->x, &q->scaled, &q->mean_ratio);
    return q->scaled >= least->scaled && q->mean_ratio >= least->mean_ratio;
}

/* Moves the nodes of m to control points phi by the extension of its record. *good = 0 where its
 * elements do not bear that. */
static enum pm_status follow(const double *phi, const struct quality *least, struct pm_mesh *m,
                             int *good, struct quality *q, ptrdiff_t *damped, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_extension *ext = NULL;
    PM_TRY(pm_extension_new(m, &ext, err));
    PM_TRY(pm_mesh_morph(m, ext, phi, err));
    *good = bears(m, least, q);
    if (!*good && q->mean_ratio >= least->mean_ratio) {
        PM_TRY(pm_redamp(m, ext, phi, redamp_scaled, damped, err));
        *good = bears(m, least, q);
    }
done:
    pm_extension_free(ext);
    return status;
}

/* The same from where the nodes are, inside as an elastic solid and with distorted elements
 * relieved: x_generated, the record, begins anew there. The mesh is its own image at `planes`. */
static enum pm_status renew(const double *phi, unsigned planes, const struct quality *least,
                            struct pm_mesh *m, int *good, struct quality *q, ptrdiff_t *damped,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_extension *ext = NULL;
    int32_t *image[2];
    ptrdiff_t left;
    PM_TRY(pm_mesh_images(m, planes, image, err));
    const struct pm_relocate_opts o = {redamp_scaled, relocated_mean_ratio, {image[0], image[1]}};
    memcpy(m->x_generated, m->x, (size_t)(3 * m->nn) * sizeof *m->x);
    m->pcase.extension =
        PM_EXTENSION_ELASTICITY; /* until the caller takes the case of the surfaces */
    PM_TRY(pm_extension_new(m, &ext, err));
    PM_TRY(pm_mesh_morph(m, ext, phi, err));
    PM_TRY(pm_relocate(&o, m, &left, err));
    *good = bears(m, least, q);
    if (!*good) {
        PM_TRY(pm_redamp(m, ext, phi, redamp_scaled, damped, err));
        PM_TRY(pm_relocate(&o, m, &left, err));
        *good = bears(m, least, q);
    }
    memcpy(m->x_generated, m->x, (size_t)(3 * m->nn) * sizeof *m->x);
done:
    pm_free(image[0]);
    pm_free(image[1]);
    pm_extension_free(ext);
    return status;
}

/* Moves the nodes of m to the control points of the surfaces, as generated or anew. */
static enum pm_status morph(struct pm_reuse *r, int anew, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *phi = NULL;
    const struct quality least = least_of(m);
    struct quality q;
    ptrdiff_t damped = 0;
    PM_TRY(PM_NEW(phi, 3 * m->N, err));
    pm_surfaces_gather(r->s, phi);
    if (anew) /* the mesh is its own image at the planes that do not cut it */
        PM_TRY(renew(phi, r->y->planes & ~r->planes, &least, m, &r->good, &q, &damped, err));
    else
        PM_TRY(follow(phi, &least, m, &r->good, &q, &damped, err));
    m->min_jacobian = q.scaled;
    m->origin = PM_ORIGIN_MORPHED;
    pm_log(
        1,
        "previous mesh morphed%s: scaled Jacobian %.3f, mean ratio %.3f, %td mid-side nodes damped",
        anew ? " from its present state" : "", q.scaled, q.mean_ratio, damped);
    if (!r->good)
        snprintf(r->why, PM_REUSE_WHY,
                 "its elements do not bear the motion: scaled Jacobian %.3f, mean ratio %.3f",
                 q.scaled, q.mean_ratio);
done:
    pm_free(phi);
    return status;
}

/* Has m, morphed, the edges that the surfaces ask for? */
static enum pm_status look_at_edges(struct pm_reuse *r, const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    double part;
    PM_TRY(pm_coarse_part(r->s, r->size, m, &part, err));
    pm_log(2, "edges too long on %.3f of the surfaces, %.3f as generated", part, m->coarse);
    r->good = part <= m->coarse + coarser;
    if (!r->good)
        snprintf(r->why, PM_REUSE_WHY,
                 "on %.1f %% of its surfaces edges are above 1.5 times what size and curvature ask "
                 "for, on %.1f %% as generated",
                 100 * part, 100 * m->coarse);
done:
    return status;
}

/* May m be moved to the surfaces at all? */
static enum pm_status fits(struct pm_reuse *r, const struct pm_mesh *m, int *fit,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_err broken = {.status = PM_OK};
    *fit = 0;
    if (m->failure[0] != '\0')
        snprintf(r->why, PM_REUSE_WHY, "it records a failure");
    else if (m->N == 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': an imported mesh has no control points, expected one made "
                       "from surfaces",
                       r->path));
    else if (pm_mirrors_of(m) != r->planes)
        snprintf(r->why, PM_REUSE_WHY, "it is of another part of the body");
    else if (m->nc != r->s->ns - 1)
        snprintf(r->why, PM_REUSE_WHY, "it has %td chambers, the surfaces %td", m->nc,
                 r->s->ns - 1);
    else if (pm_mirrors_check(r->s, r->y, &broken) != PM_OK)
        snprintf(r->why, PM_REUSE_WHY, "%.200s", broken.text);
    else
        *fit = 1;
done:
    return status;
}

/* To other control points, *near where the nodes are next to these surfaces. */
static enum pm_status carry(struct pm_reuse *r, struct pm_mesh *m, int *near, struct pm_err *err)
{
    enum pm_status status;
    struct pm_carry_report report;
    struct pm_err bare = {.status = PM_OK};
    *near = 0;
    status = pm_mesh_carry(r->s, r->y->planes, m, &report, &bare);
    if (status == PM_NUMERIC) { /* a place that no control point covers */
        snprintf(r->why, PM_REUSE_WHY, "%.200s", bare.text);
        return PM_OK;
    }
    if (status != PM_OK) {
        *err = bare;
        return status;
    }
    pm_log(1, "other control points: nodes up to %.3g mm off, %td mid-side nodes damped",
           report.furthest, report.damped);
    *near = report.furthest <= FAR * r->size;
    if (!*near)
        snprintf(r->why, PM_REUSE_WHY,
                 "it has another parametrisation and lies up to %.3g mm off, expected %.3g",
                 report.furthest, FAR * r->size);
    return PM_OK;
}

enum pm_status pm_reuse_mesh(struct pm_reuse *r, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int fit, same;
    PM_TRY(pm_mesh_load(r->path, 1, m, err));
    PM_TRY(fits(r, m, &fit, err));
    if (!fit)
        goto done;
    PM_TRY(pm_weights_same(m, r->s, &same, err));
    if (same)
        PM_TRY(morph(r, 0, m, err));
    else
        PM_TRY(carry(r, m, &fit, err));
    if (same && !r->good) { /* damping has changed it */
        pm_mesh_release(m);
        PM_TRY(pm_mesh_load(r->path, 1, m, err));
    }
    if (fit && !r->good)
        PM_TRY(morph(r, 1, m, err));
    if (r->good)
        PM_TRY(look_at_edges(r, m, err));
done:
    if (status != PM_OK || !r->good)
        pm_mesh_release(m);
    return status;
}
