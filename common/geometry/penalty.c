#include "common/geometry/penalty.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/curvature.h"
#include "common/geometry/domain.h"
#include "common/geometry/feet.h"

static const double FOLD_SHARE = 0.2;
/* Rows of four, the last a dummy, are one vector each: the walls are most of the work. */
enum { WIDE = 4 };

static double square(double x)
{
    return x * x;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* One point of every orbit: where a linear function without symmetry is largest among the images.
 * Points that are their own image count once for each operation that keeps them; they are few. */
static int fundamental(const struct pm_symmetry *y, const double x[3])
{
    static const double c[3] = {1, 0.5773502691896257, 0.2360679774997897};

    for (ptrdiff_t g = 1; g < y->nops; g++) {
        double lead = 0;
        for (int i = 0; i < 3; i++)
            lead += c[i] * (dot(&y->Q[g][3 * i], x) + y->t[g][i] - x[i]);
        if (lead > 1e-9)
            return 0;
    }
    return 1;
}

static void weigh(struct pm_penalty *p, const double *phi)
{
    const struct pm_samples *q = &p->samples;
    double area = 0;

    for (ptrdiff_t i = 0; i < q->n; i++)
        area += q->area[i];
    for (ptrdiff_t i = 0; i < q->n; i++) {
        pm_samples_at(q, i, phi, &p->x[3 * i], NULL, NULL);
        /* samples at control points carry no area: the mean */
        const double own = q->area[i] > 0 ? q->area[i] / area : 1 / (double)q->n;
        p->share[i] = own * (double)p->c->symmetry.nops;
        p->from[i] = (unsigned char)fundamental(&p->c->symmetry, &p->x[3 * i]);
        for (ptrdiff_t w = q->ptr[i]; w < q->ptr[i + 1] && p->from[i]; w++)
            if (pm_feet_moves(p->s, q->col[w]))
                p->from[i] = 2;
    }
}

enum pm_status pm_penalty_new(const struct pm_surfaces *s, struct pm_penalty *p, struct pm_err *err)
{
    enum pm_status status;
    /* Edges of 0.65 d, so 0.38 d from any point of a surface to the nearest sample: over a crest of
     * radius d facing a plane both sides together miss 1 % of the wall. */
    const double edge = 0.65 * s->pcase.wall_min;
    double *phi = NULL;

    *p = (struct pm_penalty){.s = s, .c = &s->pcase, .cover = edge / sqrt(3.0)};
    PM_TRY(pm_samples_with_nodes(s, edge, 2, &p->samples, err));
    const ptrdiff_t n = p->samples.n;
    PM_TRY(PM_NEW(p->from, n, err));
    PM_TRY(PM_NEW(p->flag, n, err));
    PM_TRY(PM_NEW(p->share, n, err));
    PM_TRY(PM_NEW(p->x, 3 * n, err));
    PM_TRY(PM_NEW(p->normal, 3 * n, err));
    PM_TRY(PM_NEW(p->bend, n, err));
    PM_TRY(PM_NEW(p->bound, 3 * n, err));
    PM_TRY(PM_NEW(p->wall, 1, err));
    PM_TRY(PM_NEW(p->places, WIDE * s->offset[s->ns], err));
    PM_TRY(PM_NEW(p->pull, WIDE * s->offset[s->ns], err));
    for (ptrdiff_t k = 0; k < s->ns; k++)
        PM_TRY(pm_map_new(&s->s[k], &p->map[k], err));
    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    pm_surfaces_gather(s, phi);
    weigh(p, phi);
done:
    pm_free(phi);
    return status;
}

void pm_penalty_release(struct pm_penalty *p)
{
    pm_samples_release(&p->samples);
    for (int k = 0; k <= PM_MAX_CHAMBERS; k++)
        pm_map_free(p->map[k]);
    pm_basis_release(&p->work);
    pm_free(p->from);
    pm_free(p->flag);
    pm_free(p->share);
    pm_free(p->x);
    pm_free(p->normal);
    pm_free(p->bend);
    pm_free(p->bound);
    pm_free(p->wall);
    pm_free(p->col);
    pm_free(p->weight);
    pm_free(p->places);
    pm_free(p->pull);
    *p = (struct pm_penalty){0};
}

/* Enters one constraint; returns the factor of its gradient, a_q <lambda + rho g>. */
static double enter(struct pm_penalty_value *v, int kind, double share, double multiplier,
                    double rho, double g)
{
    const double t = fmax(multiplier + rho * g, 0);
    v->lagrangian += rho > 0 ? share * (t * t - multiplier * multiplier) / (2 * rho) : 0;
    v->sum[kind] += share * square(fmax(g, 0));
    return share * t;
}

static void take_places(const struct pm_penalty *p, const double *phi)
{
    for (ptrdiff_t m = 0; m < p->s->offset[p->s->ns]; m++)
        memcpy(&p->places[WIDE * m], &phi[3 * m], 3 * sizeof *phi);
}

/* x = sum c phi of n control points. */
static inline void gather(ptrdiff_t n, const int32_t *col, const double *c, const double *places,
                          double x[WIDE])
{
    double sum[WIDE] = {0};
    for (ptrdiff_t w = 0; w < n; w++)
        for (int j = 0; j < WIDE; j++)
            sum[j] += c[w] * places[WIDE * (ptrdiff_t)col[w] + j];
    memcpy(x, sum, sizeof sum);
}

/* pull += c force */
static inline void spread(ptrdiff_t n, const int32_t *col, const double *c,
                          const double force[WIDE], double *pull)
{
    for (ptrdiff_t w = 0; w < n; w++)
        for (int j = 0; j < WIDE; j++)
            pull[WIDE * (ptrdiff_t)col[w] + j] += c[w] * force[j];
}

static void spread_sample(const struct pm_penalty *p, ptrdiff_t i, const double force[WIDE])
{
    const struct pm_samples *q = &p->samples;
    const ptrdiff_t k = q->ptr[i];
    spread(q->ptr[i + 1] - k, q->col + k, q->c + k, force, p->pull);
}

static void place_of(const struct pm_penalty *p, ptrdiff_t i, double x[WIDE])
{
    const struct pm_samples *q = &p->samples;
    const ptrdiff_t k = q->ptr[i];
    gather(q->ptr[i + 1] - k, q->col + k, q->c + k, p->places, x);
}

static void add_curvature(const struct pm_penalty *p, const double *phi, double rho,
                          double *gradient, struct pm_penalty_value *v)
{
    const struct pm_samples *q = &p->samples;
    const double limit = square(p->c->curvature_max);

    for (ptrdiff_t i = 0; i < q->n; i++) {
        if (!(p->flag[i] & PM_FEET_BEND))
            continue;
        double r_a[6], r_ab[9], Q_a[6], Q_ab[9];
        struct pm_curvature at;
        pm_samples_at(q, i, phi, NULL, r_a, r_ab);
        pm_curvature_at(r_a, r_ab, &at);
        v->worst[0] = fmax(v->worst[0], sqrt(at.Q) / p->c->curvature_max - 1);
        const double f = enter(v, 0, p->share[i], p->bend[i], rho, at.Q / limit - 1) / limit;
        if (gradient == NULL || !(f > 0))
            continue;
        pm_curvature_gradient(r_a, r_ab, Q_a, Q_ab);
        for (ptrdiff_t w = q->ptr[i]; w < q->ptr[i + 1]; w++)
            for (int j = 0; j < 3; j++) {
                const double *c_a = q->c_a + 2 * w, *c_ab = q->c_ab + 3 * w;
                gradient[3 * q->col[w] + j] +=
                    f * (c_a[0] * Q_a[j] + c_a[1] * Q_a[3 + j] + c_ab[0] * Q_ab[j] +
                         c_ab[1] * Q_ab[3 + j] + c_ab[2] * Q_ab[6 + j]);
            }
    }
}

/* r_q - r* along m [mm]. */
static double gap(const struct pm_penalty *p, const struct pm_penalty_wall *t, const double x[WIDE])
{
    const ptrdiff_t k = t->first;
    double r[WIDE];
    gather(t[1].first - k, p->col + k, p->weight + k, p->places, r);
    return (x[0] - r[0]) * t->m[0] + (x[1] - r[1]) * t->m[1] + (x[2] - r[2]) * t->m[2];
}

static void add_walls(const struct pm_penalty *p, double rho, int pulls, struct pm_penalty_value *v)
{
    double x[WIDE] = {0};

    for (ptrdiff_t k = 0; k < p->nwall; k++) {
        const struct pm_penalty_wall *t = &p->wall[k];
        if (k == 0 || t[-1].i != t->i)
            place_of(p, t->i, x);
        const double g = 1 - gap(p, t, x) / t->limit;
        v->worst[1] = fmax(v->worst[1], g);
        const double f = enter(v, 1, p->share[t->i], t->multiplier, rho, g) / t->limit;
        if (!pulls || !(f > 0))
            continue;
        const double force[WIDE] = {f * t->m[0], f * t->m[1], f * t->m[2]};
        const double back[WIDE] = {-force[0], -force[1], -force[2]};
        spread_sample(p, t->i, back);
        spread(t[1].first - t->first, p->col + t->first, p->weight + t->first, force, p->pull);
    }
}

static void add_bounds(const struct pm_penalty *p, double rho, int pulls,
                       struct pm_penalty_value *v)
{
    const double d = p->c->wall_min;

    for (ptrdiff_t i = 0; i < p->samples.n; i++) {
        double x[WIDE], force[WIDE] = {0}, n[3];
        if (!(p->flag[i] & PM_FEET_BOUND))
            continue;
        place_of(p, i, x);
        for (int k = 0; k < 3; k++) {
            const double g = pm_domain_depth(p->c, p->samples.surface[i] > 0, k, x, n) / d;
            if (!(g > -HUGE_VAL))
                continue;
            v->worst[1] = fmax(v->worst[1], g);
            const double f = enter(v, 1, p->share[i], p->bound[3 * i + k], rho, g) / d;
            for (int j = 0; j < 3; j++)
                force[j] += f * n[j];
        }
        if (pulls)
            spread_sample(p, i, force);
    }
}

void pm_penalty_at(const struct pm_penalty *p, const double *phi, const double rho[2],
                   double *gradient, struct pm_penalty_value *v)
{
    const ptrdiff_t N = p->s->offset[p->s->ns];

    *v = (struct pm_penalty_value){0};
    add_curvature(p, phi, rho[0], gradient, v);
    take_places(p, phi);
    memset(p->pull, 0, (size_t)(WIDE * N) * sizeof *p->pull);
    add_walls(p, rho[1], gradient != NULL, v);
    add_bounds(p, rho[1], gradient != NULL, v);
    for (ptrdiff_t k = 0; k < 3 * N && gradient != NULL; k++)
        gradient[k] += p->pull[k / 3 * WIDE + k % 3];
}

static double bend_excess(const struct pm_penalty *p, const double *phi, ptrdiff_t i)
{
    double r_a[6], r_ab[9];
    struct pm_curvature c;

    pm_samples_at(&p->samples, i, phi, NULL, r_a, r_ab);
    pm_curvature_at(r_a, r_ab, &c);
    return sqrt(c.Q) / p->c->curvature_max - 1;
}

static double depth_over(const struct pm_penalty *p, ptrdiff_t i, const double x[WIDE])
{
    double most = 0, n[3];

    for (int k = 0; k < 3; k++)
        most = fmax(most, pm_domain_depth(p->c, p->samples.surface[i] > 0, k, x, n));
    return most / p->c->wall_min;
}

void pm_penalty_worst(const struct pm_penalty *p, const double *phi, double *curvature,
                      double *wall)
{
    const ptrdiff_t ns = p->s->ns;
    double x[WIDE];

    memset(curvature, 0, (size_t)ns * sizeof *curvature);
    memset(wall, 0, (size_t)(ns * ns) * sizeof *wall);
    take_places(p, phi);
    for (ptrdiff_t i = 0; i < p->samples.n; i++) {
        const int32_t a = p->samples.surface[i];
        if (p->flag[i] & PM_FEET_BEND)
            curvature[a] = fmax(curvature[a], bend_excess(p, phi, i));
        if (!(p->flag[i] & PM_FEET_BOUND))
            continue;
        place_of(p, i, x);
        wall[a * (ns + 1)] = fmax(wall[a * (ns + 1)], depth_over(p, i, x));
    }
    for (ptrdiff_t k = 0; k < p->nwall; k++) {
        const struct pm_penalty_wall *t = &p->wall[k];
        const int32_t a = p->samples.surface[t->i], b = t->other < 0 ? a : t->other;
        double *w = &wall[a < b ? a * ns + b : b * ns + a];
        place_of(p, t->i, x);
        *w = fmax(*w, 1 - gap(p, t, x) / t->limit);
    }
}

enum pm_status pm_penalty_survey(const struct pm_surfaces *s, double *curvature, double *wall,
                                 struct pm_err *err)
{
    enum pm_status status;
    struct pm_penalty p = {.s = NULL};
    double *phi = NULL;

    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    pm_surfaces_gather(s, phi);
    PM_TRY(pm_penalty_new(s, &p, err));
    PM_TRY(pm_penalty_collect(&p, phi, 0, 1, err));
    pm_penalty_worst(&p, phi, curvature, wall);
done:
    pm_penalty_release(&p);
    pm_free(phi);
    return status;
}

void pm_penalty_raise(struct pm_penalty *p, const double *phi, const double rho[2])
{
    const struct pm_samples *q = &p->samples;
    double x[WIDE], n[3], r_a[6], r_ab[9];
    struct pm_curvature c;

    take_places(p, phi);
    for (ptrdiff_t i = 0; i < q->n; i++) {
        if (p->flag[i] & PM_FEET_BEND) {
            pm_samples_at(q, i, phi, NULL, r_a, r_ab);
            pm_curvature_at(r_a, r_ab, &c);
            p->bend[i] = fmax(p->bend[i] + rho[0] * (c.Q / square(p->c->curvature_max) - 1), 0);
        }
        if (!(p->flag[i] & PM_FEET_BOUND))
            continue;
        place_of(p, i, x);
        for (int k = 0; k < 3; k++) {
            const double g = pm_domain_depth(p->c, q->surface[i] > 0, k, x, n) / p->c->wall_min;
            p->bound[3 * i + k] = fmax(p->bound[3 * i + k] + rho[1] * g, 0);
        }
    }
    for (ptrdiff_t k = 0; k < p->nwall; k++) {
        struct pm_penalty_wall *t = &p->wall[k];
        place_of(p, t->i, x);
        t->multiplier = fmax(t->multiplier + rho[1] * (1 - gap(p, t, x) / t->limit), 0);
    }
}

void pm_penalty_relax(struct pm_penalty *p)
{
    memset(p->bend, 0, (size_t)p->samples.n * sizeof *p->bend);
    memset(p->bound, 0, (size_t)(3 * p->samples.n) * sizeof *p->bound);
    for (ptrdiff_t k = 0; k < p->nwall; k++)
        p->wall[k].multiplier = 0;
}

double pm_penalty_safe_part(const struct pm_penalty *p, const double *phi, const double *step)
{
    double part = 1;

    for (ptrdiff_t i = 0; i < p->samples.n; i++) {
        double r_a[6], d_a[6], full[6];
        struct pm_curvature old, new;
        if (!p->from[i])
            continue;
        pm_samples_at(&p->samples, i, phi, NULL, r_a, NULL);
        pm_samples_at(&p->samples, i, step, NULL, d_a, NULL);
        pm_curvature_at(r_a, NULL, &old);
        for (;; part /= 2) {
            for (int j = 0; j < 6; j++)
                full[j] = r_a[j] + part * d_a[j];
            pm_curvature_at(full, NULL, &new);
            if (part < 1e-6 || new.A * dot(new.n, old.n) > FOLD_SHARE *old.A)
                break;
        }
    }
    return part;
}

void pm_penalty_mass(const struct pm_penalty *p, double *mass)
{
    const struct pm_surfaces *s = p->s;
    const struct pm_samples *samples = &p->samples;
    const ptrdiff_t N = s->offset[s->ns], nops = s->pcase.symmetry.nops;
    double area = 0;

    memset(mass, 0, (size_t)N * sizeof *mass);
    for (ptrdiff_t q = 0; q < samples->n; q++) {
        area += samples->area[q];
        for (ptrdiff_t w = samples->ptr[q]; w < samples->ptr[q + 1]; w++)
            mass[samples->col[w]] += samples->area[q] * samples->c[w];
    }
    /* Orbits: images are visited from their first member, every member gets the mean. A floor keeps
     * points that hardly move a surface from taking all of a step. */
    for (ptrdiff_t i = 0; i < N; i++) {
        ptrdiff_t first = i;
        double sum = 0;
        for (ptrdiff_t g = 0; g < nops; g++)
            first = s->perm[g * N + i] < first ? s->perm[g * N + i] : first;
        if (first < i)
            continue;
        for (ptrdiff_t g = 0; g < nops; g++)
            sum += mass[s->perm[g * N + i]];
        const double mean = fmax(sum / (double)nops / area, 0.01 / (double)N);
        for (ptrdiff_t g = 0; g < nops; g++)
            mass[s->perm[g * N + i]] = mean;
    }
}
