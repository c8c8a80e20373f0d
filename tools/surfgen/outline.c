#include "tools/surfgen/outline.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/surfgen/pneunet.h"
#include "tools/surfgen/profile.h"

static const double TWO_PI = 6.283185307179586476925;

enum { LEVELS = 401, POINTS = 720, MAX_STEPS = 20000, FINE = 100 };

static const double STEP = 0.1;   /* of the tracing [mm] */
static const double FILLET = 6.0; /* reach of the blend between two parts [mm] */
static const double ROUND = 2.0;  /* least radius of a neck of the body [mm] */

struct pm_outline {
    double height;
    double *xy; /* (LEVELS x POINTS x 2) [mm] */
    struct pm_pneunet *net;
    double *s; /* arc length at tau = i / FINE (FINE * parts + 1) [mm] */
};

/* Distance of p from a part with its gradient: f, df/dx, df/dy. */
struct level {
    double f, d[2];
};

static struct level disc(const double p[2], const double centre[2], double radius)
{
    double d[2] = {p[0] - centre[0], p[1] - centre[1]}, len = fmax(hypot(d[0], d[1]), 1e-12);

    return (struct level){len - radius, {d[0] / len, d[1] / len}};
}

/* Distance from the ellipse of half-axes a, b about the origin: the foot is
 * (a^2 x / (t + a^2), b^2 y / (t + b^2)) at the largest root t; Newton's method from the left of it
 * is monotone. */
static struct level ellipse(const double p[2], double a, double b)
{
    double u = a * fabs(p[0]), v = b * fabs(p[1]), t = fmax(u - a * a, v - b * b), n[2], len;

    for (int it = 0; it < 50; it++) {
        double g = u / (t + a * a), h = v / (t + b * b), f = g * g + h * h - 1;
        double step = f / (2 * (g * g / (t + a * a) + h * h / (t + b * b)));
        t += step;
        if (!(fabs(step) > 1e-13 * a * b))
            break;
    }
    n[0] = p[0] / (t + a * a);
    n[1] = p[1] / (t + b * b);
    len = fmax(hypot(n[0], n[1]), 1e-12);
    return (struct level){t * len, {n[0] / len, n[1] / len}};
}

/* The section of a chamber with a wall around: the disc where it is round, of the same radius. */
static struct level section(const struct pm_case *c, const struct pm_chamber *k, double radius,
                            double z, const double p[2])
{
    double core = fmax(radius - c->wall, 0.1), angle = pm_chamber_angle(k, z - k->center[2]);
    double e[2] = {cos(angle), sin(angle)};
    double d[2] = {p[0] - k->center[0], p[1] - k->center[1]};
    double q[2] = {e[0] * d[0] + e[1] * d[1], e[0] * d[1] - e[1] * d[0]};
    struct level f;

    if (k->section[0] == 1 && k->section[1] == 1)
        return disc(p, k->center, radius);
    f = ellipse(q, core * k->section[0], core * k->section[1]);
    return (struct level){f.f - (radius - core),
                          {e[0] * f.d[0] - e[1] * f.d[1], e[1] * f.d[0] + e[0] * f.d[1]}};
}

static struct level box(const double p[2], double width, double depth, double rounding)
{
    double q[2] = {fabs(p[0]) - width / 2 + rounding, fabs(p[1]) - depth / 2 + rounding};
    int side = q[0] > q[1] ? 0 : 1;
    double d[2] = {fmax(q[0], 0), fmax(q[1], 0)}, len = hypot(d[0], d[1]);

    if (q[1 - side] <= 0) {
        len = q[side];
        d[side] = 1;
        d[1 - side] = 0;
    } else {
        d[0] /= len;
        d[1] /= len;
    }
    return (struct level){len - rounding, {copysign(d[0], p[0]), copysign(d[1], p[1])}};
}

static struct level web(const double p[2], const double end[2], double half)
{
    double len2 = end[0] * end[0] + end[1] * end[1];
    double t = len2 > 0 ? fmin(fmax((p[0] * end[0] + p[1] * end[1]) / len2, 0), 1) : 0;
    double foot[2] = {t * end[0], t * end[1]};

    return disc(p, foot, half);
}

/* Smooth minimum, cubic in the difference: never above either, C^2. */
static struct level join(struct level a, struct level b)
{
    double h = fmax(FILLET - fabs(a.f - b.f), 0) / FILLET, w = h * h / 2;
    struct level low = a.f < b.f ? a : b, high = a.f < b.f ? b : a;

    return (struct level){low.f - h * h * h * FILLET / 6,
                          {(1 - w) * low.d[0] + w * high.d[0], (1 - w) * low.d[1] + w * high.d[1]}};
}

/* Chambers on one axis share the larger disc. */
static struct level body(const struct pm_case *c, const double *radius, double z, const double p[2])
{
    struct level all = {INFINITY, {0}};

    if (c->body == PM_BODY_CYLINDER)
        return disc(p, (const double[2]){0, 0}, c->body_radius);
    if (c->body == PM_BODY_BOX)
        return box(p, c->body_width, c->body_depth, c->body_rounding);
    for (ptrdiff_t k = 0; k < c->nchambers; k++) {
        struct level own = section(c, &c->chamber[k], radius[k], z, p);
        int seen = 0;
        for (ptrdiff_t l = 0; l < c->nchambers; l++) {
            const double *a = c->chamber[k].center, *b = c->chamber[l].center;
            seen |= hypot(a[0] - b[0], a[1] - b[1]) < 1e-9 &&
                    (radius[l] > radius[k] || (l < k && radius[l] == radius[k]));
        }
        if (seen)
            continue;
        if (c->web > 0)
            own = join(own, web(p, c->chamber[k].center, c->web));
        all = isfinite(all.f) ? join(all, own) : own;
    }
    return all;
}

/* Radius of the offset of the profile by t at height z: max over u of r(u) + sqrt(t^2 - (z-u)^2).
 */
static double dilate(const struct pm_chamber *c, double t, double z)
{
    double best = 0;

    for (int i = -FINE; i <= FINE; i++) {
        double u = t * i / FINE;
        best = fmax(best, pm_profile_outer(c, z - c->center[2] + u) + sqrt(t * t - u * u));
    }
    return best;
}

/* Radius of a chamber's disc at all levels: offset by wall + ROUND, then back by ROUND, which fills
 * the necks until their radius of curvature is ROUND. */
static enum pm_status offsets(const struct pm_case *c, const struct pm_chamber *chamber,
                              double *radius, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double step = c->height / (LEVELS - 1), *wide = NULL;
    ptrdiff_t reach = (ptrdiff_t)(ROUND / step), n = LEVELS + 2 * reach;

    PM_TRY(PM_NEW(wide, n, err));
    for (ptrdiff_t i = 0; i < n; i++)
        wide[i] = dilate(chamber, c->wall + ROUND, (double)(i - reach) * step);
    for (ptrdiff_t l = 0; l < LEVELS; l++) {
        radius[l] = HUGE_VAL;
        for (ptrdiff_t i = -reach; i <= reach; i++) {
            double u = (double)i * step;
            radius[l] = fmin(radius[l], wide[l + reach + i] - sqrt(ROUND * ROUND - u * u));
        }
    }
done:
    pm_free(wide);
    return status;
}

/* One Newton step to the curve along the gradient. */
static double correct(const struct pm_case *c, const double *radius, double z, double p[2],
                      double tangent[2])
{
    struct level b = body(c, radius, z, p);
    double g = b.d[0] * b.d[0] + b.d[1] * b.d[1];

    p[0] -= b.f * b.d[0] / g;
    p[1] -= b.f * b.d[1] / g;
    tangent[0] = -b.d[1] / sqrt(g);
    tangent[1] = b.d[0] / sqrt(g);
    return fabs(b.f) / sqrt(g);
}

/* Is chamber l another one on the axis of chamber k, beside the level z? */
static int beside(const struct pm_case *c, ptrdiff_t k, ptrdiff_t l, double z)
{
    const double *a = c->chamber[k].center, *b = c->chamber[l].center;

    return k != l && hypot(a[0] - b[0], a[1] - b[1]) < 1e-9 &&
           fabs(z - b[2]) < pm_profile_half(&c->chamber[l]) &&
           fabs(z - a[2]) >= pm_profile_half(&c->chamber[k]);
}

/* Follows the curve once around from the +x axis into path; returns its points, 0 where it does not
 * close. */
static ptrdiff_t trace(const struct pm_case *c, const double *radius, double z, double *path)
{
    double p[2] = {4 * c->height, 0}, t[2], turned = 0;
    ptrdiff_t n = 0;

    do { /* the outermost crossing of the +x axis */
        p[0] -= 5 * STEP;
        if (p[0] < 0)
            return 0;
    } while (body(c, radius, z, p).f > 0);
    while (correct(c, radius, z, p, t) > 1e-10 && n < 50)
        n++;
    n = 0;
    while (n < MAX_STEPS) {
        double before = atan2(p[1], p[0]), step;
        memcpy(&path[2 * n++], p, sizeof p);
        correct(c, radius, z, p, t);
        p[0] += STEP * t[0];
        p[1] += STEP * t[1];
        for (int it = 0; it < 8 && correct(c, radius, z, p, t) > 1e-10; it++)
            ;
        step = atan2(p[1], p[0]) - before;
        step -= TWO_PI * round(step / TWO_PI);
        turned += step;
        if (turned >= TWO_PI - 1e-9)
            return n;
    }
    return 0;
}

/* Points uniform in arc length on the closed polygon of n points. */
static void resample(const double *path, ptrdiff_t n, double *out)
{
    double total = 0, done = 0;
    ptrdiff_t at = 0, k = 0;

    for (ptrdiff_t i = 0; i < n; i++) {
        const double *a = &path[2 * i], *b = &path[2 * ((i + 1) % n)];
        total += hypot(b[0] - a[0], b[1] - a[1]);
    }
    while (k < POINTS) {
        const double *a = &path[2 * at], *b = &path[2 * ((at + 1) % n)];
        double len = hypot(b[0] - a[0], b[1] - a[1]), w = (total * (double)k / POINTS - done) / len;
        if (w > 1 && at + 1 < n) {
            done += len;
            at++;
            continue;
        }
        out[2 * k] = a[0] + w * (b[0] - a[0]);
        out[2 * k + 1] = a[1] + w * (b[1] - a[1]);
        k++;
    }
}

static enum pm_status around_cells(const struct pm_case *c, struct pm_outline *o,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *r = NULL;
    ptrdiff_t n;

    PM_TRY(pm_pneunet_body(c, &o->net, err));
    n = FINE * pm_pneunet_parts(o->net) + 1;
    PM_TRY(PM_NEW(o->s, n, err));
    PM_TRY(PM_NEW(r, n, err));
    pm_pneunet_table(o->net, FINE, o->s, r);
done:
    pm_free(r);
    return status;
}

enum pm_status pm_outline_new(const struct pm_case *c, struct pm_outline **out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_outline *o = NULL;
    double *path = NULL, *table = NULL, radius[PM_MAX_CHAMBERS] = {0};

    *out = NULL;
    PM_TRY(PM_NEW(o, 1, err));
    o->height = c->height;
    if (c->nchambers > 0 && c->chamber[0].shape == PM_SHAPE_PNEUNET) {
        PM_TRY(around_cells(c, o, err));
        *out = o;
        return PM_OK;
    }
    PM_TRY(PM_NEW(o->xy, 2 * LEVELS * POINTS, err));
    PM_TRY(PM_NEW(path, 2 * MAX_STEPS, err));
    PM_TRY(PM_NEW(table, PM_MAX_CHAMBERS * LEVELS, err));
    for (ptrdiff_t k = 0; c->body == PM_BODY_ENVELOPE && k < c->nchambers; k++)
        PM_TRY(offsets(c, &c->chamber[k], &table[k * LEVELS], err));
    for (ptrdiff_t level = 0; level < LEVELS; level++) {
        double z = c->height * (double)level / (LEVELS - 1);
        ptrdiff_t n;
        for (ptrdiff_t k = 0; k < c->nchambers;
             k++) { /* above and below, a chamber makes way for its neighbour */
            radius[k] = table[k * LEVELS + level];
            for (ptrdiff_t l = 0; l < c->nchambers; l++)
                radius[k] = beside(c, k, l, z) ? 0 : radius[k];
        }
        n = trace(c, radius, z, path);
        if (n < 8) {
            status = pm_fail(
                err, PM_INPUT,
                "cross-section of the body at z = %.4g is not one closed curve about the axis "
                "(wall %g, web %g)",
                z, c->wall, c->web);
            goto done;
        }
        resample(path, n, &o->xy[2 * POINTS * level]);
    }
    *out = o;
    o = NULL;
done:
    pm_outline_free(o);
    pm_free(path);
    pm_free(table);
    return status;
}

void pm_outline_free(struct pm_outline *o)
{
    if (o == NULL)
        return;
    pm_free(o->xy);
    pm_free(o->s);
    pm_pneunet_free(o->net);
    pm_free(o);
}

int pm_outline_is_level(const struct pm_outline *o)
{
    return o->net == NULL;
}

static void beside_cells(const struct pm_outline *o, double turn, double v, double x[3])
{
    ptrdiff_t lo = 0, hi = FINE * pm_pneunet_parts(o->net);
    double s = fmin(fmax(v, 0), 1) * o->s[hi];

    while (hi - lo > 1) {
        ptrdiff_t mid = (lo + hi) / 2;
        *(o->s[mid] <= s ? &lo : &hi) = mid;
    }
    pm_pneunet_point(o->net, ((double)lo + (s - o->s[lo]) / (o->s[hi] - o->s[lo])) / FINE, turn, x);
    x[2] += o->height / 2;
}

void pm_outline_point(const struct pm_outline *o, double turn, double v, double x[3])
{
    if (o->net != NULL) {
        beside_cells(o, turn, v, x);
        return;
    }
    double l = fmin(fmax(v, 0), 1) * (LEVELS - 1), a = (turn - floor(turn)) * POINTS;
    ptrdiff_t i = (ptrdiff_t)fmin(l, LEVELS - 2), j = (ptrdiff_t)a % POINTS;
    double w = l - (double)i, u = a - floor(a);

    for (int k = 0; k < 2; k++) {
        const double *low = &o->xy[2 * POINTS * i + k], *high = low + 2 * POINTS;
        ptrdiff_t p = 2 * j, q = 2 * ((j + 1) % POINTS);
        x[k] = (1 - w) * ((1 - u) * low[p] + u * low[q]) + w * ((1 - u) * high[p] + u * high[q]);
    }
    x[2] = o->height * v;
}
