#include "common/mechanics/warp.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tensor.h"

enum { VALUES = 3 * PM_MOST_NODES };

/* One Laplacian: positions of the nodes of `pattern` free, of the others given; with symmetry
 * planes one matrix for each axis, else one for all. */
struct laplacian {
    struct pm_pattern pattern;
    struct pm_cholesky *factor[3];
};

struct pm_warp {
    struct pm_model *m;
    ptrdiff_t axes;               /* 3 with symmetry planes, else 1 */
    uint8_t *on_plane;            /* axis i of a node is given there (nn x 3) */
    struct laplacian loose, held; /* end-effector nodes free; given */
    double *rhs;                  /* (3 x unknowns of loose) */
    double *b;                    /* sum_q w grad N_a (target) (nn x 3) */
    double *x;                    /* displacement (nn x 3) */
};

/* L_ab = sum_q w grad N_a . grad N_b, blocks a <= b. */
static void laplace_batch(const struct pm_element *el, pm_lanes *L)
{
    int npe = el->type->npe;
    memset(L, 0, (size_t)(npe * (npe + 1) / 2) * sizeof *L);
    for (int q = 0; q < el->type->nq; q++) {
        const pm_lanes *dN = el->dN + 3 * npe * q;
        for (int b = 0, at = 0; b < npe; b++)
            for (int a = 0; a <= b; a++, at++)
                L[at] += el->w[q] * (dN[3 * a] * dN[3 * b] + dN[3 * a + 1] * dN[3 * b + 1] +
                                     dN[3 * a + 2] * dN[3 * b + 2]);
    }
}

static int given(const struct pm_warp *w, const struct laplacian *l, ptrdiff_t a, ptrdiff_t axis)
{
    return l->pattern.eq[a] < 0 || (w->axes == 3 && w->on_plane[3 * a + axis]);
}

/* Matrix of one axis: rows and columns of given values are unity. */
static void assemble(const struct pm_warp *w, const struct laplacian *l, ptrdiff_t axis,
                     double *value)
{
    const struct pm_model *m = w->m;
    const struct pm_pattern *p = &l->pattern;
    ptrdiff_t npe = m->space.type->npe;
    memset(value, 0, (size_t)p->ptr[p->n] * sizeof *value);
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch);
        pm_lanes L[PM_MOST_NODES * (PM_MOST_NODES + 1) / 2];
        laplace_batch(&el, L);
        for (int k = 0; k < pm_model_lanes(m, batch); k++) {
            const int32_t *t = m->space.tet + npe * (PM_LANES * batch + k);
            for (ptrdiff_t b = 0, at = 0; b < npe; b++)
                for (ptrdiff_t a = 0; a <= b; a++, at++) {
                    ptrdiff_t i = p->eq[t[a]], j = p->eq[t[b]];
                    if (!given(w, l, t[a], axis) && !given(w, l, t[b], axis))
                        value[pm_pattern_block(p, i > j ? i : j, i > j ? j : i, 0)] += L[at][k];
                }
        }
    }
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (p->eq[a] >= 0 && given(w, l, a, axis))
            value[p->ptr[p->eq[a]]] = 1.0;
}

static enum pm_status laplacian_new(const struct pm_warp *w, int tip_free, struct laplacian *l,
                                    struct pm_err *err)
{
    enum pm_status status;
    const struct pm_model *m = w->m;
    ptrdiff_t npe = m->space.type->npe;
    uint8_t *use = NULL;
    double *value = NULL;
    int definite;
    PM_TRY(PM_NEW(use, m->nn, err));
    for (ptrdiff_t k = 0; k < npe * m->space.ne; k++) {
        int32_t a = m->space.tet[k];
        use[a] = m->kind[a] == PM_NODE_FREE || (tip_free && m->kind[a] == PM_NODE_TIP);
    }
    PM_TRY(pm_pattern_new(&(struct pm_pattern_source){m->nn, m->space.ne, npe, m->space.tet, use,
                                                      NULL, 1, 0, &m->pattern},
                          &l->pattern, err));
    PM_TRY(PM_NEW(value, l->pattern.ptr[l->pattern.n], err));
    for (ptrdiff_t axis = 0; axis < w->axes; axis++) {
        assemble(w, l, axis, value);
        PM_TRY(
            pm_cholesky_new(l->pattern.n, l->pattern.ptr, l->pattern.row, &l->factor[axis], err));
        PM_TRY(pm_cholesky_factor(l->factor[axis], value, &definite, NULL, err));
        if (!definite)
            PM_TRY(pm_fail(err, PM_NUMERIC, "the Laplacian of the mesh is not positive definite"));
    }
done:
    pm_free(use);
    pm_free(value);
    return status;
}

static void laplacian_release(struct laplacian *l)
{
    for (int i = 0; i < 3; i++)
        pm_cholesky_free(l->factor[i]);
    pm_pattern_release(&l->pattern);
}

enum pm_status pm_warp_new(struct pm_model *m, struct pm_warp **out, struct pm_err *err)
{
    enum pm_status status;
    struct pm_warp *w = pm_calloc(1, sizeof *w, err);
    if (w == NULL)
        return PM_SYSTEM;
    clock_t start = clock();
    w->m = m;
    w->axes = 1;
    PM_TRY(PM_NEW(w->on_plane, 3 * m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && m->pattern.eq[a] >= 0; i++)
            w->on_plane[3 * a + i] = m->fixed[3 * m->pattern.eq[a] + i];
    for (ptrdiff_t f = 0; f < m->space.nf; f++) /* end-effector nodes on planes too */
        for (int a = 0; a < m->cavity.n && m->mesh->tri_tag[f] <= PM_FACE_SYM_X; a++) {
            w->axes = 3;
            w->on_plane[3 * (ptrdiff_t)m->space.tri[m->cavity.n * f + a] + PM_FACE_SYM_X -
                        m->mesh->tri_tag[f]] = 1;
        }
    PM_TRY(laplacian_new(w, 1, &w->loose, err));
    if (m->tail > 0)
        PM_TRY(laplacian_new(w, 0, &w->held, err));
    PM_TRY(PM_NEW(w->rhs, 3 * w->loose.pattern.n, err));
    PM_TRY(PM_NEW(w->b, 3 * m->nn, err));
    PM_TRY(PM_NEW(w->x, 3 * m->nn, err));
    pm_cost_add(&m->cost.warp, start);
    *out = w;
    w = NULL;
done:
    pm_warp_free(w);
    return status;
}

void pm_warp_free(struct pm_warp *w)
{
    if (w == NULL)
        return;
    laplacian_release(&w->loose);
    laplacian_release(&w->held);
    pm_free(w->on_plane);
    pm_free(w->rhs);
    pm_free(w->b);
    pm_free(w->x);
    pm_free(w);
}

/* ---- target gradients ---- */

static void multiply(const pm_lanes A[9], const pm_lanes B[9], pm_lanes out[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* E = exp(A): 12 terms of the series of A/16, squared four times (|A| up to 8: 1e-10). */
static void exponential(const pm_lanes A[9], pm_lanes E[9])
{
    pm_lanes S[9], T[9];
    for (int k = 0; k < 9; k++)
        S[k] = A[k] / 16.0;
    memset(E, 0, 9 * sizeof *E);
    for (int n = 12; n >= 0; n--) { /* Horner: E = I + S E / (n + 1) */
        multiply(S, E, T);
        for (int k = 0; k < 9; k++)
            E[k] = T[k] / (n + 1.0) + (k % 4 == 0 ? 1.0 : 0.0);
    }
    for (int n = 0; n < 4; n++) {
        multiply(E, E, T);
        memcpy(E, T, sizeof T);
    }
}

/* H = G F^-1 */
static void spatial(const pm_lanes G[9], const pm_lanes F[9], pm_lanes H[9])
{
    pm_lanes C[9], j = 1.0 / pm_lanes_cofactor(F, C); /* F^-1_Ji = C_iJ / J */
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            H[3 * i + k] = j * (G[3 * i] * C[3 * k] + G[3 * i + 1] * C[3 * k + 1] +
                                G[3 * i + 2] * C[3 * k + 2]);
}

/* T = exp(A) F - I at point q */
static void turned(const struct pm_element *el, int q, const pm_lanes *u, const pm_lanes *d1,
                   const pm_lanes *d2, pm_lanes T[9])
{
    int npe = el->type->npe;
    const pm_lanes *dN = el->dN + 3 * npe * q;
    pm_lanes F[9], G[9], A[9], E[9];
    pm_lanes_gradient(npe, u, dN, F);
    for (int i = 0; i < 3; i++)
        F[4 * i] += 1.0;
    pm_lanes_gradient(npe, d1, dN, G);
    spatial(G, F, A);
    if (d2 != NULL) {
        pm_lanes H2[9], AA[9];
        multiply(A, A, AA);
        pm_lanes_gradient(npe, d2, dN, G);
        spatial(G, F, H2);
        for (int k = 0; k < 9; k++)
            A[k] += 0.5 * (H2[k] - AA[k]);
    }
    exponential(A, E);
    multiply(E, F, T);
    for (int i = 0; i < 3; i++)
        T[4 * i] -= 1.0;
}

/* f_a += w T grad N_a at point q of the elements of the model */
static void add_target(const struct pm_element *el, int q, const pm_lanes T[9], pm_lanes *f)
{
    const pm_lanes *dN = el->dN + 3 * el->type->npe * q;
    for (int a = 0; a < el->type->npe; a++)
        for (int i = 0; i < 3; i++)
            f[3 * a + i] += el->w[q] * (T[3 * i] * dN[3 * a] + T[3 * i + 1] * dN[3 * a + 1] +
                                        T[3 * i + 2] * dN[3 * a + 2]);
}

static void scatter(struct pm_warp *w, ptrdiff_t batch, const pm_lanes *f)
{
    const struct pm_model *m = w->m;
    ptrdiff_t npe = m->space.type->npe;
    for (int l = 0; l < pm_model_lanes(m, batch); l++)
        for (ptrdiff_t a = 0; a < npe; a++)
            for (int i = 0; i < 3; i++)
                w->b[3 * (ptrdiff_t)m->space.tet[npe * (PM_LANES * batch + l) + a] + i] +=
                    f[3 * a + i][l];
}

static void add_targets(struct pm_warp *w, const struct pm_config *c, const double *du1,
                        const double *du2)
{
    const struct pm_model *m = w->m;
    memset(w->b, 0, 3 * (size_t)m->nn * sizeof *w->b);
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch);
        pm_lanes u[VALUES], d1[VALUES], d2[VALUES], f[VALUES], T[9];
        memset(f, 0, sizeof f);
        pm_model_gather(m, batch, c->u, u);
        pm_model_gather(m, batch, du1, d1);
        if (du2 != NULL)
            pm_model_gather(m, batch, du2, d2);
        for (int q = 0; q < el.type->nq; q++) {
            turned(&el, q, u, d1, du2 != NULL ? d2 : NULL, T);
            add_target(&el, q, T, f);
        }
        scatter(w, batch, f);
    }
}

/* The elements of the batch in the shape X. */
static enum pm_status earlier_batch(const struct pm_model *m, ptrdiff_t batch, const double *X,
                                    pm_lanes *dN, pm_lanes *weight, pm_lanes *phi,
                                    struct pm_err *err)
{
    const struct pm_element_type *t = m->space.type;
    for (int l = 0; l < PM_LANES; l++) {
        double x[VALUES];
        ptrdiff_t e = PM_LANES * batch + l < m->space.ne ? PM_LANES * batch + l : m->space.ne - 1;
        pm_gather(m->space.tet + t->npe * e, t->npe, X, x);
        if (!(pm_element_geometry(t, x, l, dN, weight, phi) > 0.0))
            return pm_fail(err, PM_INPUT, "element %td of the earlier shape is inverted", e);
    }
    return PM_OK;
}

static enum pm_status add_earlier(struct pm_warp *w, const double *X, const double *u,
                                  pm_lanes *mixed, struct pm_err *err)
{
    const struct pm_model *m = w->m;
    const struct pm_element_type *t = m->space.type;
    pm_lanes dN[VALUES * PM_MOST_POINTS], weight[PM_MOST_POINTS],
        phi[PM_MOST_MODES * PM_MOST_POINTS], still[VALUES];
    memset(w->b, 0, 3 * (size_t)m->nn * sizeof *w->b);
    memset(still, 0, sizeof still);
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch), before = el;
        pm_lanes v[VALUES], f[VALUES], T[9];
        enum pm_status status = earlier_batch(m, batch, X, dN, weight, phi, err);
        if (status != PM_OK)
            return status;
        before.dN = dN;
        before.w = weight;
        before.phi = phi;
        memset(f, 0, sizeof f);
        pm_model_gather(m, batch, u, v);
        pm_element_mixed(&before, v, still, mixed + PM_MIXED * t->nq * batch);
        for (int q = 0; q < t->nq; q++) {
            pm_lanes_gradient(t->npe, v, dN + 3 * t->npe * q, T);
            add_target(&el, q, T, f);
        }
        scatter(w, batch, f);
    }
    return PM_OK;
}

/* ---- positions ---- */

/* rhs -= L x of the given values (w->x, 0 at free ones). */
static void subtract_given(const struct pm_warp *w, const struct laplacian *l)
{
    const struct pm_model *m = w->m;
    ptrdiff_t npe = m->space.type->npe, n = l->pattern.n;
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch);
        pm_lanes L[PM_MOST_NODES * (PM_MOST_NODES + 1) / 2];
        int any = 0;
        for (int k = 0; k < pm_model_lanes(m, batch); k++)
            for (ptrdiff_t a = 0; a < npe; a++)
                any |= m->kind[m->space.tet[npe * (PM_LANES * batch + k) + a]] == PM_NODE_TIP;
        if (!any)
            continue;
        laplace_batch(&el, L);
        for (int k = 0; k < pm_model_lanes(m, batch); k++) {
            const int32_t *t = m->space.tet + npe * (PM_LANES * batch + k);
            for (ptrdiff_t a = 0; a < npe; a++)
                for (ptrdiff_t b = 0; b < npe; b++) {
                    ptrdiff_t j = l->pattern.eq[t[a]],
                              at = a < b ? b * (b + 1) / 2 + a : a * (a + 1) / 2 + b;
                    for (int i = 0; i < 3 && j >= 0 && m->kind[t[b]] == PM_NODE_TIP; i++)
                        w->rhs[n * i + j] -= L[at][k] * w->x[3 * (ptrdiff_t)t[b] + i];
                }
        }
    }
}

static enum pm_status solve(struct pm_warp *w, struct laplacian *l, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_model *m = w->m;
    ptrdiff_t n = l->pattern.n;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && l->pattern.eq[a] >= 0; i++)
            w->rhs[n * i + l->pattern.eq[a]] = w->b[3 * a + i];
    if (l == &w->held)
        subtract_given(w, l);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && l->pattern.eq[a] >= 0; i++)
            if (given(w, l, a, i))
                w->rhs[n * i + l->pattern.eq[a]] = 0.0;
    for (ptrdiff_t i = 0; i < 3; i += 3 / w->axes)
        PM_TRY(pm_cholesky_solve(l->factor[i], w->rhs + n * i, 3 / w->axes, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && l->pattern.eq[a] >= 0; i++)
            w->x[3 * a + i] = w->rhs[n * i + l->pattern.eq[a]];
done:
    return status;
}

/* Unit quaternion of the rotation that takes r to y best, sum r_i y_j = B (Horn 1987). */
static enum pm_status best_rotation(const double B[9], double quaternion[4], struct pm_err *err)
{
    double N[16] = {B[0] + B[4] + B[8], 0, 0,           0,           B[5] - B[7],
                    B[0] - B[4] - B[8], 0, 0,           B[6] - B[2], B[1] + B[3],
                    B[4] - B[0] - B[8], 0, B[1] - B[3], B[6] + B[2], B[5] + B[7],
                    B[8] - B[0] - B[4]};
    double value[4], vector[16];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++)
            N[4 * j + i] = N[4 * i + j];
    gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(4);
    if (space == NULL)
        return pm_fail(err, PM_SYSTEM, "out of memory");
    gsl_matrix_view A = gsl_matrix_view_array(N, 4, 4), V = gsl_matrix_view_array(vector, 4, 4);
    gsl_vector_view e = gsl_vector_view_array(value, 4);
    gsl_eigen_symmv(&A.matrix, &e.vector, &V.matrix, space);
    gsl_eigen_symmv_sort(&e.vector, &V.matrix, GSL_EIGEN_SORT_VAL_DESC);
    gsl_eigen_symmv_free(space);
    for (int i = 0; i < 4; i++)
        quaternion[i] = vector[4 * i];
    return PM_OK;
}

/* U of the rigid motion nearest to that of the loose end-effector nodes; of all rotation vectors
 * of that rotation the one nearest to the given. */
static enum pm_status fit_tip(const struct pm_warp *w, double U[6], struct pm_err *err)
{
    const struct pm_model *m = w->m;
    double r[3] = {0}, y[3] = {0}, B[9] = {0}, n = 0.0, q[4] = {1}, near[3];
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && m->kind[a] == PM_NODE_TIP && w->loose.pattern.eq[a] >= 0; i++) {
            n += i == 0;
            r[i] += m->arm[3 * a + i];
            y[i] += m->arm[3 * a + i] + w->x[3 * a + i];
        }
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 9 && m->kind[a] == PM_NODE_TIP && w->loose.pattern.eq[a] >= 0; i++)
            B[i] += (m->arm[3 * a + i / 3] - r[i / 3] / n) *
                    (m->arm[3 * a + i % 3] + w->x[3 * a + i % 3] - y[i % 3] / n);
    enum pm_status status = best_rotation(B, q, err);
    if (status != PM_OK)
        return status;
    double s = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]), angle = 2.0 * atan2(s, q[0]);
    const double pi = acos(-1.0);
    memcpy(near, U + 3, sizeof near);
    for (int i = 0; i < 3; i++)
        U[3 + i] = s > 1e-12 ? angle * q[1 + i] / s : 0.0;
    if (s > 1e-12) { /* turns along the axis */
        double along = (near[0] * q[1] + near[1] * q[2] + near[2] * q[3]) / s,
               turns = round((along - angle) / (2.0 * pi));
        for (int i = 0; i < 3; i++)
            U[3 + i] += 2.0 * pi * turns * q[1 + i] / s;
    }
    struct pm_rotation rot;
    double Rr[3];
    pm_rotation_at(U + 3, 0, &rot);
    pm_mul3(rot.R, r, Rr);
    for (int i = 0; i < 3; i++)
        U[i] = (y[i] - Rr[i]) / n;
    return PM_OK;
}

/* Positions nearest to the targets in w->b. */
static enum pm_status reconstruct(struct pm_warp *w, struct pm_config *to, struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = w->m;
    memset(w->x, 0, 3 * (size_t)m->nn * sizeof *w->x);
    PM_TRY(solve(w, &w->loose, err));
    if (m->tail > 0) {
        PM_TRY(fit_tip(w, to->U, err));
        for (int i = 0; i < 6; i++)
            to->U[i] = m->fixed[m->nq - 6 + i] ? 0.0 : to->U[i];
        pm_model_place_tip(m, to);
        for (ptrdiff_t a = 0; a < m->nn; a++)
            for (int i = 0; i < 3 && m->kind[a] == PM_NODE_TIP; i++)
                w->x[3 * a + i] = to->u[3 * a + i];
        PM_TRY(solve(w, &w->held, err));
    }
    memcpy(to->u, w->x, 3 * (size_t)m->nn * sizeof *to->u);
done:
    return status;
}

enum pm_status pm_warp_move(struct pm_warp *w, const struct pm_config *c, const double *du1,
                            const double *du2, struct pm_config *to, struct pm_err *err)
{
    clock_t start = clock();
    add_targets(w, c, du1, du2);
    memcpy(to->U, c->U, sizeof to->U);
    enum pm_status status = reconstruct(w, to, err);
    pm_cost_add(&w->m->cost.warp, start);
    return status;
}

enum pm_status pm_warp_carry(struct pm_warp *w, const double *X, const double *u,
                             struct pm_config *to, pm_lanes *mixed, struct pm_err *err)
{
    clock_t start = clock();
    enum pm_status status = add_earlier(w, X, u, mixed, err);
    if (status == PM_OK)
        status = reconstruct(w, to, err);
    pm_cost_add(&w->m->cost.warp, start);
    return status;
}

enum pm_status pm_warp_fit(struct pm_warp *w, const pm_lanes *gradient, struct pm_config *to,
                           struct pm_err *err)
{
    clock_t start = clock();
    const struct pm_model *m = w->m;
    const ptrdiff_t nq = m->space.type->nq;
    memset(w->b, 0, 3 * (size_t)m->nn * sizeof *w->b);
    for (ptrdiff_t batch = 0; batch < m->nb; batch++) {
        struct pm_element el = pm_model_batch(m, batch);
        pm_lanes f[VALUES];
        memset(f, 0, sizeof f);
        for (ptrdiff_t q = 0; q < nq; q++)
            add_target(&el, (int)q, gradient + 9 * (nq * batch + q), f);
        scatter(w, batch, f);
    }
    const enum pm_status status = reconstruct(w, to, err);
    pm_cost_add(&w->m->cost.warp, start);
    return status;
}
