#include "tools/surfgen/chamber.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double TWO_PI = 6.283185307179586476925;

enum { MAX_POINTS = 20000, FINEST = 8 };

static const double GRADING = 0.3; /* growth of the spacing [1] */
static const double ALONG = 1.25;  /* largest spacing along over radius of curvature [1] */

struct ring {
    ptrdiff_t first, n; /* control points first .. first + n - 1 */
    double s, phase;    /* arc length [mm]; angle of the first point in steps */
};

/* Spacing of control points along the meridian, and the number of spacings from the lower pole. */
struct density {
    double *h;     /* (n) [mm] */
    double *count; /* (n) [1] */
};

/* Radius of the circle through three points of the meridian. */
static double circle(const struct pm_profile *p, ptrdiff_t i, ptrdiff_t step)
{
    ptrdiff_t a = i - step, b = i + step;
    double s = a < 0 ? -1 : 1; /* beyond a pole the meridian is its own mirror image */
    double x[3] = {s * p->r[a < 0 ? -a : a], p->r[i], p->r[b]};
    double z[3] = {p->z[a < 0 ? -a : a], p->z[i], p->z[b]};
    double u = hypot(x[1] - x[0], z[1] - z[0]), v = hypot(x[2] - x[1], z[2] - z[1]);
    double w = hypot(x[2] - x[0], z[2] - z[0]);
    double area = fabs((x[1] - x[0]) * (z[2] - z[0]) - (x[2] - x[0]) * (z[1] - z[0]));

    return area > 1e-12 * u * v ? u * v * w / (2 * area) : HUGE_VAL;
}

/* What the radii of curvature along and around allow: around, 14 points to the circle. */
static double bend(const struct pm_profile *p, ptrdiff_t i)
{
    ptrdiff_t j = i > 0 ? i : 1;
    double slope = fabs(p->z[j + 1] - p->z[j - 1]) / (p->s[j + 1] - p->s[j - 1]);

    if (p->net != NULL) /* of edges the case knows; the first two parts end in the pole */
        return i < 2 * PM_NET_FINE ? HUGE_VAL : TWO_PI / 14 * p->r[i];
    return fmin(ALONG * circle(p, i, 4), slope > 0 ? TWO_PI / 14 * p->r[j] / slope : HUGE_VAL);
}

/* The wanted spacing where the curvature allows it, grading by GRADING. The
 * lower half decides. */
static enum pm_status density_new(const struct pm_chamber *c, const struct pm_profile *p,
                                  struct density *d, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t mid = p->n / 2;

    PM_TRY(PM_NEW(d->h, p->n, err));
    PM_TRY(PM_NEW(d->count, p->n, err));
    for (ptrdiff_t i = 0; i <= mid; i++)
        d->h[i] = fmin(c->spacing, fmax(c->spacing / FINEST, bend(p, i)));
    for (ptrdiff_t i = 1; i <= mid; i++)
        d->h[i] = fmin(d->h[i], d->h[i - 1] + GRADING * (p->s[i] - p->s[i - 1]));
    for (ptrdiff_t i = mid; i > 0; i--)
        d->h[i - 1] = fmin(d->h[i - 1], d->h[i] + GRADING * (p->s[i] - p->s[i - 1]));
    for (ptrdiff_t i = 0; i < mid; i++)
        d->h[p->n - 1 - i] = d->h[i];
    for (ptrdiff_t i = 1; i < p->n; i++)
        d->count[i] = d->count[i - 1] + 2 * (p->s[i] - p->s[i - 1]) / (d->h[i] + d->h[i - 1]);
done:
    return status;
}

static void density_release(struct density *d)
{
    pm_free(d->h);
    pm_free(d->count);
}

/* Arc length and spacing where the count is `wanted`. */
static double at_count(const struct pm_profile *p, const struct density *d, double wanted,
                       double *h)
{
    ptrdiff_t lo = 0, hi = p->n - 1;
    double w;

    while (hi - lo > 1) {
        ptrdiff_t mid = (lo + hi) / 2;
        *(d->count[mid] <= wanted ? &lo : &hi) = mid;
    }
    w = (wanted - d->count[lo]) / (d->count[hi] - d->count[lo]);
    *h = (1 - w) * d->h[lo] + w * d->h[hi];
    return (1 - w) * p->s[lo] + w * p->s[hi];
}

/* Rings of nearly equilateral triangles; all follows the lower half, so that the z flip is exact.
 */
static ptrdiff_t plan(const struct pm_profile *p, const struct density *d, ptrdiff_t multiple,
                      ptrdiff_t nrings, struct ring *ring)
{
    double length = p->s[p->n - 1], total = d->count[p->n - 1], r, psi, h;
    ptrdiff_t n = 1;

    for (ptrdiff_t b = 0; b < nrings; b++) {
        ptrdiff_t lower = b < nrings - 1 - b ? b : nrings - 1 - b;
        double s = at_count(p, d, total * (double)(lower + 1) / (double)(nrings + 1), &h);
        s = 2 * lower + 1 == nrings ? length / 2 : s;
        pm_profile_at_arc(p, s, &r, &psi);
        ring[b].s = b == lower ? s : length - s;
        ring[b].phase = b % 2 == 0 ? 0 : 0.5;
        ring[b].first = n;
        ring[b].n = (ptrdiff_t)lround(TWO_PI * p->mean * r / h / (double)multiple) * multiple;
        ring[b].n = ring[b].n < 6 ? (6 + multiple - 1) / multiple * multiple : ring[b].n;
        n += ring[b].n;
    }
    return n + 1;
}

static void place(const struct pm_chamber *c, const struct pm_profile *p, const struct ring *ring,
                  struct pm_surface *s)
{
    double r, psi, at = pm_profile_at_arc(p, ring->s, &r, &psi);

    for (ptrdiff_t a = 0; a < ring->n; a++) {
        double t = TWO_PI * ((double)a + ring->phase) / (double)ring->n;
        double *P = &s->Phi[3 * (ring->first + a)], *x = &s->phi[3 * (ring->first + a)];
        P[0] = cos(p->angle + t) / cosh(psi);
        P[1] = sin(p->angle + t) / cosh(psi);
        P[2] = tanh(psi);
        pm_profile_around(p, at, t / TWO_PI, x);
        for (int j = 0; j < 3; j++)
            x[j] += c->center[j];
    }
}

static void triangle(struct pm_surface *s, ptrdiff_t a, ptrdiff_t b, ptrdiff_t c)
{
    int32_t *t = &s->tri[3 * s->nt++];

    t[0] = (int32_t)a;
    t[1] = (int32_t)b;
    t[2] = (int32_t)c;
}

/* The band between two rings: the next triangle takes the nearer next point. */
static void stitch(struct pm_surface *s, const struct ring *low, const struct ring *high)
{
    ptrdiff_t i = 0, j = 0;

    while (i < low->n || j < high->n) {
        double u = ((double)i + 1 + low->phase) / (double)low->n;
        double v = ((double)j + 1 + high->phase) / (double)high->n;
        ptrdiff_t a = low->first + i % low->n, b = high->first + j % high->n;
        if (j == high->n || (i < low->n && u <= v))
            triangle(s, a, low->first + ++i % low->n, b);
        else
            triangle(s, a, high->first + ++j % high->n, b);
    }
}

static void triangulate(struct pm_surface *s, const struct ring *ring, ptrdiff_t nrings)
{
    const struct ring *last = &ring[nrings - 1];

    for (ptrdiff_t a = 0; a < ring->n; a++)
        triangle(s, 0, ring->first + (a + 1) % ring->n, ring->first + a);
    for (ptrdiff_t b = 0; b + 1 < nrings; b++)
        stitch(s, &ring[b], &ring[b + 1]);
    for (ptrdiff_t a = 0; a < last->n; a++)
        triangle(s, last->first + a, last->first + (a + 1) % last->n, s->n - 1);
}

enum pm_status pm_chamber_seed(const struct pm_chamber *c, const struct pm_profile *p,
                               ptrdiff_t multiple, struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct density d = {0};
    struct ring *ring = NULL;
    ptrdiff_t nrings, n;
    double wanted;

    memset(s, 0, sizeof *s);
    PM_TRY(density_new(c, p, &d, err));
    wanted = d.count[p->n - 1] * 2 / sqrt(3);
    if (!(wanted < MAX_POINTS))
        PM_TRY(pm_fail(err, PM_INPUT, "chamber needs more than %d control points at spacing %g",
                       MAX_POINTS, c->spacing));
    nrings = 2 * (ptrdiff_t)fmax(1, round(wanted / 2)) - 1;
    PM_TRY(PM_NEW(ring, nrings, err));
    n = plan(p, &d, multiple, nrings, ring);
    if (n > MAX_POINTS || n <= 20)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "chamber has %td control points at spacing %g, expected 21 to %d", n,
                       c->spacing, MAX_POINTS));
    PM_TRY(pm_surface_new(PM_SURFACE_SPHERE, n, 2 * n - 4, s, err));
    s->nt = 0; /* as they come */
    for (ptrdiff_t pole = 0; pole < 2; pole++) {
        double *x = &s->phi[pole * 3 * (s->n - 1)];
        pm_profile_around(p, pole ? (double)(p->n - 1) : 0, 0, x);
        for (int j = 0; j < 3; j++)
            x[j] += c->center[j];
        s->Phi[pole * 3 * (s->n - 1) + 2] = pole ? 1 : -1;
    }
    for (ptrdiff_t b = 0; b < nrings; b++)
        place(c, p, &ring[b], s);
    triangulate(s, ring, nrings);
done:
    density_release(&d);
    pm_free(ring);
    return status;
}
