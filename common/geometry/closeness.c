#include "common/geometry/closeness.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/skin.h"

/* Weight of closeness in the objective. */
static const double STRENGTH = 0.01;

struct near {
    const struct pm_skin *s;
    double d; /* gap_min [mm] */
    int32_t *id;
    double *gradient; /* of the part at hand (nn x 3), or NULL */
};

/* A ray through air and the triangle that it meets. */
struct ray {
    double from[3], along[3];
    double length, cosine;
    double at[3];     /* barycentric */
    int32_t hit;      /* -1: none */
    double mirror[3]; /* signs of the image that it starts from */
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

/* Edges from the first corner of a triangle, and their product, twice its area times its normal. */
static void frame(const struct pm_skin *s, int32_t t, double a[3], double b[3], double N[3])
{
    const int32_t *v = s->tri + 3 * (ptrdiff_t)t;
    for (int i = 0; i < 3; i++) {
        a[i] = s->y[3 * v[1] + i] - s->y[3 * v[0] + i];
        b[i] = s->y[3 * v[2] + i] - s->y[3 * v[0] + i];
    }
    cross(a, b, N);
}

/* Does the ray meet triangle t sooner? */
static void meet(const struct pm_skin *s, int32_t t, struct ray *r)
{
    double a[3], b[3], N[3], w[3], c[3];
    const double *corner = s->y + 3 * (ptrdiff_t)s->tri[3 * (ptrdiff_t)t];
    frame(s, t, a, b, N);
    const double size = sqrt(dot(N, N)), down = -dot(r->along, N);
    for (int i = 0; i < 3; i++)
        w[i] = corner[i] - r->from[i];
    const double length = -dot(w, N) / down;
    if (!(down > 0 && size > 0 && length > 0 && length < r->length))
        return;
    for (int i = 0; i < 3; i++)
        w[i] = length * r->along[i] - w[i]; /* from the corner */
    cross(w, b, c);
    const double p = dot(c, N) / (size * size);
    cross(a, w, c);
    const double q = dot(c, N) / (size * size);
    if (!(p >= 0 && q >= 0 && p + q <= 1))
        return;
    r->length = length;
    r->cosine = down / size;
    r->at[0] = 1 - p - q;
    r->at[1] = p;
    r->at[2] = q;
    r->hit = t;
}

static void cast(const struct near *c, struct ray *r)
{
    double box[6];
    for (int i = 0; i < 3; i++) {
        const double end = r->from[i] + c->d * r->along[i];
        box[i] = fmin(r->from[i], end);
        box[3 + i] = fmax(r->from[i], end);
    }
    const ptrdiff_t n = pm_boxes_meet(c->s->boxes, box, c->id);
    for (ptrdiff_t k = 0; k < n; k++)
        meet(c->s, c->id[k], r);
}

/* gradient += the derivative of w.N by the corners of triangle t. */
static void spread_normal(const struct near *c, int32_t t, const double w[3])
{
    double a[3], b[3], N[3], da[3], db[3];
    const int32_t *v = c->s->tri + 3 * (ptrdiff_t)t;
    frame(c->s, t, a, b, N);
    cross(b, w, da);
    cross(w, a, db);
    for (int i = 0; i < 3; i++) {
        c->gradient[3 * v[0] + i] -= da[i] + db[i];
        c->gradient[3 * v[1] + i] += da[i];
        c->gradient[3 * v[2] + i] += db[i];
    }
}

/* The term of a ray from triangle t and its derivative. */
static double enter(const struct near *c, int32_t t, const struct ray *r)
{
    const struct pm_skin *s = c->s;
    const double *m = s->facet + 3 * (ptrdiff_t)r->hit, *n = r->along;
    const double x = r->length / c->d, cosine = r->cosine;
    double a[3], b[3], N[3], w[3], from[3];
    frame(s, t, a, b, N);
    const double size = sqrt(dot(N, N)), share = size / (2 * c->d * c->d);
    const double barrier = (1 - x) * (1 - x);
    const double value = share * cosine * cosine * barrier;
    if (c->gradient == NULL)
        return value;
    const double by_length = -2 * share * cosine * cosine * (1 - x) / c->d,
                 by_cosine = 2 * share * cosine * barrier;
    const int32_t *v = s->tri + 3 * (ptrdiff_t)t, *h = s->tri + 3 * (ptrdiff_t)r->hit;
    for (int i = 0; i < 3; i++) {
        from[i] = r->mirror[i] * by_length * m[i] / cosine;
        w[i] = by_length * r->length * m[i] / cosine - by_cosine * m[i];
        for (int k = 0; k < 3; k++) {
            c->gradient[3 * v[k] + i] += from[i] / 3;
            c->gradient[3 * h[k] + i] -= by_length * r->at[k] * m[i] / cosine;
        }
    }
    /* dn = (1 - n n') dN / |N| of the image; d|N| = n.dN */
    const double along = dot(w, n);
    for (int i = 0; i < 3; i++)
        w[i] = r->mirror[i] * ((w[i] - along * n[i]) / size + value / size * n[i]);
    spread_normal(c, t, w);
    double M[3];
    frame(s, r->hit, a, b, M);
    const double other = sqrt(dot(M, M));
    for (int i = 0; i < 3; i++)
        w[i] = -by_cosine * (n[i] + cosine * m[i]) / other;
    spread_normal(c, r->hit, w);
    return value;
}

/* The nearer of what the ray of triangle t and its images across the planes meet. */
static struct ray look_from(const struct near *c, int32_t t)
{
    const struct pm_skin *s = c->s;
    struct ray best = {.hit = -1, .length = c->d};
    for (unsigned image = 0; image < 1U << s->nplanes; image++) {
        struct ray r = {.hit = -1, .length = best.length, .mirror = {1, 1, 1}};
        for (int i = 0; i < 3; i++) {
            r.along[i] = s->facet[3 * (ptrdiff_t)t + i];
            for (int k = 0; k < 3; k++)
                r.from[i] += s->y[3 * s->tri[3 * (ptrdiff_t)t + k] + i] / 3;
        }
        double away = 0;
        for (int k = 0; k < s->nplanes; k++) {
            const struct pm_skin_plane *p = &s->plane[k];
            if (!(image >> k & 1U))
                continue;
            away = fmax(away, fabs(r.from[p->axis] - p->at));
            r.from[p->axis] = 2 * p->at - r.from[p->axis];
            r.along[p->axis] = -r.along[p->axis];
            r.mirror[p->axis] = -1;
        }
        if (away < c->d)
            cast(c, &r);
        if (r.hit >= 0)
            best = r;
    }
    return best;
}

/* Rays that meet something, with the triangle that each comes from. */
struct hits {
    ptrdiff_t n;
    int32_t *from;       /* (nt) */
    struct ray *ray;     /* (nt) */
    int32_t *root;       /* of the nodes: a tree for each region (nn) */
    double *region;      /* sums of the terms at the roots (nn) */
    unsigned char *part; /* of the roots (nn) */
};

static int32_t find(int32_t *root, int32_t a)
{
    while (root[a] != a)
        a = root[a] = root[root[a]];
    return a;
}

static void unite(const struct pm_skin *s, int32_t *root, int32_t t, int32_t hit)
{
    const int32_t first = s->tri[3 * (ptrdiff_t)t];
    for (int k = 0; k < 3; k++) {
        root[find(root, s->tri[3 * (ptrdiff_t)t + k])] = find(root, first);
        root[find(root, s->tri[3 * (ptrdiff_t)hit + k])] = find(root, first);
    }
}

static int32_t region_of(const struct pm_skin *s, const struct hits *h, ptrdiff_t k)
{
    return find(h->root, s->tri[3 * (ptrdiff_t)h->from[k]]);
}

static enum pm_status look(struct near *c, struct hits *h, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_skin *s = c->s;
    const ptrdiff_t nn = s->m->nn;
    PM_TRY(PM_NEW(h->from, s->nt, err));
    PM_TRY(PM_NEW(h->ray, s->nt, err));
    PM_TRY(PM_NEW(h->root, nn, err));
    PM_TRY(PM_NEW(h->region, nn, err));
    PM_TRY(PM_NEW(h->part, nn, err));
    for (ptrdiff_t a = 0; a < nn; a++)
        h->root[a] = (int32_t)a;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        const struct ray r = look_from(c, (int32_t)t);
        if (r.hit < 0)
            continue;
        h->from[h->n] = (int32_t)t;
        h->ray[h->n++] = r;
        unite(s, h->root, (int32_t)t, r.hit);
    }
done:
    return status;
}

/* Numbers the regions: the largest first, all beyond the parts in the last one; G of them. */
static void number(const struct near *c, struct hits *h, double G[PM_CLOSENESS_PARTS])
{
    for (ptrdiff_t k = 0; k < h->n; k++)
        h->region[region_of(c->s, h, k)] += enter(c, h->from[k], &h->ray[k]);
    for (ptrdiff_t a = 0; a < c->s->m->nn; a++)
        h->part[a] = PM_CLOSENESS_PARTS - 1;
    for (int p = 0; p < PM_CLOSENESS_PARTS - 1; p++) {
        ptrdiff_t most = 0;
        for (ptrdiff_t a = 1; a < c->s->m->nn; a++)
            most = h->region[a] > h->region[most] ? a : most;
        h->part[most] = h->region[most] > 0 ? (unsigned char)p : h->part[most];
        G[p] = h->region[most];
        h->region[most] = 0;
    }
    G[PM_CLOSENESS_PARTS - 1] = 0;
    for (ptrdiff_t a = 0; a < c->s->m->nn; a++)
        G[PM_CLOSENESS_PARTS - 1] += h->region[a];
}

enum pm_status pm_closeness_of(const struct pm_skin *s, double G[PM_CLOSENESS_PARTS], double *dG_dx,
                               struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct near c = {.s = s, .d = s->m->pcase.gap_min};
    struct hits h = {.n = 0};
    const ptrdiff_t size = 3 * s->m->nn;
    const double copies = (double)(1U << s->nplanes);

    memset(G, 0, PM_CLOSENESS_PARTS * sizeof *G);
    if (dG_dx != NULL)
        memset(dG_dx, 0, PM_CLOSENESS_PARTS * (size_t)size * sizeof *dG_dx);
    if (!(c.d > 0))
        return PM_OK;
    PM_TRY(PM_NEW(c.id, s->nt, err));
    PM_TRY(look(&c, &h, err));
    number(&c, &h, G);
    for (int p = 0; p < PM_CLOSENESS_PARTS; p++)
        G[p] *= copies;
    for (ptrdiff_t k = 0; k < h.n && dG_dx != NULL; k++) {
        c.gradient = dG_dx + size * h.part[region_of(s, &h, k)];
        enter(&c, h.from[k], &h.ray[k]);
    }
    for (ptrdiff_t i = 0; i < PM_CLOSENESS_PARTS * size && dG_dx != NULL; i++)
        dG_dx[i] *= copies;
done:
    pm_free(c.id);
    pm_free(h.from);
    pm_free(h.ray);
    pm_free(h.root);
    pm_free(h.region);
    pm_free(h.part);
    return status;
}

enum pm_status pm_closeness(const struct pm_mesh *m, const double *u, double G[PM_CLOSENESS_PARTS],
                            double *dG_dx, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_skin s = {.m = m};

    if (m->pcase.gap_min > 0)
        PM_TRY(pm_skin_new(m, u, &s, err));
    PM_TRY(pm_closeness_of(&s, G, dG_dx, err));
done:
    pm_skin_release(&s);
    return status;
}

double pm_closeness_sum(const double G[PM_CLOSENESS_PARTS])
{
    double sum = 0;
    for (int p = 0; p < PM_CLOSENESS_PARTS; p++)
        sum += G[p];
    return sum;
}

double pm_closeness_factor(double sum)
{
    return exp(-STRENGTH * sum);
}

double pm_closeness_slope(int multiplicity)
{
    return -STRENGTH * multiplicity;
}
