#include "tools/surfgen/profile.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double PI = 3.141592653589793238463;

/* Height of an end cap: bellows end in flat half ellipsoids, which leaves length to the waves. */
static double cap_height(const struct pm_chamber *c)
{
    switch (c->shape) {
    case PM_SHAPE_CAPSULE:
        return c->radius;
    case PM_SHAPE_BELLOWS:
        return 0.6 * c->radius;
    case PM_SHAPE_SPHERE:
        return c->radius;
    default: /* ellipsoid: nothing but caps */
        return c->length / 2;
    }
}

/* Half of the part between the caps. */
static double half_straight(const struct pm_chamber *c)
{
    if (c->shape == PM_SHAPE_SPHERE || c->shape == PM_SHAPE_ELLIPSOID)
        return 0;
    return c->length / 2 - cap_height(c);
}

double pm_profile_half(const struct pm_chamber *c)
{
    return half_straight(c) + cap_height(c);
}

/* Crest in the middle; fades out over half a pitch before the caps (C^2). */
static double wave(const struct pm_chamber *c, double z)
{
    double f;

    if (c->shape != PM_SHAPE_BELLOWS || c->amplitude == 0)
        return 0;
    f = fmin(fmax((half_straight(c) - fabs(z)) / (c->pitch / 2), 0), 1);
    return c->amplitude * cos(2 * PI * z / c->pitch) * f * f * f * (10 - f * (15 - 6 * f));
}

double pm_profile_outer(const struct pm_chamber *c, double z)
{
    return c->radius + wave(c, z);
}

/* u in [0, 1] from the lower pole to the middle: the cap by its angle, then the straight part. */
static void lower_half(const struct pm_chamber *c, double u, double *r, double *z)
{
    double cap = cap_height(c), half = half_straight(c), arc = PI / 4 * (cap + c->radius);
    double split = arc / (arc + half);

    if (u <= split) {
        double a = PI / 2 * u / split;
        *r = u > 0 ? c->radius * sin(a) : 0;
        *z = -half - cap * cos(a);
    } else {
        *z = -half * (1 - u) / (1 - split);
        *r = c->radius + wave(c, *z);
    }
}

/* A quarter of the ellipse of half-axes a, b by arc length; returns its circumference over 2 pi. */
static double quarter_ellipse(double a, double b, double *q)
{
    enum { FINE = 8 * PM_SECTION_PARTS };
    double arc[FINE + 1] = {0};
    ptrdiff_t at = 0;

    for (ptrdiff_t i = 1; i <= FINE; i++) {
        double t = PI / 2 * (double)(i - 1) / FINE, u = PI / 2 * (double)i / FINE;
        arc[i] = arc[i - 1] + hypot(a * (cos(u) - cos(t)), b * (sin(u) - sin(t)));
    }
    for (ptrdiff_t k = 1; k < PM_SECTION_PARTS; k++) {
        double s = arc[FINE] * (double)k / PM_SECTION_PARTS, t;
        while (arc[at + 1] < s)
            at++;
        t = PI / 2 * ((double)at + (s - arc[at]) / (arc[at + 1] - arc[at])) / FINE;
        q[2 * k] = a * cos(t);
        q[2 * k + 1] = b * sin(t);
    }
    q[0] = a;
    q[2 * PM_SECTION_PARTS + 1] = b;
    return 2 * arc[FINE] / PI;
}

static void integrate(struct pm_profile *p)
{
    ptrdiff_t mid = p->n / 2;

    for (ptrdiff_t i = 1; p->net == NULL && i < p->n; i++)
        p->s[i] = p->s[i - 1] + hypot(p->r[i] - p->r[i - 1], p->z[i] - p->z[i - 1]);
    for (ptrdiff_t i = mid + 1; i < p->n; i++) { /* r is linear in s on a segment */
        double a = p->mean * p->r[i - 1], b = p->mean * p->r[i], ds = p->s[i] - p->s[i - 1];
        double middle = fabs(b - a) < 1e-6 * a ? (a + b) / 2 : (b - a) / log(b / a);
        p->psi[i] = b > 0 ? p->psi[i - 1] + ds / middle : HUGE_VAL;
    }
    for (ptrdiff_t i = 0; i < mid; i++)
        p->psi[i] = -p->psi[p->n - 1 - i];
}

static enum pm_status check(const struct pm_chamber *c, struct pm_err *err)
{
    if (half_straight(c) < 0)
        return pm_fail(err, PM_INPUT, "chamber of radius %g has length %g, expected at least %g",
                       c->radius, c->length, 2 * cap_height(c));
    if (c->shape == PM_SHAPE_BELLOWS && !(c->amplitude < c->radius && c->amplitude >= 0))
        return pm_fail(err, PM_INPUT, "bellows of radius %g has amplitude %g, expected 0 to %g",
                       c->radius, c->amplitude, c->radius);
    return PM_OK;
}

enum pm_status pm_profile_new(const struct pm_chamber *c, struct pm_profile *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t half;

    memset(p, 0, sizeof *p);
    PM_TRY(check(c, err));
    if (c->shape == PM_SHAPE_PNEUNET)
        PM_TRY(pm_pneunet_cavity(c, &p->net, err));
    half = p->net != NULL ? PM_NET_FINE * pm_pneunet_parts(p->net) / 2
                          : (ptrdiff_t)fmin(1e5, 1000 + 50 * fmax(c->length, c->radius));
    p->n = 2 * half + 1;
    PM_TRY(PM_NEW(p->r, p->n, err));
    PM_TRY(PM_NEW(p->z, p->n, err));
    PM_TRY(PM_NEW(p->s, p->n, err));
    PM_TRY(PM_NEW(p->psi, p->n, err));
    for (ptrdiff_t i = 0; p->net == NULL && i <= half; i++) {
        ptrdiff_t j = p->n - 1 - i;
        lower_half(c, (double)i / (double)half, &p->r[i], &p->z[i]);
        p->r[j] = p->r[i];
        p->z[j] = -p->z[i];
    }
    if (p->net != NULL)
        pm_pneunet_table(p->net, PM_NET_FINE, p->s, p->r);
    p->r[0] = p->r[p->n - 1] = p->z[half] = 0;
    p->round = c->section[0] == 1 && c->section[1] == 1 && p->net == NULL;
    p->angle = p->round ? 0 : pm_chamber_angle(c, 0);
    p->twist = p->round ? 0 : c->twist / c->length;
    p->mean = quarter_ellipse(c->section[0], c->section[1], p->quarter);
    p->mean = p->round || p->net != NULL ? 1 : p->mean;
    integrate(p);
done:
    if (status != PM_OK)
        pm_profile_release(p);
    return status;
}

void pm_profile_release(struct pm_profile *p)
{
    pm_pneunet_free(p->net);
    pm_free(p->r);
    pm_free(p->z);
    pm_free(p->s);
    pm_free(p->psi);
    memset(p, 0, sizeof *p);
}

/* Segment i of an ascending table with table[i] <= v <= table[i + 1]. */
static ptrdiff_t segment(const double *table, ptrdiff_t n, double v)
{
    ptrdiff_t lo = 0, hi = n - 1;

    while (hi - lo > 1) {
        ptrdiff_t mid = (lo + hi) / 2;
        *(table[mid] <= v ? &lo : &hi) = mid;
    }
    return lo;
}

double pm_profile_at_arc(const struct pm_profile *p, double s, double *r, double *psi)
{
    ptrdiff_t i = segment(p->s, p->n, s);
    double w = (s - p->s[i]) / (p->s[i + 1] - p->s[i]);

    *r = (1 - w) * p->r[i] + w * p->r[i + 1];
    *psi = w <= 0 ? p->psi[i] : w >= 1 ? p->psi[i + 1] : (1 - w) * p->psi[i] + w * p->psi[i + 1];
    return (double)i + w;
}

/* The point of the section of radius 1, by arc length. */
static void section(const struct pm_profile *p, double u, double q[2])
{
    double f = 4 * (u - floor(u));
    ptrdiff_t side = (ptrdiff_t)fmin(f, 3);
    double v = PM_SECTION_PARTS * (side % 2 == 0 ? f - (double)side : (double)side + 1 - f);
    ptrdiff_t k = (ptrdiff_t)fmin(v, PM_SECTION_PARTS - 1);

    for (int j = 0; j < 2; j++)
        q[j] = p->quarter[2 * k + j] +
               (v - (double)k) * (p->quarter[2 * k + 2 + j] - p->quarter[2 * k + j]);
    q[0] = side == 1 || side == 2 ? -q[0] : q[0];
    q[1] = side >= 2 ? -q[1] : q[1];
}

void pm_profile_around(const struct pm_profile *p, double at, double u, double x[3])
{
    ptrdiff_t i = (ptrdiff_t)fmin(at, (double)(p->n - 2));
    double w = at - (double)i, r = (1 - w) * p->r[i] + w * p->r[i + 1], a, q[2];

    x[2] = (1 - w) * p->z[i] + w * p->z[i + 1];
    a = p->angle + p->twist * x[2];
    if (p->round) {
        x[0] = r * cos(2 * PI * u);
        x[1] = r * sin(2 * PI * u);
        return;
    }
    if (p->net != NULL) {
        pm_pneunet_point(p->net, at / PM_NET_FINE, u, x);
        memcpy(q, x, sizeof q);
    } else {
        section(p, u, q);
        q[0] *= r;
        q[1] *= r;
    }
    x[0] = cos(a) * q[0] - sin(a) * q[1];
    x[1] = sin(a) * q[0] + cos(a) * q[1];
}

void pm_profile_point(const struct pm_profile *p, const double S[3], double x[3])
{
    double rho = hypot(S[0], S[1]), psi = rho > 0    ? asinh(S[2] / rho)
                                          : S[2] > 0 ? HUGE_VAL
                                                     : -HUGE_VAL;
    ptrdiff_t i = segment(p->psi, p->n, psi);
    double a = p->psi[i], b = p->psi[i + 1], w;

    if (isfinite(a) && isfinite(b)) {
        w = (psi - a) / (b - a);
    } else { /* a flat disc about a pole: r falls like exp(-|psi|) */
        w = isfinite(b) ? exp(psi - b) : exp(a - psi);
        w = isfinite(b) ? w : 1 - w;
    }
    pm_profile_around(p, (double)i + w, (atan2(S[1], S[0]) - p->angle) / (2 * PI), x);
}
