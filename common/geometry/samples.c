#include "common/geometry/samples.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"

static const double TWO_PI = 6.283185307179586476925;
/* Edges that span less than this angle, up to so many cuts, keep the curvature between samples
 * within a few per cent of that at them. */
static const double BEND = 0.5, MOST_CUTS = 10;

struct wish {
    double spacing;
    ptrdiff_t cuts;
    int nodes;
};

/* One triangle of control points: corner parameters, unwrapped (theta, v, 0) on the tube. */
struct patch {
    int32_t type;
    double p[3][3];
    ptrdiff_t cuts;
};

static void patch_init(const struct pm_surface *s, const double *Phi, ptrdiff_t t, struct patch *p)
{
    p->type = s->type;
    for (int k = 0; k < 3; k++) {
        const double *S = &Phi[3 * (ptrdiff_t)s->tri[3 * t + k]];
        memcpy(p->p[k], S, sizeof p->p[k]);
        if (s->type == PM_SURFACE_SPHERE)
            continue;
        p->p[k][0] = atan2(S[1], S[0]);
        p->p[k][1] = S[2];
        p->p[k][2] = 0;
        if (k > 0)
            p->p[k][0] -= TWO_PI * round((p->p[k][0] - p->p[0][0]) / TWO_PI);
    }
}

static void blend(const struct patch *p, double a, double b, double c, double out[3])
{
    double len;

    for (int j = 0; j < 3; j++)
        out[j] = a * p->p[0][j] + b * p->p[1][j] + c * p->p[2][j];
    if (p->type != PM_SURFACE_SPHERE)
        return;
    len = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int j = 0; j < 3; j++)
        out[j] /= len;
}

/* Area of the parameter triangle: flat on the tube, solid angle (Van Oosterom and Strackee, by
 * differences) on the sphere. */
static double parameter_area(int32_t type, double x[3][3])
{
    double u[3], v[3], c[3], det = 0, sum = 1;

    for (int j = 0; j < 3; j++) {
        u[j] = x[1][j] - x[0][j];
        v[j] = x[2][j] - x[0][j];
        sum += x[0][j] * x[1][j] + x[1][j] * x[2][j] + x[2][j] * x[0][j];
    }
    c[0] = u[1] * v[2] - u[2] * v[1];
    c[1] = u[2] * v[0] - u[0] * v[2];
    c[2] = u[0] * v[1] - u[1] * v[0];
    if (type != PM_SURFACE_SPHERE)
        return fabs(c[2]) / 2;
    for (int j = 0; j < 3; j++)
        det += x[0][j] * c[j];
    return 2 * atan2(fabs(det), sum);
}

/* Part q of cuts^2, upright and inverted triangles by turns, row after row: its middle and area. */
static void part(const struct patch *p, ptrdiff_t q, double S[3], double *area)
{
    static const int at[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 0}, {1, 1}, {0, 1}}};
    double m = (double)p->cuts, corner[3][3], sum[2] = {0};
    ptrdiff_t row = 0, column;

    while (q >= 2 * (p->cuts - row) - 1)
        q -= 2 * (p->cuts - row++) - 1;
    column = q / 2;
    for (int k = 0; k < 3; k++) {
        double b = (double)(column + at[q % 2][k][0]) / m, c = (double)(row + at[q % 2][k][1]) / m;
        blend(p, 1 - b - c, b, c, corner[k]);
        sum[0] += b / 3;
        sum[1] += c / 3;
    }
    *area = parameter_area(p->type, corner);
    blend(p, 1 - sum[0] - sum[1], sum[0], sum[1], S);
    if (p->type == PM_SURFACE_BSPLINE) {
        double theta = S[0];
        S[2] = S[1];
        S[0] = cos(theta);
        S[1] = sin(theta);
    }
}

static enum pm_status bend_at(const struct pm_surface *s, const struct pm_map *map,
                              const double S[3], struct pm_basis *b, double *bend,
                              struct pm_err *err)
{
    struct pm_curvature c;
    double r_a[6], r_ab[9];
    const enum pm_status status = pm_map_point(map, s->phi, S, b, NULL, r_a, r_ab, err);

    if (status != PM_OK)
        return status;
    pm_curvature_at(r_a, r_ab, &c);
    *bend = sqrt(fmax(c.Q, 0));
    return PM_OK;
}

/* Cuts of triangle t whose corners lie at x (n x 3) with curvatures bend (n) unless NULL: longest
 * edge <= spacing and, where curvatures are wanted, <= BEND over the largest at corners and middle.
 */
static enum pm_status cuts_of(const struct pm_surface *s, const struct pm_map *map, ptrdiff_t t,
                              const double *x, const double *bend, const struct wish *wish,
                              struct pm_basis *b, ptrdiff_t *cuts, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const int32_t *tri = &s->tri[3 * t];
    struct patch p;
    double longest = 0, most = 0, middle[3], area;

    for (int k = 0; k < 3; k++) {
        const double *a = &x[3 * (ptrdiff_t)tri[k]], *c = &x[3 * (ptrdiff_t)tri[(k + 1) % 3]];
        longest = fmax(longest, hypot(hypot(a[0] - c[0], a[1] - c[1]), a[2] - c[2]));
    }
    if (bend != NULL) {
        patch_init(s, s->Phi, t, &p);
        p.cuts = 1;
        part(&p, 0, middle, &area);
        PM_TRY(bend_at(s, map, middle, b, &most, err));
        for (int k = 0; k < 3; k++)
            most = fmax(most, bend[tri[k]]);
    }
    const double wanted = fmax(longest / wish->spacing, fmin(longest * most / BEND, MOST_CUTS));
    *cuts = (ptrdiff_t)fmax((double)wish->cuts, ceil(wanted - 1e-9));
done:
    return status;
}

/* Cuts of all triangles of surface k, into cuts (nt); adds its samples to *n. */
static enum pm_status plan(const struct pm_surface *s, const struct pm_map *map,
                           const struct wish *wish, ptrdiff_t *cuts, ptrdiff_t *n,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_basis b = {0};
    double *x = NULL, *bend = NULL;

    PM_TRY(PM_NEW(x, 3 * s->n, err));
    if (wish->nodes)
        PM_TRY(PM_NEW(bend, s->n, err));
    for (ptrdiff_t i = 0; i < s->n; i++) {
        PM_TRY(pm_map_point(map, s->phi, &s->Phi[3 * i], &b, &x[3 * i], NULL, NULL, err));
        if (bend != NULL)
            PM_TRY(bend_at(s, map, &s->Phi[3 * i], &b, &bend[i], err));
    }
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        PM_TRY(cuts_of(s, map, t, x, bend, wish, &b, &cuts[t], err));
        *n += cuts[t] * cuts[t];
    }
    *n += wish->nodes ? s->n : 0;
done:
    pm_basis_release(&b);
    pm_free(x);
    pm_free(bend);
    return status;
}

static enum pm_status add_row(struct pm_samples *m, ptrdiff_t i, const struct pm_basis *b,
                              ptrdiff_t offset, ptrdiff_t *capacity, struct pm_err *err)
{
    ptrdiff_t first = m->ptr[i];

    if (m->col == NULL || first + b->n > *capacity) {
        ptrdiff_t more = first + (m->n - i + 64) * b->n; /* as if the others were like it */
        void *col = pm_realloc(m->col, more, sizeof *m->col, err), *c, *c_a, *c_ab;
        m->col = col != NULL ? col : m->col;
        c = pm_realloc(m->c, more, sizeof *m->c, err);
        m->c = c != NULL ? c : m->c;
        c_a = pm_realloc(m->c_a, 2 * more, sizeof *m->c_a, err);
        m->c_a = c_a != NULL ? c_a : m->c_a;
        c_ab = pm_realloc(m->c_ab, 3 * more, sizeof *m->c_ab, err);
        m->c_ab = c_ab != NULL ? c_ab : m->c_ab;
        if (col == NULL || c == NULL || c_a == NULL || c_ab == NULL)
            return PM_SYSTEM;
        *capacity = more;
    }
    for (ptrdiff_t k = 0; k < b->n; k++)
        m->col[first + k] = (int32_t)(offset + b->id[k]);
    memcpy(&m->c[first], b->c, (size_t)b->n * sizeof(double));
    memcpy(&m->c_a[2 * first], b->c_a, 2 * (size_t)b->n * sizeof(double));
    memcpy(&m->c_ab[3 * first], b->c_ab, 3 * (size_t)b->n * sizeof(double));
    m->ptr[i + 1] = m->nw = first + b->n;
    return PM_OK;
}

void pm_samples_metric(struct pm_samples *m, ptrdiff_t i, const double *r_a)
{
    double *g = &m->metric[3 * i];

    memset(g, 0, 3 * sizeof *g);
    for (int j = 0; j < 3; j++) {
        g[0] += r_a[j] * r_a[j];
        g[1] += r_a[j] * r_a[3 + j];
        g[2] += r_a[3 + j] * r_a[3 + j];
    }
}

/* Sample i of surface k, whose S and w are set. */
static enum pm_status add_sample(struct pm_samples *m, const struct pm_surfaces *s, ptrdiff_t k,
                                 const struct pm_map *map, ptrdiff_t i, struct pm_basis *b,
                                 ptrdiff_t *capacity, struct pm_err *err)
{
    enum pm_status status;
    struct pm_curvature c;
    double r_a[6];

    PM_TRY(pm_map_basis(map, &m->S[3 * i], 2, b, err));
    PM_TRY(add_row(m, i, b, s->offset[k], capacity, err));
    pm_basis_apply(b, s->s[k].phi, NULL, r_a, NULL);
    pm_curvature_at(r_a, NULL, &c);
    m->surface[i] = (int32_t)k;
    m->area[i] = m->w[i] * c.A;
    pm_samples_metric(m, i, r_a);
done:
    return status;
}

/* Samples of surface k from number m->first[k] on. */
static enum pm_status fill(struct pm_samples *m, const struct pm_surfaces *s, ptrdiff_t k,
                           const struct pm_map *map, const ptrdiff_t *cuts, ptrdiff_t *capacity,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *f = &s->s[k];
    struct pm_basis b = {0};
    struct patch p;
    ptrdiff_t i = m->first[k];

    for (ptrdiff_t t = 0; t < f->nt; t++) {
        patch_init(f, f->Phi, t, &p);
        p.cuts = cuts[t];
        for (ptrdiff_t q = 0; q < cuts[t] * cuts[t]; q++, i++) {
            part(&p, q, &m->S[3 * i], &m->w[i]);
            PM_TRY(add_sample(m, s, k, map, i, &b, capacity, err));
        }
    }
    for (ptrdiff_t a = 0; i < m->first[k + 1]; a++, i++) {
        memcpy(&m->S[3 * i], &f->Phi[3 * a], 3 * sizeof *m->S);
        PM_TRY(add_sample(m, s, k, map, i, &b, capacity, err));
    }
done:
    pm_basis_release(&b);
    return status;
}

void pm_samples_parameters(const struct pm_surface *s, const double *Phi, ptrdiff_t cuts, double *S)
{
    struct patch p;
    double area;

    for (ptrdiff_t t = 0; t < s->nt; t++) {
        patch_init(s, Phi, t, &p);
        p.cuts = cuts;
        for (ptrdiff_t q = 0; q < cuts * cuts; q++, S += 3)
            part(&p, q, S, &area);
    }
}

static enum pm_status reserve(struct pm_samples *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    PM_TRY(PM_NEW(m->surface, m->n, err));
    PM_TRY(PM_NEW(m->S, 3 * m->n, err));
    PM_TRY(PM_NEW(m->w, m->n, err));
    PM_TRY(PM_NEW(m->area, m->n, err));
    PM_TRY(PM_NEW(m->metric, 3 * m->n, err));
    PM_TRY(PM_NEW(m->ptr, m->n + 1, err));
done:
    return status;
}

static enum pm_status make(const struct pm_surfaces *s, const struct wish *wish,
                           struct pm_samples *samples, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_samples m = {0};
    struct pm_map *map[PM_MAX_CHAMBERS + 1] = {0};
    ptrdiff_t *plans[PM_MAX_CHAMBERS + 1] = {0}, capacity = 0;

    memset(samples, 0, sizeof *samples);
    PM_TRY(PM_NEW(m.first, s->ns + 1, err));
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        PM_TRY(PM_NEW(plans[k], s->s[k].nt, err));
        PM_TRY(pm_map_new(&s->s[k], &map[k], err));
        PM_TRY(plan(&s->s[k], map[k], wish, plans[k], &m.n, err));
        m.first[k + 1] = m.n;
    }
    PM_TRY(reserve(&m, err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(fill(&m, s, k, map[k], plans[k], &capacity, err));
    *samples = m;
    memset(&m, 0, sizeof m);
done:
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        pm_map_free(map[k]);
        pm_free(plans[k]);
    }
    pm_samples_release(&m);
    return status;
}

enum pm_status pm_samples_new(const struct pm_surfaces *s, double spacing, ptrdiff_t cuts,
                              struct pm_samples *samples, struct pm_err *err)
{
    return make(s, &(struct wish){spacing, cuts, 0}, samples, err);
}

enum pm_status pm_samples_with_nodes(const struct pm_surfaces *s, double spacing, ptrdiff_t cuts,
                                     struct pm_samples *samples, struct pm_err *err)
{
    return make(s, &(struct wish){spacing, cuts, 1}, samples, err);
}

void pm_samples_release(struct pm_samples *m)
{
    pm_free(m->first);
    pm_free(m->surface);
    pm_free(m->S);
    pm_free(m->w);
    pm_free(m->area);
    pm_free(m->metric);
    pm_free(m->ptr);
    pm_free(m->col);
    pm_free(m->c);
    pm_free(m->c_a);
    pm_free(m->c_ab);
    memset(m, 0, sizeof *m);
}

void pm_samples_at(const struct pm_samples *samples, ptrdiff_t i, const double *phi, double *r,
                   double *r_a, double *r_ab)
{
    ptrdiff_t k = samples->ptr[i];
    struct pm_basis row = {.n = samples->ptr[i + 1] - k,
                           .id = &samples->col[k],
                           .c = &samples->c[k],
                           .c_a = &samples->c_a[2 * k],
                           .c_ab = &samples->c_ab[3 * k]};

    pm_basis_apply(&row, phi, r, r_a, r_ab);
}

void pm_samples_all(const struct pm_samples *samples, const double *phi, double *x, double *normal)
{
    struct pm_curvature c;
    double r_a[6];

    for (ptrdiff_t i = 0; i < samples->n; i++) {
        pm_samples_at(samples, i, phi, &x[3 * i], normal != NULL ? r_a : NULL, NULL);
        if (normal == NULL)
            continue;
        pm_curvature_at(r_a, NULL, &c);
        memcpy(&normal[3 * i], c.n, sizeof c.n);
    }
}
