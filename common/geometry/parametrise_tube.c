#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/surfaces.h"
#include "common/geometry/annulus.h"
#include "common/geometry/parametrise.h"
#include "common/geometry/parametrise_parts.h"
#include "common/geometry/remesh.h"

static const double TWO_PI = 6.283185307179586476925;

enum { LEVELS = 100 };

struct tube {
    const struct pm_trimesh *m;
    struct pm_star star;
    int32_t *rim[2];
    ptrdiff_t nrim[2];
    double *psi, *theta;
};

static void release(struct tube *t)
{
    pm_star_release(&t->star);
    pm_free(t->rim[0]);
    pm_free(t->rim[1]);
    pm_free(t->psi);
    pm_free(t->theta);
}

/* The boundary that begins at node a, as its triangles run along it. */
static enum pm_status follow(const struct tube *t, const int32_t *onward, int32_t a, int32_t **rim,
                             ptrdiff_t *n, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t b = a;

    PM_TRY(PM_NEW(*rim, t->m->nn, err));
    *n = 0;
    do {
        (*rim)[(*n)++] = b;
        b = onward[b];
    } while (b != a);
done:
    return status;
}

static double mean_height(const struct pm_trimesh *m, const int32_t *rim, ptrdiff_t n)
{
    double sum = 0;

    for (ptrdiff_t k = 0; k < n; k++)
        sum += m->x[3 * (ptrdiff_t)rim[k] + 2];
    return sum / (double)n;
}

/* Both rims, lower first; with the triangles on the left, theta rises along the lower one and falls
 * along the upper. */
static enum pm_status find_rims(struct tube *t, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_trimesh *m = t->m;
    int32_t *onward = NULL;

    PM_TRY(PM_NEW(onward, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        onward[a] = -1;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (ptrdiff_t k = t->star.ptr[a]; k < t->star.ptr[a + 1]; k++)
            if (pm_star_after(&t->star, t->star.next[k], a) < 0)
                onward[a] = t->star.next[k];
    for (ptrdiff_t a = 0, side = 0; a < m->nn && side < 2; a++) {
        int seen = onward[a] < 0;
        for (ptrdiff_t k = 0; k < t->nrim[0] && !seen; k++)
            seen = t->rim[0][k] == a;
        if (!seen) {
            PM_TRY(follow(t, onward, (int32_t)a, &t->rim[side], &t->nrim[side], err));
            side++;
        }
    }
    if (mean_height(m, t->rim[0], t->nrim[0]) > mean_height(m, t->rim[1], t->nrim[1])) {
        int32_t *rim = t->rim[0];
        ptrdiff_t n = t->nrim[0];
        t->rim[0] = t->rim[1];
        t->rim[1] = rim;
        t->nrim[0] = t->nrim[1];
        t->nrim[1] = n;
    }
    for (ptrdiff_t k = 0; 2 * k + 1 < t->nrim[1]; k++) {
        int32_t a = t->rim[1][k], *b = &t->rim[1][t->nrim[1] - 1 - k];
        t->rim[1][k] = *b;
        *b = a;
    }
done:
    pm_free(onward);
    return status;
}

/* |r_psi| of a triangle, its area in (theta, psi) and its range of psi. */
static double stretch(const struct tube *t, ptrdiff_t k, double *area, double range[2])
{
    const int32_t *v = &t->m->tri[3 * k];
    const double *x = t->m->x;
    double d[2][2], r[3], det;

    for (int j = 0; j < 2; j++) {
        d[j][0] = t->theta[v[j + 1]] - t->theta[v[0]];
        d[j][0] -= TWO_PI * round(d[j][0] / TWO_PI);
        d[j][1] = t->psi[v[j + 1]] - t->psi[v[0]];
    }
    det = d[0][0] * d[1][1] - d[1][0] * d[0][1];
    for (int i = 0; i < 3; i++)
        r[i] = (d[0][0] * (x[3 * (ptrdiff_t)v[2] + i] - x[3 * (ptrdiff_t)v[0] + i]) -
                d[1][0] * (x[3 * (ptrdiff_t)v[1] + i] - x[3 * (ptrdiff_t)v[0] + i])) /
               det;
    *area = fabs(det) / 2;
    range[0] = fmin(t->psi[v[0]], fmin(t->psi[v[1]], t->psi[v[2]]));
    range[1] = fmax(t->psi[v[0]], fmax(t->psi[v[1]], t->psi[v[2]]));
    return *area > 0 ? sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) : 0;
}

/* psi becomes v: levels of v are evenly spaced on the surface, on the mean around it. */
static void spread(struct tube *t, double modulus)
{
    double sum[LEVELS] = {0}, weight[LEVELS] = {0}, v[LEVELS + 1] = {0};

    for (ptrdiff_t k = 0; k < t->m->nt; k++) {
        double area, range[2], s = stretch(t, k, &area, range);
        int lo = (int)fmin(LEVELS - 1, LEVELS * range[0] / modulus);
        int hi = (int)fmin(LEVELS - 1, LEVELS * range[1] / modulus);
        for (int l = lo; l <= hi; l++) {
            sum[l] += s * area / (hi - lo + 1);
            weight[l] += area / (hi - lo + 1);
        }
    }
    for (int l = 0; l < LEVELS; l++)
        v[l + 1] = v[l] + (weight[l] > 0 ? sum[l] / weight[l] : 0);
    for (ptrdiff_t a = 0; a < t->m->nn; a++) {
        double at = LEVELS * fmin(fmax(t->psi[a] / modulus, 0), 1);
        int l = (int)fmin(LEVELS - 1, at);
        t->psi[a] = (v[l] + (at - l) * (v[l + 1] - v[l])) / v[LEVELS];
    }
    for (int side = 0; side < 2; side++)
        for (ptrdiff_t k = 0; k < t->nrim[side]; k++)
            t->psi[t->rim[side][k]] = side;
}

static enum pm_status symmetrise(const struct pm_trimesh *m, const int *mirror, double *S,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *image = NULL;
    double low[3], high[3];

    PM_TRY(PM_NEW(image, m->nn, err));
    pm_trimesh_box(m, low, high);
    for (int j = 0; j < 2; j++)
        if (mirror[j]) {
            PM_TRY(pm_trimesh_mirror(m, j, (low[j] + high[j]) / 2, 1e-7 * (high[2] - low[2]), image,
                                     err));
            PM_TRY(pm_symmetrise_map(m, j, image, S, err));
        }
done:
    pm_free(image);
    return status;
}

enum pm_status pm_parametrise_tube(const struct pm_trimesh *m, const int *mirror, double *S,
                                   struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct tube t = {.m = m};
    double modulus;

    PM_TRY(pm_star_new(m, &t.star, err));
    PM_TRY(pm_trimesh_check(m, &t.star, 2, err));
    PM_TRY(find_rims(&t, err));
    PM_TRY(PM_NEW(t.psi, m->nn, err));
    PM_TRY(PM_NEW(t.theta, m->nn, err));
    const struct pm_annulus annulus = {
        .mesh = m, .star = &t.star, .rim = {t.rim[0], t.rim[1]}, .nrim = {t.nrim[0], t.nrim[1]}};
    PM_TRY(pm_annulus_map(&annulus, t.psi, t.theta, &modulus, err));
    pm_turn_theta(m, NULL, t.theta);
    spread(&t, modulus);
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        S[3 * a] = cos(t.theta[a]);
        S[3 * a + 1] = sin(t.theta[a]);
        S[3 * a + 2] = t.psi[a];
    }
    if (mirror != NULL)
        PM_TRY(symmetrise(m, mirror, S, err));
done:
    release(&t);
    return status;
}
