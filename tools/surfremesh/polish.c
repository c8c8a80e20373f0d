/* New control points keep the constraints that the old ones kept. */
#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/base/minimise.h"
#include "common/geometry/penalty.h"
#include "common/geometry/symmetry.h"
#include "tools/surfremesh/rebuild.h"

/* Held are a fifth more curvature and 1.5 % thinner walls: a fit ripples about the curvature of a
 * crest that is at its limit, and to flatten the ripples wholly took 6 % of a measure. Largest
 * violations of that which are left; rho of the augmented Lagrangian [mm2] at the start, its growth
 * where a round leaves more than SLOW of a violation. Reach of the constraints [mm], several times
 * what a fit misses. Beyond LOST, surfaces that have passed each other or ten times the curvature,
 * no round found back. */
static const double RELAXED[2] = {1.2, 0.985}, LEFT[2] = {0.02, 0.005}, LOST[2] = {100, 1};
static const double RHO = 1, GROWTH = 3, SLOW = 0.3, REACH = 0.3;
enum { ROUNDS = 8, LOOKS = 3 };

/* min |step|^2_M / 2 with all g <= 0 [penalty.h], |step|^2_M the mean square displacement. */
struct polish {
    const struct rebuild *r;
    struct pm_surfaces *s;
    struct pm_penalty penalty;
    ptrdiff_t N;
    double rho[2], unit;         /* of the objective [mm2] */
    double *phi, *trial, *slope; /* (N x 3) */
    double *scale; /* step = scale z: (unit/M_m)^(1/2), 0 on surfaces that are kept (N) */
};

static double evaluate(void *context, const double *z, double *g)
{
    struct polish *p = context;
    struct pm_penalty_value v;
    double f = 0;

    for (ptrdiff_t i = 0; i < 3 * p->N; i++) {
        p->trial[i] = p->phi[i] + p->scale[i / 3] * z[i];
        p->slope[i] = 0;
        f += z[i] * z[i] / 2;
    }
    pm_penalty_at(&p->penalty, p->trial, p->rho, p->slope, &v);
    pm_symmetrise_vectors(p->s, p->slope);
    for (ptrdiff_t i = 0; i < 3 * p->N; i++)
        g[i] = z[i] + p->scale[i / 3] * p->slope[i] / p->unit;
    f += v.lagrangian / p->unit;
    return isfinite(f) ? f + 2 : HUGE_VAL;
}

static enum pm_status set_scale(struct polish *p, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *mass = NULL;

    PM_TRY(PM_NEW(mass, p->N, err));
    pm_penalty_mass(&p->penalty, mass);
    for (ptrdiff_t k = 0; k < p->s->ns; k++)
        for (ptrdiff_t m = p->s->offset[k]; m < p->s->offset[k + 1]; m++)
            p->scale[m] = p->r->redo[k] ? sqrt(p->unit / mass[m]) : 0;
done:
    pm_free(mass);
    return status;
}

static int is_good(const struct pm_penalty_value *v)
{
    return v->worst[0] <= LEFT[0] && v->worst[1] <= LEFT[1];
}

static int is_lost(const struct pm_penalty_value *v)
{
    return !(v->worst[0] <= LOST[0] && v->worst[1] <= LOST[1]);
}

/* The method of multipliers on one set of samples; *moved = 0 where nothing was to be done or it is
 * lost. */
static enum pm_status rounds(struct polish *p, double *z, int *moved, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_penalty_value v;
    double last[2] = {HUGE_VAL, HUGE_VAL};

    p->rho[0] = p->rho[1] = RHO;
    *moved = 0;
    memcpy(p->trial, p->phi, (size_t)(3 * p->N) * sizeof *p->phi);
    memset(z, 0, (size_t)(3 * p->N) * sizeof *z);
    for (int round = 0;; round++) {
        PM_TRY(pm_penalty_collect(&p->penalty, p->trial, REACH, 0.8, err));
        pm_penalty_at(&p->penalty, p->trial, p->rho, NULL, &v);
        pm_log(2, "constraints, round %d: violations %.4f %.4f", round, v.worst[0], v.worst[1]);
        const int lost = round > 0 && is_lost(&v);
        if (lost)
            *moved = 0;
        if (lost || is_good(&v) || round == ROUNDS)
            break;
        for (int k = 0; k < 2 && round > 0; k++) {
            p->rho[k] *= v.worst[k] > fmax(LEFT[k], SLOW * last[k]) ? GROWTH : 1;
            last[k] = v.worst[k];
        }
        if (round == 0) {
            p->unit = RHO * (v.sum[0] + v.sum[1]);
            PM_TRY(set_scale(p, err));
        }
        PM_TRY(pm_minimise(3 * p->N, z, evaluate, p, err));
        for (ptrdiff_t i = 0; i < 3 * p->N; i++)
            p->trial[i] = p->phi[i] + p->scale[i / 3] * z[i];
        pm_penalty_raise(&p->penalty, p->trial, p->rho);
        *moved = 1;
    }
done:
    return status;
}

/* The trial, exactly symmetric; what may not move stays bit for bit. */
static void take_over(struct polish *p)
{
    pm_symmetrise_points(p->s, p->trial);
    for (ptrdiff_t k = 0; k < p->s->ns; k++)
        for (ptrdiff_t m = p->s->offset[k]; m < p->s->offset[k + 1]; m++) {
            const uint8_t *f = p->s->s[k].free + 3 * (m - p->s->offset[k]);
            if (p->scale[m] == 0 || !(f[0] || f[1] || f[2]))
                memcpy(&p->trial[3 * m], &p->phi[3 * m], 3 * sizeof *p->phi);
        }
    pm_surfaces_scatter(p->s, p->trial);
}

enum pm_status rebuild_polish(struct rebuild *r, struct pm_surfaces *s, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct polish p = {.r = r, .s = s, .N = s->offset[s->ns]};
    double *z = NULL;
    int moved = 1;

    PM_TRY(PM_NEW(p.phi, 3 * p.N, err));
    PM_TRY(PM_NEW(p.trial, 3 * p.N, err));
    PM_TRY(PM_NEW(p.slope, 3 * p.N, err));
    PM_TRY(PM_NEW(p.scale, p.N, err));
    PM_TRY(PM_NEW(z, 3 * p.N, err));
    s->pcase.curvature_max *= RELAXED[0];
    s->pcase.wall_min *= RELAXED[1];
    s->pcase.void_min *= RELAXED[1];
    for (int look = 0; look < LOOKS && moved; look++) { /* new samples see new peaks */
        pm_penalty_release(&p.penalty);
        PM_TRY(pm_penalty_new(s, &p.penalty, err));
        pm_surfaces_gather(s, p.phi);
        PM_TRY(rounds(&p, z, &moved, err));
        if (moved)
            take_over(&p);
    }
    s->pcase.curvature_max = r->from->pcase.curvature_max;
    s->pcase.wall_min = r->from->pcase.wall_min;
    s->pcase.void_min = r->from->pcase.void_min;
    for (ptrdiff_t k = 0; k < s->ns; k++)
        if (r->redo[k] && r->source[k] == k)
            memcpy(r->made[k].phi, s->s[k].phi, (size_t)(3 * s->s[k].n) * sizeof *s->s[k].phi);
done:
    pm_penalty_release(&p.penalty);
    pm_free(p.phi);
    pm_free(p.trial);
    pm_free(p.slope);
    pm_free(p.scale);
    pm_free(z);
    return status;
}
