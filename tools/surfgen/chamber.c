#include "tools/surfgen/chamber.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static const double TWO_PI = 6.283185307179586476925;

enum { MAX_POINTS = 20000 };

struct ring {
    ptrdiff_t first, n; /* control points first .. first + n - 1 */
    double s, phase;    /* arc length [mm]; angle of the first point in steps */
};

/* Rings of nearly equilateral triangles; counts follow the lower half, so that the z flip is exact.
 */
static ptrdiff_t plan(const struct pm_chamber *c, const struct pm_profile *p, ptrdiff_t multiple,
                      ptrdiff_t nrings, struct ring *ring)
{
    double length = p->s[p->n - 1], r, z, psi;
    ptrdiff_t n = 1;

    for (ptrdiff_t b = 0; b < nrings; b++) {
        ptrdiff_t lower = b < nrings - 1 - b ? b : nrings - 1 - b;
        pm_profile_at_arc(p, length * (double)(lower + 1) / (double)(nrings + 1), &r, &z, &psi);
        ring[b].s = length * (double)(b + 1) / (double)(nrings + 1);
        ring[b].phase = b % 2 == 0 ? 0 : 0.5;
        ring[b].first = n;
        ring[b].n = (ptrdiff_t)lround(TWO_PI * r / c->spacing / (double)multiple) * multiple;
        ring[b].n = ring[b].n < 6 ? (6 + multiple - 1) / multiple * multiple : ring[b].n;
        n += ring[b].n;
    }
    return n + 1;
}

static void place(const struct pm_chamber *c, const struct pm_profile *p, const struct ring *ring,
                  struct pm_surface *s)
{
    double r, z, psi;

    pm_profile_at_arc(p, ring->s, &r, &z, &psi);
    for (ptrdiff_t a = 0; a < ring->n; a++) {
        double t = TWO_PI * ((double)a + ring->phase) / (double)ring->n;
        double *P = &s->Phi[3 * (ring->first + a)], *x = &s->phi[3 * (ring->first + a)];
        P[0] = cos(t) / cosh(psi);
        P[1] = sin(t) / cosh(psi);
        P[2] = tanh(psi);
        x[0] = c->center[0] + r * cos(t);
        x[1] = c->center[1] + r * sin(t);
        x[2] = c->center[2] + z;
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

static enum pm_status reserve(struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    PM_TRY(PM_NEW(s->phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->free, 3 * s->n, err));
    PM_TRY(PM_NEW(s->Phi, 3 * s->n, err));
    PM_TRY(PM_NEW(s->d0, s->n, err));
    PM_TRY(PM_NEW(s->tri, 6 * s->n, err));
    memset(s->free, 1, 3 * (size_t)s->n);
done:
    return status;
}

enum pm_status pm_chamber_seed(const struct pm_chamber *c, const struct pm_profile *p,
                               ptrdiff_t multiple, struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double row = c->spacing * sqrt(3) / 2, wanted = p->s[p->n - 1] / row;
    struct ring *ring = NULL;
    ptrdiff_t nrings;

    memset(s, 0, sizeof *s);
    if (!(wanted < MAX_POINTS))
        return pm_fail(err, PM_INPUT, "chamber needs more than %d control points at spacing %g",
                       MAX_POINTS, c->spacing);
    nrings = 2 * (ptrdiff_t)fmax(1, round(wanted / 2)) - 1;
    PM_TRY(PM_NEW(ring, nrings, err));
    s->type = PM_SURFACE_SPHERE;
    s->n = plan(c, p, multiple, nrings, ring);
    if (s->n > MAX_POINTS || s->n <= 20)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "chamber has %td control points at spacing %g, expected 21 to %d", s->n,
                       c->spacing, MAX_POINTS));
    PM_TRY(reserve(s, err));
    for (ptrdiff_t pole = 0; pole < 2; pole++) {
        double *x = &s->phi[pole * 3 * (s->n - 1)];
        memcpy(x, c->center, 3 * sizeof *x);
        x[2] += pole ? p->z[p->n - 1] : p->z[0];
        s->Phi[pole * 3 * (s->n - 1) + 2] = pole ? 1 : -1;
    }
    for (ptrdiff_t b = 0; b < nrings; b++)
        place(c, p, &ring[b], s);
    triangulate(s, ring, nrings);
done:
    pm_free(ring);
    return status;
}
