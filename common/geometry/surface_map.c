#include "common/geometry/surface_map.h"

#include <gsl/gsl_bspline.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/boxes.h"
#include "common/geometry/cloud.h"

static const double TWO_PI = 6.283185307179586476925;

struct pm_map {
    int32_t type;
    ptrdiff_t n, nu, nv;
    const double *Phi, *d0;
    struct pm_cloud *supports;    /* of the sphere map */
    gsl_bspline_workspace *axial; /* clamped cubic, uniform knots on [0, 1] */
    gsl_matrix *dB;               /* (4 x 3) non-zero axial functions and derivatives */
};

static enum pm_status new_axial(struct pm_map *m, struct pm_err *err)
{
    m->axial = gsl_bspline_alloc(4, (size_t)(m->nv - 2));
    m->dB = gsl_matrix_alloc(4, 3);
    if (m->axial == NULL || m->dB == NULL)
        return pm_fail(err, PM_SYSTEM, "out of memory: B-spline of %td rows", m->nv);
    gsl_bspline_knots_uniform(0.0, 1.0, m->axial);
    return PM_OK;
}

enum pm_status pm_map_new(const struct pm_surface *s, struct pm_map **map, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *m = NULL;

    *map = NULL;
    PM_TRY(PM_NEW(m, 1, err));
    m->type = s->type;
    m->n = s->n;
    m->nu = s->nu;
    m->nv = s->nv;
    m->Phi = s->Phi;
    m->d0 = s->d0;
    if (s->type == PM_SURFACE_SPHERE) {
        PM_TRY(pm_cloud_new(m->n, m->Phi, NULL, &m->supports, err));
        PM_TRY(pm_cloud_inflate(m->supports, m->d0, err));
    } else if (s->nu < 4 || s->nv < 4 || s->n != s->nu * s->nv) {
        PM_TRY(pm_fail(err, PM_INPUT,
                       "B-spline has %td = %td x %td control points, expected 4 x 4 or more", s->n,
                       s->nu, s->nv));
    } else {
        PM_TRY(new_axial(m, err));
    }
    *map = m;
    m = NULL;
done:
    pm_map_free(m);
    return status;
}

void pm_map_free(struct pm_map *map)
{
    if (map == NULL)
        return;
    pm_cloud_free(map->supports);
    if (map->axial != NULL)
        gsl_bspline_free(map->axial);
    if (map->dB != NULL)
        gsl_matrix_free(map->dB);
    pm_free(map);
}

void pm_basis_release(struct pm_basis *b)
{
    pm_free(b->id);
    pm_free(b->c);
    pm_free(b->c_a);
    pm_free(b->c_ab);
    memset(b, 0, sizeof *b);
}

static enum pm_status reserve(struct pm_basis *b, ptrdiff_t n, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    b->n = 0;
    if (b->capacity >= n)
        return PM_OK;
    pm_basis_release(b);
    PM_TRY(PM_NEW(b->id, n, err));
    PM_TRY(PM_NEW(b->c, n, err));
    PM_TRY(PM_NEW(b->c_a, 2 * n, err));
    PM_TRY(PM_NEW(b->c_ab, 3 * n, err));
    b->capacity = n;
done:
    return status;
}

static void sphere_tangents(const double S[3], double t[6])
{
    int k = fabs(S[0]) <= fabs(S[1]) ? 0 : 1;
    double e[3] = {0}, len;

    if (fabs(S[2]) < fabs(S[k]))
        k = 2;
    e[k] = 1;
    t[0] = e[1] * S[2] - e[2] * S[1];
    t[1] = e[2] * S[0] - e[0] * S[2];
    t[2] = e[0] * S[1] - e[1] * S[0];
    len = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    for (int j = 0; j < 3; j++)
        t[j] /= len;
    t[3] = S[1] * t[2] - S[2] * t[1];
    t[4] = S[2] * t[0] - S[0] * t[2];
    t[5] = S[0] * t[1] - S[1] * t[0];
}

void pm_map_tangents(int32_t type, const double S[3], double t[6])
{
    if (type == PM_SURFACE_SPHERE) {
        sphere_tangents(S, t);
        return;
    }
    t[0] = -S[1];
    t[1] = S[0];
    t[2] = t[3] = t[4] = 0;
    t[5] = 1;
}

/* C, C_a, C_ab of one kernel in normal coordinates; e.S = s/2 on the unit sphere. */
static void kernel(const double S[3], const double t[6], const double *Phi, double d0, int order,
                   double C[6])
{
    double e[3] = {S[0] - Phi[0], S[1] - Phi[1], S[2] - Phi[2]};
    double s = e[0] * e[0] + e[1] * e[1] + e[2] * e[2], d2 = d0 * d0;
    double q = sqrt(s) / d0, p = 1 - q, q2 = q * q, d1C, d2C, ea[2];

    C[0] = 1 - q2 * q2 * (35 - q * (84 - q * (70 - 20 * q)));
    if (order < 1)
        return;
    ea[0] = e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
    ea[1] = e[0] * t[3] + e[1] * t[4] + e[2] * t[5];
    d1C = -70 * q2 * p * p * p / d2;
    C[1] = 2 * d1C * ea[0];
    C[2] = 2 * d1C * ea[1];
    if (order < 2)
        return;
    d2C = 4 * -35 * p * p * (2 - 5 * q) / (d2 * d2);
    C[3] = d2C * ea[0] * ea[0] + d1C * (2 - s);
    C[4] = d2C * ea[0] * ea[1];
    C[5] = d2C * ea[1] * ea[1] + d1C * (2 - s);
}

/* c = C/Z and its derivatives from those of C, in place. */
static void normalise(struct pm_basis *b, int order, const double Z[6])
{
    for (ptrdiff_t k = 0; k < b->n; k++) {
        double c = b->c[k] /= Z[0], *a = &b->c_a[2 * k], *h = &b->c_ab[3 * k];
        if (order < 1)
            continue;
        a[0] = (a[0] - c * Z[1]) / Z[0];
        a[1] = (a[1] - c * Z[2]) / Z[0];
        if (order < 2)
            continue;
        h[0] = (h[0] - 2 * a[0] * Z[1] - c * Z[3]) / Z[0];
        h[1] = (h[1] - a[0] * Z[2] - a[1] * Z[1] - c * Z[4]) / Z[0];
        h[2] = (h[2] - 2 * a[1] * Z[2] - c * Z[5]) / Z[0];
    }
}

static enum pm_status sphere_basis(const struct pm_map *m, const double S[3], int order,
                                   struct pm_basis *b, struct pm_err *err)
{
    double t[6], Z[6] = {0};

    sphere_tangents(S, t);
    b->n = pm_cloud_covering(m->supports, S, b->id);
    for (ptrdiff_t k = 0; k < b->n; k++) {
        ptrdiff_t i = b->id[k];
        double C[6] = {0};
        kernel(S, t, &m->Phi[3 * i], m->d0[i], order, C);
        b->c[k] = C[0];
        memcpy(&b->c_a[2 * k], C + 1, 2 * sizeof(double));
        memcpy(&b->c_ab[3 * k], C + 3, 3 * sizeof(double));
        for (int j = 0; j < 6; j++)
            Z[j] += C[j];
    }
    if (!(Z[0] > 0))
        return pm_fail(err, PM_NUMERIC, "no control point covers the parameter (%g, %g, %g)", S[0],
                       S[1], S[2]);
    normalise(b, order, Z);
    return PM_OK;
}

/* Uniform periodic cubic: functions id[0..3] and their derivatives to theta. */
static void around(ptrdiff_t nu, const double S[3], ptrdiff_t id[4], double N[3][4])
{
    double scale = (double)nu / TWO_PI, u = atan2(S[1], S[0]) * scale, f = floor(u), w = u - f;
    double p = 1 - w;
    ptrdiff_t first = (ptrdiff_t)f - 1 + 2 * nu;

    for (int k = 0; k < 4; k++)
        id[k] = (first + k) % nu;
    N[0][0] = p * p * p / 6;
    N[0][1] = (4 - w * w * (6 - 3 * w)) / 6;
    N[0][2] = (4 - p * p * (6 - 3 * p)) / 6;
    N[0][3] = w * w * w / 6;
    N[1][0] = -p * p / 2 * scale;
    N[1][1] = w * (1.5 * w - 2) * scale;
    N[1][2] = -p * (1.5 * p - 2) * scale;
    N[1][3] = w * w / 2 * scale;
    N[2][0] = p * scale * scale;
    N[2][1] = (3 * w - 2) * scale * scale;
    N[2][2] = (3 * p - 2) * scale * scale;
    N[2][3] = w * scale * scale;
}

static enum pm_status tube_basis(const struct pm_map *m, const double S[3], int order,
                                 struct pm_basis *b, struct pm_err *err)
{
    double v = fmin(fmax(S[2], 0), 1), N[3][4], M[3][4];
    ptrdiff_t ia[4];
    size_t first, last;

    if (gsl_bspline_deriv_eval_nonzero(v, (size_t)order, m->dB, &first, &last, m->axial) != 0)
        return pm_fail(err, PM_NUMERIC, "cannot evaluate the exterior at v = %g", S[2]);
    for (size_t k = 0; k < 4; k++)
        for (size_t d = 0; d <= (size_t)order; d++)
            M[d][k] = gsl_matrix_get(m->dB, k, d);
    around(m->nu, S, ia, N);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            ptrdiff_t k = b->n++;
            b->id[k] = (int32_t)(ia[i] + m->nu * ((ptrdiff_t)first + j));
            b->c[k] = N[0][i] * M[0][j];
            if (order < 1)
                continue;
            b->c_a[2 * k] = N[1][i] * M[0][j];
            b->c_a[2 * k + 1] = N[0][i] * M[1][j];
            if (order < 2)
                continue;
            b->c_ab[3 * k] = N[2][i] * M[0][j];
            b->c_ab[3 * k + 1] = N[1][i] * M[1][j];
            b->c_ab[3 * k + 2] = N[0][i] * M[2][j];
        }
    return PM_OK;
}

enum pm_status pm_map_basis(const struct pm_map *map, const double S[3], int order,
                            struct pm_basis *b, struct pm_err *err)
{
    enum pm_status status = reserve(b, map->type == PM_SURFACE_SPHERE ? map->n : 16, err);

    if (status != PM_OK)
        return status;
    return map->type == PM_SURFACE_SPHERE ? sphere_basis(map, S, order, b, err)
                                          : tube_basis(map, S, order, b, err);
}

/* sum (6 x 3) of the first `rows` kinds of weights: 1, 3 or 6, a constant where it is inlined. */
static inline void apply(const struct pm_basis *b, const double *phi, int rows, double sum[18])
{
    for (ptrdiff_t k = 0; k < b->n; k++) {
        const double *p = &phi[3 * (ptrdiff_t)b->id[k]];
        double w[6] = {b->c[k]};
        if (rows > 1)
            memcpy(w + 1, &b->c_a[2 * k], 2 * sizeof *w);
        if (rows > 3)
            memcpy(w + 3, &b->c_ab[3 * k], 3 * sizeof *w);
        for (int a = 0; a < rows; a++)
            for (int i = 0; i < 3; i++)
                sum[3 * a + i] += w[a] * p[i];
    }
}

void pm_basis_apply(const struct pm_basis *b, const double *phi, double *r, double *r_a,
                    double *r_ab)
{
    double sum[18] = {0};

    if (r_ab != NULL)
        apply(b, phi, 6, sum);
    else if (r_a != NULL)
        apply(b, phi, 3, sum);
    else
        apply(b, phi, 1, sum);
    if (r != NULL)
        memcpy(r, sum, 3 * sizeof(double));
    if (r_a != NULL)
        memcpy(r_a, sum + 3, 6 * sizeof(double));
    if (r_ab != NULL)
        memcpy(r_ab, sum + 9, 9 * sizeof(double));
}

enum pm_status pm_map_point(const struct pm_map *map, const double *phi, const double S[3],
                            struct pm_basis *work, double *r, double *r_a, double *r_ab,
                            struct pm_err *err)
{
    int order = r_ab != NULL ? 2 : r_a != NULL ? 1 : 0;
    enum pm_status status = pm_map_basis(map, S, order, work, err);

    if (status == PM_OK)
        pm_basis_apply(work, phi, r, r_a, r_ab);
    return status;
}

void pm_map_move(int32_t type, const double S[3], const double d[2], double out[3])
{
    double t[6], len = hypot(d[0], d[1]), c = cos(len), f = len > 0 ? sin(len) / len : 1, sum = 0;

    pm_map_tangents(type, S, t);
    if (type == PM_SURFACE_BSPLINE) {
        double x = cos(d[0]) * S[0] - sin(d[0]) * S[1], y = cos(d[0]) * S[1] + sin(d[0]) * S[0];
        len = hypot(x, y);
        out[0] = x / len;
        out[1] = y / len;
        out[2] = fmin(fmax(S[2] + d[1], 0), 1);
        return;
    }
    for (int j = 0; j < 3; j++) {
        out[j] = c * S[j] + f * (d[0] * t[j] + d[1] * t[3 + j]);
        sum += out[j] * out[j];
    }
    for (int j = 0; j < 3; j++)
        out[j] /= sqrt(sum);
}

void pm_map_middle(int32_t type, const double a[3], const double b[3], double out[3])
{
    double sum = 0;

    for (int j = 0; j < 3; j++)
        out[j] = a[j] + b[j];
    for (int j = 0; j < (type == PM_SURFACE_BSPLINE ? 2 : 3); j++)
        sum += out[j] * out[j];
    for (int j = 0; j < 3; j++)
        out[j] /= sqrt(sum);
    if (type == PM_SURFACE_BSPLINE)
        out[2] = (a[2] + b[2]) / 2;
}

/* The k + 1 least squared distances from x so far, ascending; its own is the first, 0. */
struct ranking {
    const double *Phi, *x;
    double *least;
    ptrdiff_t k;
};

static double rank_point(void *data, int32_t id, double best)
{
    struct ranking *r = data;
    const double *P = &r->Phi[3 * (ptrdiff_t)id];
    const double x = r->x[0] - P[0], y = r->x[1] - P[1], z = r->x[2] - P[2];
    const double s = x * x + y * y + z * z;
    ptrdiff_t at = r->k;

    if (!(s < r->least[at]))
        return best;
    for (; at > 0 && s < r->least[at - 1]; at--)
        r->least[at] = r->least[at - 1];
    r->least[at] = s;
    return sqrt(r->least[r->k]);
}

enum pm_status pm_map_support(ptrdiff_t n, const double *Phi, ptrdiff_t k, double *d0,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *boxes = NULL;
    double *box = NULL, *least = NULL;

    if (n <= k)
        return pm_fail(err, PM_INPUT, "surface has %td control points, expected more than %td", n,
                       k);
    PM_TRY(PM_NEW(box, 6 * n, err));
    PM_TRY(PM_NEW(least, k + 1, err));
    for (ptrdiff_t i = 0; i < 6 * n; i++)
        box[i] = Phi[i / 6 * 3 + i % 3];
    PM_TRY(pm_boxes_new(n, box, NULL, &boxes, err));
    for (ptrdiff_t i = 0; i < n; i++) {
        struct ranking r = {.Phi = Phi, .x = &Phi[3 * i], .least = least, .k = k};
        for (ptrdiff_t j = 0; j <= k; j++)
            least[j] = INFINITY;
        d0[i] = pm_boxes_nearest(boxes, r.x, INFINITY, rank_point, &r);
    }
done:
    pm_boxes_free(boxes);
    pm_free(box);
    pm_free(least);
    return status;
}

enum pm_status pm_map_coverage(const struct pm_map *map, const double S[3], struct pm_basis *work,
                               double *Z, struct pm_err *err)
{
    double t[6] = {0}, C[6];
    enum pm_status status = reserve(work, map->n, err);

    *Z = 0;
    if (status != PM_OK)
        return status;
    work->n = pm_cloud_covering(map->supports, S, work->id);
    for (ptrdiff_t k = 0; k < work->n; k++) {
        kernel(S, t, &map->Phi[3 * (ptrdiff_t)work->id[k]], map->d0[work->id[k]], 0, C);
        *Z += C[0];
    }
    return PM_OK;
}
