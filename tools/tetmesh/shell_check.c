#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/geometry/collide.h"
#include "tools/tetmesh/shell.h"

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

/* Facets that meet where the surfaces do not. */
static enum pm_status too_coarse(const struct pm_contact *c, int32_t high, int32_t low, double h,
                                 struct pm_err *err)
{
    char a[32], b[32];
    return pm_fail(err, PM_INPUT,
                   "%s is too near %s at (%.3f, %.3f, %.3f) mm for flat faces with edges of %.3g "
                   "mm, expected a smaller size",
                   pm_shell_name(high, a), high == low ? "itself" : pm_shell_name(low, b), c->at[0],
                   c->at[1], c->at[2], h);
}

static enum pm_status check_crossing(const struct pm_shell *s, int flat, struct pm_err *err)
{
    struct pm_contact c;
    char a[32], b[32];
    const enum pm_status status = pm_collide_pierce(s->x, s->nt, s->tri, &c, err);
    if (status != PM_OK || c.a < 0)
        return status;
    const int32_t high = s->tag[c.a] > s->tag[c.b] ? s->tag[c.a] : s->tag[c.b];
    const int32_t low = s->tag[c.a] > s->tag[c.b] ? s->tag[c.b] : s->tag[c.a];
    if (flat)
        return too_coarse(&c, high, low, s->size[s->tri[3 * c.a]], err);
    pm_shell_name(high, a);
    pm_shell_name(low, b);
    if (high == low)
        return pm_fail(err, PM_INPUT, "%s cuts itself at (%.3f, %.3f, %.3f) mm", a, c.at[0],
                       c.at[1], c.at[2]);
    return pm_fail(err, PM_INPUT, "%s%s cuts %s at (%.3f, %.3f, %.3f) mm", a,
                   high > 0 && low <= 0 ? " is partly outside the body: it" : "", b, c.at[0],
                   c.at[1], c.at[2]);
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

static enum pm_status check_near(const struct pm_shell *s, int flat, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_contact c;
    double *limit = NULL;
    char a[32], b[32];
    PM_TRY(PM_NEW(limit, s->nn, err));
    for (ptrdiff_t k = 0; k < s->nn; k++)
        limit[k] = s->surface[k] >= 0 ? s->size[k] / 20 : 0;
    PM_TRY(pm_collide_near(s->nn, s->x, limit, s->nt, s->tri, &c, err));
    if (c.a >= 0 && flat)
        status = too_coarse(&c, s->surface[c.a], s->tag[c.b], s->size[c.a], err);
    else if (c.a >= 0)
        status = pm_fail(
            err, PM_INPUT,
            "%s comes within %.3g mm of %s at (%.3f, %.3f, %.3f) mm, expected %.3g mm or more",
            pm_shell_name(s->surface[c.a], a), c.distance, pm_shell_name(s->tag[c.b], b), c.at[0],
            c.at[1], c.at[2], limit[c.a]);
done:
    pm_free(limit);
    return status;
}

enum pm_status pm_shell_check(const struct pm_shell *shell, const struct pm_shell *bent,
                              ptrdiff_t nchambers, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(check_planes(bent, err));
    PM_TRY(check_crossing(bent, 0, err));
    PM_TRY(check_nesting(bent, nchambers, err));
    PM_TRY(check_near(bent, 0, err));
    PM_TRY(check_crossing(shell, 1, err));
    PM_TRY(check_near(shell, 1, err));
done:
    return status;
}
