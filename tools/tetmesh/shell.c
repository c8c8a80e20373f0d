#include "tools/tetmesh/shell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/geometry/collide.h"
#include "common/geometry/remesh.h"
#include "tools/tetmesh/flat.h"

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

enum pm_status pm_shell_grow(struct pm_shell *s, ptrdiff_t nn, ptrdiff_t nt, struct pm_err *err)
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
                                int32_t type, struct pm_err *err)
{
    if (pm_shell_grow(s, p->nn, p->nt, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t a = 0; a < p->nn; a++)
        for (int j = 0; j < 2; j++)
            if (p->rim[a] & pm_rim_plane(type, j) && s->planes >> j & 1)
                p->x[3 * a + j] = 0;
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

enum pm_status pm_shell_build(const struct pm_surfaces *s, const struct pm_mirrors *y, double size,
                              double timeout, struct pm_shell *shell, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_remesh_opts o = {
        .size = size, .size_min = size / 6, .crest = 1.2, .growth = 0.35, .sweeps = 8};
    struct pm_patch patch = {0};
    *shell = (struct pm_shell){.planes = y->planes};
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        int kept;
        const unsigned cut = pm_mirrors_cut(y, s, k, &kept);
        if (!kept)
            continue;
        for (int j = 0; j < 2; j++)
            o.mirror[j] = cut >> j & 1;
        PM_TRY(pm_remesh(&s->s[k], (int)k, &o, &patch, err));
        PM_TRY(add_patch(shell, &patch, (int32_t)k, s->s[k].type, err));
        if (k == 0) {
            PM_TRY(pm_flat_cap(shell, &patch, 1, size, timeout, err));
            PM_TRY(pm_flat_cap(shell, &patch, 2, size, timeout, err));
        }
        pm_patch_release(&patch);
    }
done:
    pm_patch_release(&patch);
    if (status != PM_OK)
        pm_shell_release(shell);
    return status;
}

/* Triangles of the exterior with its caps (tag 0) or of one chamber, copied together. Faces on
 * mirror planes, which go through the origin, would have no part in their volume. */
static ptrdiff_t gather(const struct pm_shell *s, int32_t tag, int32_t *out)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++)
        if ((tag == 0 && s->tag[t] <= 0) || s->tag[t] == tag)
            memcpy(out + 3 * n++, s->tri + 3 * t, 3 * sizeof *out);
    return n;
}

/* A surface that passes a mirror plane meets its image there; one that is not cut there keeps half
 * of the distance that two surfaces do. */
static enum pm_status check_planes(const struct pm_shell *s, struct pm_err *err)
{
    unsigned cut[PM_MAX_CHAMBERS + 1] = {0};
    char name[32];
    for (ptrdiff_t a = 0; a < s->nn; a++)
        for (int j = 0; j < 2 && s->surface[a] >= 0; j++)
            cut[s->surface[a]] |= (unsigned)(s->x[3 * a + j] == 0) << j;
    for (ptrdiff_t a = 0; a < s->nn; a++)
        for (int j = 0; j < 2; j++) {
            const int32_t k = s->surface[a];
            const double *p = s->x + 3 * a;
            if (k < 0 || !(s->planes >> j & 1) || p[j] >= (cut[k] >> j & 1 ? 0 : s->size[a] / 40))
                continue;
            return pm_fail(err, PM_INPUT,
                           "%s meets its image at the mirror plane %c = 0: it is at (%.3f, %.3f, "
                           "%.3f) mm, meshed with edges of %.3g mm",
                           pm_shell_name(k, name), "xy"[j], p[0], p[1], p[2], s -> size[a]);
        }
    return PM_OK;
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

/* Winding number of a surface and its images at the mirror planes. */
static double winding(const struct pm_shell *s, const double *p, ptrdiff_t n, const int32_t *part)
{
    double sum = 0;
    for (unsigned image = 0; image < 4; image++) {
        if ((image & ~s->planes) != 0)
            continue;
        const double q[3] = {image & 1 ? -p[0] : p[0], image & 2 ? -p[1] : p[1], p[2]};
        sum += pm_collide_winding(q, s->x, n, part);
    }
    return sum;
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
        if (n == 0)
            continue; /* it is behind a mirror plane */
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
            const int inside = winding(s, p, n, part) > 0.5;
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
    PM_TRY(check_planes(s, err));
    PM_TRY(check_crossing(s, err));
    PM_TRY(check_nesting(s, nchambers, err));
    PM_TRY(check_near(s, err));
done:
    return status;
}
