/* Assembly of the tangent of the model into its pattern, and the factor. */
#include <math.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/mechanics/krylov.h"
#include "common/mechanics/model.h"
#include "common/mechanics/tensor.h"

/* B_a = [I, R_1 r_a, R_2 r_a, R_3 r_a] (3 x 6): motion of a tip node by the end-effector. */
static void tip_map(const struct pm_model *m, const struct pm_rotation *rot, ptrdiff_t a,
                    double B[18])
{
    memset(B, 0, 18 * sizeof *B);
    for (int k = 0; k < 3; k++) {
        double y[3];
        B[6 * k + k] = 1.0;
        pm_mul3(rot->Ri[k], m->arm + 3 * a, y);
        for (int i = 0; i < 3; i++)
            B[6 * i + 3 + k] = y[i];
    }
}

static double *tail_entry(struct pm_model *m, ptrdiff_t row, ptrdiff_t column_of_tail)
{
    /* lower triangle of the last 6 columns, row >= column */
    ptrdiff_t c = m->nq - 6 + column_of_tail;
    return m->value + m->pattern.ptr[c] + (row - column_of_tail);
}

/* Adds the 3x3 block k of nodes (a, b); only the half that the lower triangle stores. */
static void add_block(struct pm_model *m, const struct pm_rotation *rot, ptrdiff_t a, ptrdiff_t b,
                      const double k[9])
{
    const struct pm_pattern *p = &m->pattern;
    ptrdiff_t i = p->eq[a], j = p->eq[b];
    if (i >= 0 && j >= 0) {
        if (i >= j) {
            ptrdiff_t base = pm_pattern_block(p, i, j, 0),
                      height = p->ptr[3 * j + 1] - p->ptr[3 * j];
            for (int c = 0; c < 3; c++)
                for (int d = 0; d < 3; d++)
                    m->value[base + c * height + d] += k[3 * d + c];
        }
        return;
    }
    if (m->kind[a] != PM_NODE_TIP || m->kind[b] == PM_NODE_CLAMPED)
        return;
    double Ba[18], BK[18]; /* BK = B_a^T k (6 x 3) */
    tip_map(m, rot, a, Ba);
    for (int t = 0; t < 6; t++)
        for (int c = 0; c < 3; c++)
            BK[3 * t + c] = Ba[t] * k[c] + Ba[6 + t] * k[3 + c] + Ba[12 + t] * k[6 + c];
    if (j >= 0) {
        for (int c = 0; c < 3; c++)
            for (int t = 0; t < 6; t++)
                m->value[p->ptr[3 * j + c + 1] - 6 + t] += BK[3 * t + c];
        return;
    }
    double Bb[18];
    tip_map(m, rot, b, Bb);
    for (int s = 0; s < 6; s++)
        for (int t = s; t < 6; t++)
            *tail_entry(m, t, s) +=
                BK[3 * t] * Bb[s] + BK[3 * t + 1] * Bb[6 + s] + BK[3 * t + 2] * Bb[12 + s];
}

/* Both orders of block k of nodes (a, b). */
static void add_both(struct pm_model *m, const struct pm_rotation *rot, ptrdiff_t a, ptrdiff_t b,
                     const double k[9])
{
    const double kT[9] = {k[0], k[3], k[6], k[1], k[4], k[7], k[2], k[5], k[8]};
    add_block(m, rot, a, b, k);
    if (a != b)
        add_block(m, rot, b, a, kT);
}

static void add_slot(double *value, const struct pm_slot *s, const pm_lanes *K, int lane)
{
    double *to = value + s->at;
    for (int c = 0; c < 3; c++, to += s->height)
        for (int d = 0; d < 3; d++)
            to[d] += K[s->transposed ? 3 * c + d : 3 * d + c][lane];
}

static void add_elements(struct pm_model *m, const struct pm_rotation *rot,
                         const struct pm_config *c, const pm_lanes *mixed)
{
    const struct pm_element_type *t = m->space.type;
    ptrdiff_t npe = t->npe, blocks = npe * (npe + 1) / 2;
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch);
        pm_lanes u[3 * PM_MOST_NODES], K[9 * PM_MOST_NODES * (PM_MOST_NODES + 1) / 2];
        pm_model_gather(m, batch, c->u, u);
        pm_element_tangent(&el, u, mixed != NULL ? mixed + PM_MIXED * t->nq * batch : NULL, K);
        for (int l = 0; l < pm_model_lanes(m, batch); l++) {
            const int32_t *node = m->space.tet + npe * (PM_LANES * batch + l);
            const struct pm_slot *s = m->slot + blocks * (PM_LANES * batch + l);
            for (ptrdiff_t b = 0, at = 0; b < npe; b++)
                for (ptrdiff_t a = 0; a <= b; a++, at++) {
                    if (s[at].at >= 0) {
                        add_slot(m->value, s + at, K + 9 * at, l);
                    } else if (s[at].at == -2) {
                        double k[9];
                        for (int i = 0; i < 9; i++)
                            k[i] = K[9 * at + i][l];
                        add_both(m, rot, node[a], node[b], k);
                    }
                }
        }
    }
}

/* - p_r H with H_ab = skew(s_ab); chamber faces point into the cavity, hence + p_r. */
static void add_pressure(struct pm_model *m, const struct pm_rotation *rot,
                         const struct pm_config *c, const double *p)
{
    int n = m->cavity.n;
    for (ptrdiff_t f = 0; f < m->space.nf; f++) {
        const int32_t *t = m->space.tri + n * f;
        double x[3 * PM_MOST_FACE_NODES], s[3 * PM_MOST_FACE_NODES * PM_MOST_FACE_NODES];
        ptrdiff_t r = pm_model_chamber(m, f);
        double pr = r < 0 ? 0.0 : p[r];
        if (pr == 0.0)
            continue;
        pm_model_face(m, c, f, x);
        pm_cavity_hessian(&m->cavity, x, s);
        for (int a = 0; a < n; a++)
            for (int b = 0; b < n; b++) {
                const double *v = s + 3 * (n * a + b);
                const double k[9] = {0,          -pr * v[2], pr * v[1], pr * v[2], 0,
                                     -pr * v[0], -pr * v[1], pr * v[0], 0};
                add_block(m, rot, t[a], t[b], k);
            }
    }
}

/* sum_tip f_a . R_ij r_a on the rotation rows. */
static void add_tip_forces(struct pm_model *m, const struct pm_rotation *rot, const double *f)
{
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int j = 0; j < 3 && m->kind[a] == PM_NODE_TIP; j++)
            for (int i = j; i < 3; i++) {
                double y[3];
                pm_mul3(rot->Rij[i][j], m->arm + 3 * a, y);
                *tail_entry(m, 3 + i, 3 + j) += pm_dot3(f + 3 * a, y);
            }
}

/* Fixed equations become unity, scaled as the largest diagonal entry. */
static void fix_equations(struct pm_model *m)
{
    const struct pm_pattern *p = &m->pattern;
    double scale = 0.0;
    for (ptrdiff_t c = 0; c < m->nq; c++)
        for (ptrdiff_t k = p->ptr[c]; k < p->ptr[c + 1]; k++)
            if (p->row[k] == c)
                scale = fmax(scale, fabs(m->value[k]));
    for (ptrdiff_t c = 0; c < m->nq; c++)
        for (ptrdiff_t k = p->ptr[c]; k < p->ptr[c + 1]; k++)
            if (m->fixed[c] || m->fixed[p->row[k]])
                m->value[k] = p->row[k] == c ? scale : 0.0;
}

void pm_model_assemble(struct pm_model *m, const struct pm_config *c, const double *p,
                       const double *f, const pm_lanes *mixed)
{
    struct pm_rotation rot;
    clock_t start = clock();
    pm_rotation_at(c->U + 3, 0, &rot);
    memset(m->value, 0, (size_t)m->pattern.ptr[m->nq] * sizeof *m->value);
    add_elements(m, &rot, c, mixed);
    add_pressure(m, &rot, c, p);
    if (m->tail > 0)
        add_tip_forces(m, &rot, f);
    fix_equations(m);
    m->factored = m->factored ? 2 : 0;
    pm_cost_add(&m->cost.assemble, start);
}

static enum pm_status factor_values(struct pm_model *m, int *definite, struct pm_err *err)
{
    clock_t start = clock();
    enum pm_status status = pm_cholesky_factor(m->factor, m->value, definite, NULL, err);
    m->factored = status == PM_OK && *definite;
    m->steps = 0;
    m->factorisations++;
    pm_cost_add(&m->cost.factor, start);
    return status;
}

enum pm_status pm_model_factor(struct pm_model *m, const struct pm_config *c, const double *p,
                               const double *f, const pm_lanes *mixed, int *definite,
                               struct pm_err *err)
{
    pm_model_assemble(m, c, p, f, mixed);
    return factor_values(m, definite, err);
}

int pm_model_patience(const struct pm_model *m)
{
    double entries, flops;
    pm_cholesky_size(m->factor, &entries, &flops);
    /* a solve streams the factor twice: measured 50 to 80 flops of a factorisation per entry */
    return 3 + (int)(0.5 * flops / (80.0 * entries));
}

enum pm_status pm_model_prepare(struct pm_model *m, const struct pm_config *c, const double *p,
                                const double *f, const pm_lanes *mixed, double *probe,
                                double tolerance, int *definite, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *rhs = NULL;
    struct pm_krylov_report k = {0};
    PM_TRY(PM_NEW(rhs, m->nq, err));
    for (ptrdiff_t i = 0; i < m->nq; i++)
        rhs[i] = probe[i] = m->fixed[i] ? 0.0 : probe[i];
    *definite = 0;
    /* what has cost as much as a new factor is not kept longer */
    if (m->factored && m->steps <= 2 * pm_model_patience(m)) {
        pm_model_assemble(m, c, p, f, mixed);
        clock_t start = clock();
        PM_TRY(pm_krylov_solve(m, probe, 1, tolerance, pm_model_patience(m), &k, err));
        pm_cost_add(&m->cost.solve, start);
        m->solves += k.steps;
        m->steps += k.steps;
        *definite = k.good && k.least > 0.25;
        pm_log(3, "conjugate gradients: %d steps, Ritz values %.3f to %.3f%s", k.steps, k.least,
               k.largest, k.good ? "" : ", given up");
    }
    if (!*definite) {
        PM_TRY(pm_model_factor(m, c, p, f, mixed, definite, err));
        memcpy(probe, rhs, (size_t)m->nq * sizeof *probe);
        if (*definite)
            PM_TRY(pm_model_solve(m, probe, 1, 0.0, err));
    }
done:
    pm_free(rhs);
    return status;
}

enum pm_status pm_model_solve(struct pm_model *m, double *q, ptrdiff_t nrhs, double tolerance,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_krylov_report k = {0};
    double *rhs = NULL;
    clock_t start = clock();
    int definite;
    for (ptrdiff_t i = 0; i < m->nq * nrhs; i++)
        if (m->fixed[i % m->nq])
            q[i] = 0.0;
    if (m->factored == 2) {
        PM_TRY(PM_NEW(rhs, m->nq * nrhs, err));
        memcpy(rhs, q, (size_t)(m->nq * nrhs) * sizeof *rhs);
        PM_TRY(pm_krylov_solve(m, q, nrhs, tolerance, 2 * pm_model_patience(m), &k, err));
        m->solves += k.steps;
        m->steps += k.steps;
        if (k.good)
            goto done;
        memcpy(q, rhs, (size_t)(m->nq * nrhs) * sizeof *rhs);
        PM_TRY(factor_values(m, &definite, err));
        if (!definite)
            PM_TRY(pm_fail(err, PM_NUMERIC, "the tangent is not positive definite"));
    }
    m->solves++;
    status = pm_cholesky_solve(m->factor, q, nrhs, err);
done:
    pm_cost_add(&m->cost.solve, start);
    pm_free(rhs);
    return status;
}
