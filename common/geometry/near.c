/* What samples are nearest to, by a tree of the samples of every surface. */
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/cloud.h"
#include "common/geometry/samples.h"

static const double TWO_PI = 6.283185307179586476925;

struct clouds {
    ptrdiff_t ns;
    struct pm_cloud *of[PM_MAX_CHAMBERS + 1]; /* points: samples of the surface from its first */
};

static void clouds_release(struct clouds *c)
{
    for (ptrdiff_t k = 0; k < c->ns; k++)
        pm_cloud_free(c->of[k]);
}

static enum pm_status clouds_init(const struct pm_samples *m, ptrdiff_t ns, const double *x,
                                  const double *normal, struct clouds *c, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    *c = (struct clouds){.ns = ns};
    for (ptrdiff_t k = 0; k < ns; k++) {
        const ptrdiff_t first = m->first[k];
        PM_TRY(pm_cloud_new(m->first[k + 1] - first, &x[3 * first],
                            normal != NULL ? &normal[3 * first] : NULL, &c->of[k], err));
    }
done:
    return status;
}

static double length(const double *metric, double a, double b)
{
    return sqrt(metric[0] * a * a + 2 * metric[1] * a * b + metric[2] * b * b);
}

/* Estimate of the distance along the surface. */
static double along(const struct pm_samples *m, ptrdiff_t i, ptrdiff_t j, int tube)
{
    const double *S = &m->S[3 * i], *R = &m->S[3 * j], *g = &m->metric[3 * i],
                 *h = &m->metric[3 * j];
    double d[3] = {R[0] - S[0], R[1] - S[1], R[2] - S[2]}, chord;

    if (tube) {
        double turn = atan2(R[1], R[0]) - atan2(S[1], S[0]);
        turn -= TWO_PI * round(turn / TWO_PI);
        return (length(g, turn, d[2]) + length(h, turn, d[2])) / 2;
    }
    chord = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return chord * sqrt(sqrt(fmax(g[0] * g[2] - g[1] * g[1], h[0] * h[2] - h[1] * h[1])));
}

/* Surface k looks at itself. */
struct view {
    const struct pm_samples *m;
    double geodesic;
    ptrdiff_t k;
};

static int apart(void *data, int32_t point, int32_t other)
{
    const struct view *v = data;
    const ptrdiff_t first = v->m->first[v->k];

    return point != other && along(v->m, first + point, first + other, v->k == 0) > v->geodesic;
}

/* Answers by way (inside, outside, surfaces: PM_NEAR_INSIDE is the first) and sample (n). */
enum { WAYS = PM_MAX_CHAMBERS + 3 };
struct answers {
    int32_t *found[WAYS]; /* sample of the surface, -1: none */
    double *distance[WAYS];
};

static void answers_release(struct answers *a)
{
    for (int w = 0; w < WAYS; w++) {
        pm_free(a->found[w]);
        pm_free(a->distance[w]);
    }
}

static enum pm_status answers_init(ptrdiff_t n, ptrdiff_t ns, struct answers *a, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (ptrdiff_t w = 0; w < ns - PM_NEAR_INSIDE; w++) {
        PM_TRY(PM_NEW(a->found[w], n, err));
        PM_TRY(PM_NEW(a->distance[w], n, err));
        for (ptrdiff_t i = 0; i < n; i++)
            a->found[w][i] = -1;
    }
done:
    return status;
}

/* What the wanted samples of surface `own` face. */
static void look_around(const struct clouds *c, const struct pm_samples *m,
                        const unsigned char *from, const double cutoff[2], double geodesic,
                        ptrdiff_t own, struct answers *a)
{
    const ptrdiff_t first = m->first[own];
    struct view view = {m, geodesic, own};

    for (ptrdiff_t other = PM_NEAR_INSIDE; other < c->ns; other++) {
        const ptrdiff_t w = other - PM_NEAR_INSIDE;
        const int hollow = other == (own > 0 ? PM_NEAR_INSIDE : PM_NEAR_OUTSIDE);
        struct pm_look look = {.cutoff = cutoff[hollow]};
        if (other < 0) /* within 60 degrees of both normals */
            look = (struct pm_look){.side = other == PM_NEAR_INSIDE ? -1 : 1,
                                    .cosine = 0.5,
                                    .cutoff = cutoff[hollow],
                                    .accept = apart,
                                    .data = &view};
        if (other != own)
            pm_cloud_look(c->of[own], from + first, c->of[other < 0 ? own : other], &look,
                          a->found[w] + first, a->distance[w] + first);
    }
}

enum pm_status pm_samples_near(const struct pm_samples *samples, ptrdiff_t ns, const double *x,
                               const double *normal, const unsigned char *from,
                               const double cutoff[2], double geodesic, struct pm_near **near,
                               ptrdiff_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct clouds c = {0};
    struct answers a = {0};
    ptrdiff_t wanted = 0;

    *near = NULL;
    *n = 0;
    PM_TRY(clouds_init(samples, ns, x, normal, &c, err));
    PM_TRY(answers_init(samples->n, ns, &a, err));
    for (ptrdiff_t k = 0; k < ns; k++)
        look_around(&c, samples, from, cutoff, geodesic, k, &a);
    for (ptrdiff_t i = 0; i < samples->n; i++)
        wanted += from[i] != 0;
    PM_TRY(PM_NEW(*near, wanted * (ns + 1), err));
    for (ptrdiff_t i = 0; i < samples->n; i++)
        for (int32_t other = PM_NEAR_INSIDE; other < ns; other++) {
            const ptrdiff_t w = other - PM_NEAR_INSIDE;
            const ptrdiff_t k = other < 0 ? samples->surface[i] : other;
            if (a.found[w][i] < 0)
                continue;
            const ptrdiff_t j = samples->first[k] + a.found[w][i];
            (*near)[(*n)++] = (struct pm_near){(int32_t)i, (int32_t)j, other, a.distance[w][i],
                                               other < 0 ? along(samples, i, j, k == 0) : HUGE_VAL};
        }
done:
    clouds_release(&c);
    answers_release(&a);
    return status;
}

enum pm_status pm_samples_closest(const struct pm_samples *samples, ptrdiff_t ns, const double *x,
                                  double cutoff, struct pm_pair *pair, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct clouds c = {0};

    PM_TRY(clouds_init(samples, ns, x, NULL, &c, err));
    for (ptrdiff_t k = 0; k < ns * ns; k++) {
        const ptrdiff_t a = k / ns, b = k % ns;
        pair[k] = (struct pm_pair){-1, -1, HUGE_VAL};
        if (a >= b ||
            !pm_cloud_closest(c.of[a], c.of[b], cutoff, &pair[k].i, &pair[k].j, &pair[k].distance))
            continue;
        pair[k].i += (int32_t)samples->first[a];
        pair[k].j += (int32_t)samples->first[b];
    }
done:
    clouds_release(&c);
    return status;
}
