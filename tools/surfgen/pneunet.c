#include "tools/surfgen/pneunet.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double PI = 3.141592653589793238463;

enum { MAX_CORNERS = 9, AROUND = 96 };

/* Radii of edges [mm]: two principal curvatures 1/1.6 stay below 1 /mm together. The corners of a
 * cell in its plane are rounder, so that they do not vanish on its flat ends. */
static const double CAVITY_EDGE = 1.6, CAVITY_CORNER = 2.8;
static const double FILLET = 2.4;          /* between cells and channel */
static const double CHANNEL_CORNER = 0.45; /* of its side [1] */
static const double INSET = 1.6; /* of the channel from the inner side of the cells [mm] */
static const double BODY_EDGE = 2.0, BODY_CORNER = 4.0;

/* A polygon with rounded corners at two levels, gap and cell: side k leads from corner k to k + 1,
 * the arc at corner k + 1 follows. Equal u have equal normals on both levels. */
struct pair {
    int n;
    double corner[2][MAX_CORNERS][2], radius[2][MAX_CORNERS];
    double end[2 * MAX_CORNERS]; /* u at the end of each piece */
    double start;                /* u of the middle of side 0 */
};

struct pm_pneunet {
    struct pair p;
    int closed;             /* ends in poles (a cavity), else in rims */
    ptrdiff_t half;         /* parts of the lower half */
    double length;          /* along z [mm] */
    double pitch, cell;     /* of the cells, along z [mm] */
    double convex, concave; /* radii of the edges along z [mm] */
};

struct point {
    double p[2], n[2]; /* place and normal */
};

static void direction(const double a[2], const double b[2], double e[2])
{
    double len = hypot(b[0] - a[0], b[1] - a[1]);

    e[0] = (b[0] - a[0]) / len;
    e[1] = (b[1] - a[1]) / len;
}

/* Directions before and after corner k, and its turning angle (positive: convex). */
static double turning(const struct pair *q, int level, int k, double e[2], double f[2])
{
    const double(*v)[2] = q->corner[level];

    direction(v[(k + q->n - 1) % q->n], v[k], e);
    direction(v[k], v[(k + 1) % q->n], f);
    return atan2(e[0] * f[1] - e[1] * f[0], e[0] * f[0] + e[1] * f[1]);
}

/* Distance from corner k to its arc. */
static double cut(const struct pair *q, int level, int k)
{
    double e[2], f[2];

    return q->radius[level][k] * tan(fabs(turning(q, level, k, e, f)) / 2);
}

static double side_length(const struct pair *q, int level, int k)
{
    const double *a = q->corner[level][k], *b = q->corner[level][(k + 1) % q->n];

    return hypot(b[0] - a[0], b[1] - a[1]) - cut(q, level, k) - cut(q, level, (k + 1) % q->n);
}

static double arc_length(const struct pair *q, int level, int k)
{
    double e[2], f[2];

    return fabs(turning(q, level, k, e, f)) * q->radius[level][k];
}

/* Pieces take the mean of their shares of both circumferences. PM_INPUT where a side is too short
 * for its corners. */
static enum pm_status divide(struct pair *q, struct pm_err *err)
{
    double share[2][2 * MAX_CORNERS], total[2] = {0}, sum = 0;

    for (int level = 0; level < 2; level++)
        for (int k = 0; k < q->n; k++) {
            share[level][2 * k] = side_length(q, level, k);
            share[level][2 * k + 1] = arc_length(q, level, (k + 1) % q->n);
            total[level] += share[level][2 * k] + share[level][2 * k + 1];
            if (!(share[level][2 * k] > 0))
                return pm_fail(err, PM_INPUT,
                               "cells are too small: a side is %.3g mm shorter than its rounded "
                               "corners",
                               -share[level][2 * k]);
        }
    for (int k = 0; k < 2 * q->n; k++) {
        sum += (share[0][k] / total[0] + share[1][k] / total[1]) / 2;
        q->end[k] = sum;
    }
    q->start = q->end[0] / 2;
    return PM_OK;
}

static struct point outline(const struct pair *q, int level, double u)
{
    double v = u + q->start, w, e[2], f[2], a;
    int k = 0, j;
    const double *from, *to;

    v -= floor(v);
    while (k < 2 * q->n - 1 && v > q->end[k])
        k++;
    w = (v - (k > 0 ? q->end[k - 1] : 0)) / (q->end[k] - (k > 0 ? q->end[k - 1] : 0));
    j = (k / 2 + 1) % q->n;
    from = q->corner[level][k / 2];
    to = q->corner[level][j];
    direction(from, to, e);
    if (k % 2 == 0) {
        double s = cut(q, level, k / 2) + w * side_length(q, level, k / 2);
        return (struct point){{from[0] + s * e[0], from[1] + s * e[1]}, {e[1], -e[0]}};
    }
    a = turning(q, level, j, e, f);
    double R = copysign(q->radius[level][j], a), c = cut(q, level, j);
    double n[2] = {cos(w * a) * e[1] + sin(w * a) * e[0], -cos(w * a) * e[0] + sin(w * a) * e[1]};
    return (struct point){
        {to[0] - c * e[0] + R * (n[0] - e[1]), to[1] - c * e[1] + R * (n[1] + e[0])}, {n[0], n[1]}};
}

/* From the middle of a cell (sigma = 0) to the middle of a gap (1) by arc length: two arcs and the
 * flank between them, less than a quarter each where the step m is small. */
static void flank(const struct pm_pneunet *net, double m, double sigma, double *h, double *z)
{
    double r = net->convex, f = net->concave, straight = fmax(m - r - f, 0);
    double a = straight > 0 ? PI / 2 : acos(1 - fmax(m, 0) / (r + f));
    double first = net->cell / 2 + (f - r) / 2 - (r + f) * sin(a) / 2;
    double last = net->pitch / 2 - first - (r + f) * sin(a);
    double s = sigma * (first + (r + f) * a + straight + last);

    if (s <= first) {
        *h = m;
        *z = s;
    } else if ((s -= first) <= r * a) {
        *h = m - r * (1 - cos(s / r));
        *z = first + r * sin(s / r);
    } else if ((s -= r * a) <= straight) {
        *h = m - r - s;
        *z = first + r;
    } else if ((s -= straight) <= f * a) {
        *h = f * (1 - cos(a - s / f));
        *z = first + (r + f) * sin(a) - f * sin(a - s / f);
    } else {
        *h = 0;
        *z = first + (r + f) * sin(a) + s - f * a;
    }
}

/* The end of a cavity: part 0 is flat from the pole to the rounded edge, part 1 the edge. */
static void cap(const struct pm_pneunet *net, double tau, const struct point *p, double x[3])
{
    const double(*v)[2] = net->p.corner[1];
    double r = net->convex, a = PI / 2 * fmax(tau - 1, 0), in = r * (1 - sin(a)), g = fmin(tau, 1);

    for (int j = 0; j < 2; j++) {
        double middle = (v[0][j] + v[2][j]) / 2;
        x[j] = middle + g * (p->p[j] - in * p->n[j] - middle);
    }
    x[2] = -net->length / 2 + r * (1 - cos(a));
}

/* A point between the levels: the step along the normal follows the flank in millimetres, what
 * remains of the way between the outlines is tangential and follows at the pace of the longest. */
static void between(const struct pm_pneunet *net, double sigma, double u, double x[3])
{
    struct point low = outline(&net->p, 0, u), high = outline(&net->p, 1, u);
    double d[2] = {high.p[0] - low.p[0], high.p[1] - low.p[1]}, h, pace, z;
    double m = fmax(d[0] * high.n[0] + d[1] * high.n[1], 0), far = 2 * (net->convex + net->concave);

    flank(net, far, sigma, &pace, &z);
    flank(net, m, sigma, &h, &z);
    for (int j = 0; j < 2; j++)
        x[j] = low.p[j] + (d[j] - m * high.n[j]) * pace / far + h * high.n[j];
    x[2] = z;
}

static void lower(const struct pm_pneunet *net, double tau, double u, double x[3])
{
    struct point p = outline(&net->p, 1, u);
    ptrdiff_t first = net->closed ? 3 : 1, j;
    double begin = -net->length / 2 + (net->closed ? net->convex : 0), z;
    double mid = -net->pitch / 2 * (double)(net->half - first), sigma;

    if (net->closed && tau < 2) {
        cap(net, tau, &p, x);
        return;
    }
    if (tau < (double)first) {
        memcpy(x, p.p, sizeof p.p);
        x[2] = begin + (mid - begin) * (tau - (double)first + 1);
        return;
    }
    j = (ptrdiff_t)fmin(tau - (double)first, (double)(net->half - first - 1));
    sigma = tau - (double)(first + j);
    between(net, j % 2 == 0 ? sigma : 1 - sigma, u, x);
    z = mid + net->pitch / 2 * (double)j;
    x[2] = j % 2 == 0 ? z + x[2] : z + net->pitch / 2 - x[2];
}

void pm_pneunet_point(const struct pm_pneunet *net, double tau, double u, double x[3])
{
    double half = (double)net->half;

    lower(net, tau <= half ? tau : 2 * half - tau, u, x);
    if (tau > half)
        x[2] = -x[2];
}

ptrdiff_t pm_pneunet_parts(const struct pm_pneunet *net)
{
    return 2 * net->half;
}

void pm_pneunet_table(const struct pm_pneunet *net, ptrdiff_t fine, double *s, double *r)
{
    double last[AROUND][3] = {{0}}, x[AROUND][3];

    for (ptrdiff_t i = 0; i <= fine * 2 * net->half; i++) {
        double step = 0, around = 0;
        for (int k = 0; k < AROUND; k++) {
            pm_pneunet_point(net, (double)i / (double)fine, (double)k / AROUND, x[k]);
            step += hypot(hypot(x[k][0] - last[k][0], x[k][1] - last[k][1]), x[k][2] - last[k][2]);
        }
        for (int k = 0; k < AROUND; k++) {
            const double *a = x[k], *b = x[(k + 1) % AROUND];
            around += hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        }
        s[i] = i > 0 ? s[i - 1] + step / AROUND : 0;
        r[i] = around / (2 * PI);
        memcpy(last, x, sizeof last);
    }
}

/* Edges along z and corners must leave something of the cells, the gaps and the sides. */
static enum pm_status complete(struct pm_pneunet *net, struct pm_err *err)
{
    if (net->cell / 2 < net->convex || net->concave <= 0 ||
        net->pitch / 2 < net->cell / 2 + net->concave - 1e-9)
        return pm_fail(err, PM_INPUT,
                       "cells of thickness %.3g and pitch %.3g leave no room for edges of radius "
                       "%.3g and gaps of %.3g mm",
                       net->cell, net->pitch, net->convex, net->pitch - net->cell);
    return divide(&net->p, err);
}

/* Corners of [x0, x1] x [-w, w], side 0 at x1. */
static void rectangle(struct pair *q, int level, double x0, double x1, double w, double radius)
{
    const double v[4][2] = {{x1, -w}, {x1, w}, {x0, w}, {x0, -w}};

    q->n = 4;
    memcpy(q->corner[level], v, sizeof v);
    for (int k = 0; k < 4; k++)
        q->radius[level][k] = radius;
}

/* Three limbs [0, x1] x [-w, w] at 120 degrees, side 0 at x1. */
static void trefoil(struct pair *q, int level, double x1, double w, double radius)
{
    q->n = 9;
    for (int k = 0; k < 9; k++) {
        int limb = k / 3;
        double a = 2 * PI / 3 * limb, c = cos(a), s = sin(a);
        double x = k % 3 == 2 ? w / sqrt(3) : x1, y = k % 3 == 0 ? -w : w;
        q->corner[level][k][0] = c * x - s * y;
        q->corner[level][k][1] = s * x + c * y;
        q->radius[level][k] = k % 3 == 2 ? 2 * radius : radius;
    }
}

enum pm_status pm_pneunet_cavity(const struct pm_chamber *c, struct pm_pneunet **out,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_pneunet *net = NULL;
    double in = -c->channel / 2;

    *out = NULL;
    PM_TRY(PM_NEW(net, 1, err));
    *net = (struct pm_pneunet){.closed = 1,
                               .half = 3 + c->cells - 1,
                               .length = c->length,
                               .pitch = c->pitch,
                               .cell = c->thickness,
                               .convex = CAVITY_EDGE,
                               .concave = FILLET};
    rectangle(&net->p, 0, in, -in, -in, CHANNEL_CORNER * c->channel);
    rectangle(&net->p, 1, in - INSET, in - INSET + c->depth, c->width / 2, CAVITY_CORNER);
    PM_TRY(complete(net, err));
    *out = net;
    net = NULL;
done:
    pm_pneunet_free(net);
    return status;
}

enum pm_status pm_pneunet_body(const struct pm_case *c, struct pm_pneunet **out, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_chamber *k = &c->chamber[0];
    struct pm_pneunet *net = NULL;
    double t = c->wall, in = k->center[0] - k->channel / 2;

    *out = NULL;
    PM_TRY(PM_NEW(net, 1, err));
    *net = (struct pm_pneunet){.half = 1 + k->cells - 1,
                               .length = c->height,
                               .pitch = k->pitch,
                               .cell = k->thickness + 2 * t,
                               .convex = BODY_EDGE,
                               .concave = (k->pitch - k->thickness) / 2 - t};
    for (int level = 0; level < 2; level++) {
        double w = (level == 0 ? k->channel : k->width) / 2 + t;
        double radius = level == 0 ? BODY_EDGE : BODY_CORNER;
        double x1 = in + (level == 0 ? k->channel : k->depth - INSET) + t;
        if (c->nchambers == 3)
            trefoil(&net->p, level, x1, w, radius);
        else
            rectangle(&net->p, level, c->nchambers == 1 ? in - INSET - t : -x1, x1, w, radius);
    }
    PM_TRY(complete(net, err));
    *out = net;
    net = NULL;
done:
    pm_pneunet_free(net);
    return status;
}

void pm_pneunet_free(struct pm_pneunet *net)
{
    pm_free(net);
}
