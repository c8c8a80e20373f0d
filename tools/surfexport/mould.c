#include "tools/surfexport/mould.h"

#include <math.h>

#include "common/base/memory.h"
#include "tools/surfexport/close.h"
#include "tools/surfexport/cut.h"

enum { AROUND_PIN = 32 };

static void bounds(const struct skin *s, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
    }
    for (ptrdiff_t k = 0; k < 3 * s->nt; k++)
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], s->x[3 * s->tri[k] + i]);
            high[i] = fmax(high[i], s->x[3 * s->tri[k] + i]);
        }
}

enum pm_status mould_block(const struct skin *robot, const struct mould_opts *o, double low[3],
                           double high[3], struct pm_err *err)
{
    double base = 0;
    for (ptrdiff_t t = 0; t < robot->nt; t++)
        if (robot->tag[t] == PM_FACE_BASE)
            base = robot->x[3 * robot->tri[3 * t] + 2];
    bounds(robot, low, high);
    if (!(low[o->pull] < -o->snap && high[o->pull] > o->snap))
        return pm_fail(err, PM_INPUT, "the plane %c = 0 misses the body, %g to %g mm",
                       "xyz"[o->pull], low[o->pull], high[o->pull]);
    if (low[2] < base)
        return pm_fail(err, PM_INPUT,
                       "the body reaches down to z = %g mm, expected none below its base at %g mm",
                       low[2], base);
    for (int i = 0; i < 3; i++) {
        low[i] -= i < 2 ? o->wall : 0;
        high[i] += o->wall;
    }
    return PM_OK;
}

/* A quadrangle, its corners counter-clockwise seen from outside. */
static enum pm_status add_quad(struct skin *s, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c, ptrdiff_t d,
                               int32_t tag, struct pm_err *err)
{
    const enum pm_status status = skin_add_triangle(s, a, b, c, tag, err);
    return status != PM_OK ? status : skin_add_triangle(s, a, c, d, tag, err);
}

/* The outer faces of a half block but those in the planes of parting and base. Seen in the axes
 * (u, pull, z) with corners number u + 2 v + 4 w, v = 1 far from the parting plane. */
static enum pm_status add_block(struct skin *s, const double low[3], const double high[3], int pull,
                                int side, struct pm_err *err)
{
    /* outward where (u, pull, z) is right-handed and the half lies at pull > 0 */
    static const int face[4][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {2, 6, 7, 3}, {4, 5, 7, 6}};
    enum pm_status status = PM_OK;
    const ptrdiff_t first = s->nn;
    const int mirrored = (pull == 0) != (side < 0);
    for (int k = 0; k < 8; k++) {
        double x[3];
        x[1 - pull] = k & 1 ? high[1 - pull] : low[1 - pull];
        x[pull] = !(k & 2) ? 0 : side > 0 ? high[pull] : low[pull];
        x[2] = k & 4 ? high[2] : low[2];
        PM_TRY(skin_add_node(s, x, -1, err));
    }
    for (int f = 0; f < 4; f++) {
        const int *v = face[f];
        PM_TRY(add_quad(s, first + v[0], first + v[mirrored ? 3 : 1], first + v[2],
                        first + v[mirrored ? 1 : 3], SKIN_MOULD, err));
    }
done:
    return status;
}

/* A truncated cone from the parting plane: `height` along +pull, radius r there and r_end at its
 * end, all normals away from the material of the half at `side`: a pin where height has the other
 * sign than side, else a hole. The plane is left open. */
static enum pm_status add_pin(struct skin *s, const double center[3], int pull, int side, double r,
                              double r_end, double height, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const ptrdiff_t first = s->nn;
    /* counter-clockwise seen from outside of the half, from -side */
    const int u = (pull + (side < 0 ? 1 : 2)) % 3, v = (pull + (side < 0 ? 2 : 1)) % 3;
    for (int k = 0; k < 2 * AROUND_PIN; k++) {
        const double angle = 2 * acos(-1.0) * (k % AROUND_PIN) / AROUND_PIN;
        const double radius = k < AROUND_PIN ? r : r_end;
        double x[3];
        x[u] = center[u] + radius * cos(angle);
        x[v] = center[v] + radius * sin(angle);
        x[pull] = k < AROUND_PIN ? 0 : height;
        PM_TRY(skin_add_node(s, x, -1, err));
    }
    for (int k = 0; k < AROUND_PIN; k++) {
        const int next = (k + 1) % AROUND_PIN;
        PM_TRY(add_quad(s, first + k, first + next, first + AROUND_PIN + next,
                        first + AROUND_PIN + k, SKIN_MOULD, err));
        if (k > 0 && next > 0)
            PM_TRY(skin_add_triangle(s, first + AROUND_PIN, first + AROUND_PIN + k,
                                     first + AROUND_PIN + next, SKIN_MOULD, err));
    }
done:
    return status;
}

/* Four pins in the margin of the block, of a diameter of half of its thickness. */
static enum pm_status add_pins(struct skin *s, const double low[3], const double high[3],
                               const struct mould_opts *o, int side, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double w = o->wall, gap = side > 0 ? 0 : o->clearance;
    const int across = 1 - o->pull;
    for (int k = 0; k < 4; k++) {
        double center[3] = {0};
        center[across] = k & 1 ? high[across] - w / 2 : low[across] + w / 2;
        center[2] = k & 2 ? high[2] - w / 2 : low[2] + w / 2;
        /* both reach to -pull: a pin of the half at +pull, a hole of the other */
        PM_TRY(add_pin(s, center, o->pull, side, w / 4 + gap, w / 5 + gap, -(w / 2 + gap), err));
    }
done:
    return status;
}

/* Share of the area of the exterior at `side` of the plane whose normal points against the way out.
 * Normals are means over the facets around a node: single facets lean by the size of the triangles.
 */
static enum pm_status undercut_of(const struct skin *s, int pull, int side, double *share,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *normal = NULL, all = 0, bad = 0, n[3];
    PM_TRY(PM_NEW(normal, 3 * s->nn, err));
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        skin_normal(s, t, n);
        for (int k = 0; k < 9 && s->tag[t] == PM_FACE_EXTERIOR; k++)
            normal[3 * s->tri[3 * t + k / 3] + k % 3] += n[k % 3];
    }
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double mean[3] = {0}, place = 0;
        for (int k = 0; k < 9; k++) {
            const double *m = normal + 3 * (ptrdiff_t)s->tri[3 * t + k / 3];
            const double l = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
            mean[k % 3] += l > 0 ? m[k % 3] / l : 0;
            place += k % 3 == pull ? s->x[3 * s->tri[3 * t + k / 3] + pull] : 0;
        }
        if (s->tag[t] != PM_FACE_EXTERIOR || side * place <= 0)
            continue;
        skin_normal(s, t, n);
        const double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        all += area;
        /* walls along the pull are none */
        bad += side * mean[pull] < -0.02 ? area : 0;
    }
    *share = all > 0 ? bad / all : 0;
done:
    pm_free(normal);
    return status;
}

enum pm_status mould_half(const struct skin *robot, const struct mould_opts *o, int side,
                          struct skin *half, double *undercut, struct pm_err *err)
{
    enum pm_status status;
    struct skin body = {0};
    double low[3], high[3];
    PM_TRY(skin_extract(robot, PM_FACE_TIP, PM_FACE_EXTERIOR, &body, err));
    PM_TRY(mould_block(robot, o, low, high, err));
    skin_drop(&body, PM_FACE_BASE);
    PM_TRY(skin_cut(&body, o->pull, 0, side, o->snap, half, err));
    PM_TRY(undercut_of(robot, o->pull, side, undercut, err));
    skin_flip(half, INT32_MIN, INT32_MAX);
    PM_TRY(add_block(half, low, high, o->pull, side, err));
    PM_TRY(add_pins(half, low, high, o, side, err));
    PM_TRY(skin_close(half, o->pull, 0, -side, SKIN_MOULD, err));
    PM_TRY(skin_close(half, 2, low[2], -1, SKIN_MOULD, err));
done:
    skin_release(&body);
    return status;
}
