#include "tools/tetmesh/shell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/geometry/collide.h"
#include "common/geometry/remesh.h"
#include "tools/tetmesh/volume_gmsh.h"

void pm_shell_release(struct pm_shell *s)
{
    pm_free(s->x);
    pm_free(s->size);
    pm_free(s->S);
    pm_free(s->surface);
    pm_free(s->tri);
    pm_free(s->tag);
    *s = (struct pm_shell){0};
}

const char *pm_shell_name(int32_t tag, char name[32])
{
    if (tag > 0)
        snprintf(name, 32, "chamber %d", (int)tag);
    else
        snprintf(name, 32, "%s",
                 tag == PM_FACE_EXTERIOR ? "exterior"
                 : tag == PM_FACE_BASE   ? "base"
                                         : "tip");
    return name;
}

static enum pm_status grow(struct pm_shell *s, ptrdiff_t nn, ptrdiff_t nt, struct pm_err *err)
{
    PM_GROW(s->x, 3 * (s->nn + nn), err);
    PM_GROW(s->size, s->nn + nn, err);
    PM_GROW(s->S, 3 * (s->nn + nn), err);
    PM_GROW(s->surface, s->nn + nn, err);
    PM_GROW(s->tri, 3 * (s->nt + nt), err);
    PM_GROW(s->tag, s->nt + nt, err);
    return PM_OK;
}

static enum pm_status add_patch(struct pm_shell *s, const struct pm_patch *p, int32_t k,
                                struct pm_err *err)
{
    if (grow(s, p->nn, p->nt, err) != PM_OK)
        return PM_SYSTEM;
    memcpy(s->x + 3 * s->nn, p->x, (size_t)(3 * p->nn) * sizeof *s->x);
    memcpy(s->S + 3 * s->nn, p->S, (size_t)(3 * p->nn) * sizeof *s->S);
    memcpy(s->size + s->nn, p->size, (size_t)p->nn * sizeof *s->size);
    for (ptrdiff_t a = 0; a < p->nn; a++)
        s->surface[s->nn + a] = k;
    for (ptrdiff_t i = 0; i < 3 * p->nt; i++)
        s->tri[3 * s->nt + i] = (int32_t)(s->nn + p->tri[i]);
    for (ptrdiff_t t = 0; t < p->nt; t++)
        s->tag[s->nt + t] = k;
    s->nn += p->nn;
    s->nt += p->nt;
    return PM_OK;
}

struct rim_node {
    double angle;
    int32_t id;
};

static int by_angle(const void *a, const void *b)
{
    const struct rim_node *p = a, *q = b;
    return (p->angle > q->angle) - (p->angle < q->angle);
}

/* Nodes of one rim counter-clockwise; the exterior is the first patch, so ids are those of the
 * shell. */
static enum pm_status find_rim(const struct pm_patch *p, int rim, struct rim_node **out,
                               ptrdiff_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t count = 0;
    struct rim_node *r = NULL;
    PM_TRY(PM_NEW(r, p->nn, err));
    for (ptrdiff_t a = 0; a < p->nn; a++)
        if (p->rim[a] == rim)
            r[count++] = (struct rim_node){atan2(p->S[3 * a + 1], p->S[3 * a]), (int32_t)a};
    qsort(r, (size_t)count, sizeof *r, by_angle);
    for (ptrdiff_t k = 1; k < count; k++)
        if (fabs(p->x[3 * r[k].id + 2] - p->x[3 * r[0].id + 2]) >
            1e-9 * fmax(1, fabs(p->x[3 * r[0].id + 2])))
            PM_TRY(pm_fail(
                err, PM_INPUT, "the rim of the exterior at the %s is not planar: z = %g and %g",
                rim == 1 ? "base" : "tip", p->x[3 * r[0].id + 2], p->x[3 * r[k].id + 2]));
done:
    *out = r;
    *n = count;
    return status;
}

static enum pm_status add_cap(struct pm_shell *s, const struct pm_patch *p, int rim, double size,
                              double timeout, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct rim_node *r = NULL;
    struct pm_planar disc = {0};
    double *loop = NULL;
    ptrdiff_t n = 0;
    PM_TRY(find_rim(p, rim, &r, &n, err));
    PM_TRY(PM_NEW(loop, 3 * n, err));
    for (ptrdiff_t k = 0; k < n; k++)
        memcpy(loop + 3 * k, p->x + 3 * r[k].id, 3 * sizeof *loop);
    PM_TRY(pm_gmsh_disc(n, loop, size, timeout, &disc, err));
    const ptrdiff_t inner = disc.nn - n;
    PM_TRY(grow(s, inner, disc.nt, err));
    for (ptrdiff_t a = 0; a < inner; a++) {
        memcpy(s->x + 3 * (s->nn + a), disc.x + 3 * (n + a), 2 * sizeof *s->x);
        s->x[3 * (s->nn + a) + 2] = loop[2];
        memset(s->S + 3 * (s->nn + a), 0, 3 * sizeof *s->S);
        s->size[s->nn + a] = size;
        s->surface[s->nn + a] = -1;
    }
    for (ptrdiff_t t = 0; t < disc.nt; t++) {
        for (int k = 0; k < 3; k++) {
            const int32_t a = disc.tri[3 * t + (rim == 1 ? 2 - k : k)];
            s->tri[3 * (s->nt + t) + k] = a < n ? r[a].id : (int32_t)(s->nn + a - n);
        }
        s->tag[s->nt + t] = rim == 1 ? PM_FACE_BASE : PM_FACE_TIP;
    }
    s->nn += inner;
    s->nt += disc.nt;
done:
    pm_free(r);
    pm_free(loop);
    pm_free(disc.x);
    pm_free(disc.tri);
    return status;
}

enum pm_status pm_shell_build(const struct pm_surfaces *s, double size, double timeout,
                              struct pm_shell *shell, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_remesh_opts o = {
        .size = size, .size_min = size / 3, .crest = 1.2, .growth = 0.35, .sweeps = 8};
    struct pm_patch exterior = {0}, patch = {0};
    *shell = (struct pm_shell){0};
    PM_TRY(pm_remesh(&s->s[0], 0, &o, &exterior, err));
    PM_TRY(add_patch(shell, &exterior, 0, err));
    for (ptrdiff_t k = 1; k < s->ns; k++) {
        PM_TRY(pm_remesh(&s->s[k], (int)k, &o, &patch, err));
        PM_TRY(add_patch(shell, &patch, (int32_t)k, err));
        pm_patch_release(&patch);
    }
    PM_TRY(add_cap(shell, &exterior, 1, size, timeout, err));
    PM_TRY(add_cap(shell, &exterior, 2, size, timeout, err));
done:
    pm_patch_release(&exterior);
    pm_patch_release(&patch);
    if (status != PM_OK)
        pm_shell_release(shell);
    return status;
}

/* Triangles of the exterior with its caps (tag 0) or of one chamber, copied together. */
static ptrdiff_t gather(const struct pm_shell *s, int32_t tag, int32_t *out)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++)
        if ((tag == 0 && s->tag[t] <= 0) || s->tag[t] == tag)
            memcpy(out + 3 * n++, s->tri + 3 * t, 3 * sizeof *out);
    return n;
}

static enum pm_status check_crossing(const struct pm_shell *s, struct pm_err *err)
{
    struct pm_contact c;
    char a[32], b[32];
    const enum pm_status status = pm_collide_pierce(s->x, s->nt, s->tri, &c, err);
    if (status != PM_OK || c.a < 0)
        return status;
    const int32_t high = s->tag[c.a] > s->tag[c.b] ? s->tag[c.a] : s->tag[c.b];
    const int32_t low = s->tag[c.a] > s->tag[c.b] ? s->tag[c.b] : s->tag[c.a];
    pm_shell_name(high, a);
    pm_shell_name(low, b);
    if (high == low)
        return pm_fail(err, PM_INPUT,
                       "%s cuts itself at (%.3f, %.3f, %.3f) mm, meshed with edges of %.3g mm", a,
                       c.at[0], c.at[1], c.at[2], s->size[s->tri[3 * c.a]]);
    return pm_fail(err, PM_INPUT,
                   "%s%s cuts %s at (%.3f, %.3f, %.3f) mm, meshed with edges of %.3g mm", a,
                   high > 0 && low <= 0 ? " is partly outside the body: it" : "", b, c.at[0],
                   c.at[1], c.at[2], s->size[s->tri[3 * c.a]]);
}

/* Nothing crosses any more, so one node of a chamber decides. */
static enum pm_status check_nesting(const struct pm_shell *s, ptrdiff_t nchambers,
                                    struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *part = NULL;
    char name[32];
    PM_TRY(PM_NEW(part, 3 * s->nt, err));
    for (int32_t k = 0; k <= nchambers; k++) {
        const ptrdiff_t n = gather(s, k, part);
        const double volume = pm_collide_volume(s->x, n, part);
        if (!(volume > 0))
            PM_TRY(pm_fail(err, PM_INPUT, "%s is inside out: it encloses %g mm3",
                           pm_shell_name(k, name), volume));
        for (int32_t j = 1; j <= nchambers; j++) {
            ptrdiff_t a = 0;
            while (a < s->nn && s->surface[a] != j)
                a++;
            if (a == s->nn || j == k)
                continue;
            const double *p = s->x + 3 * a;
            const int inside = pm_collide_winding(p, s->x, n, part) > 0.5;
            if (k == 0 && !inside)
                PM_TRY(pm_fail(err, PM_INPUT,
                               "chamber %d is outside the body, at (%.3f, %.3f, %.3f) mm", (int)j,
                               p[0], p[1], p[2]));
            if (k > 0 && inside)
                PM_TRY(pm_fail(err, PM_INPUT,
                               "chamber %d is inside chamber %d, at (%.3f, %.3f, %.3f) mm", (int)j,
                               (int)k, p[0], p[1], p[2]));
        }
    }
done:
    pm_free(part);
    return status;
}

static enum pm_status check_near(const struct pm_shell *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_contact c;
    double *limit = NULL;
    char a[32], b[32];
    PM_TRY(PM_NEW(limit, s->nn, err));
    for (ptrdiff_t k = 0; k < s->nn; k++)
        limit[k] = s->surface[k] >= 0 ? s->size[k] / 20 : 0;
    PM_TRY(pm_collide_near(s->nn, s->x, limit, s->nt, s->tri, &c, err));
    if (c.a >= 0)
        status = pm_fail(
            err, PM_INPUT,
            "%s comes within %.3g mm of %s at (%.3f, %.3f, %.3f) mm, expected %.3g mm or more",
            pm_shell_name(s->surface[c.a], a), c.distance, pm_shell_name(s->tag[c.b], b), c.at[0],
            c.at[1], c.at[2], limit[c.a]);
done:
    pm_free(limit);
    return status;
}

enum pm_status pm_shell_check(const struct pm_shell *s, ptrdiff_t nchambers, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(check_crossing(s, err));
    PM_TRY(check_nesting(s, nchambers, err));
    PM_TRY(check_near(s, err));
done:
    return status;
}
