#include "common/mechanics/adjoint.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tensor.h"

/* Of residuals where the factor is an older one. */
static const double tolerance = 1e-11;

enum pm_status pm_jacobian(struct pm_model *m, const struct pm_config *c, double scale, double *Jq,
                           double *J, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t nc = m->mesh->nc, nq = m->nq;
    double *dV = NULL;
    PM_TRY(PM_NEW(dV, 3 * m->nn, err));
    for (ptrdiff_t r = 0; r < nc; r++) {
        pm_model_volume_gradient(m, c, r, dV);
        pm_model_reduce(m, c, dV, Jq + r * nq);
        for (ptrdiff_t k = 0; k < nq; k++)
            Jq[r * nq + k] *= scale;
    }
    PM_TRY(pm_model_solve(m, Jq, nc, tolerance, err));
    for (int l = 0; l < 6; l++)
        for (ptrdiff_t r = 0; r < nc; r++)
            J[l * nc + r] = m->tail > 0 ? Jq[(r + 1) * nq - 6 + l] : 0.0;
done:
    pm_free(dV);
    return status;
}

/* Everything of one chamber with a non-zero column of b. */
struct column {
    ptrdiff_t r;
    double vt[6], Jt[6]; /* end-effector rows of v1_r and J_r */
    double *xv, *xJ;     /* first maps of v1_r and J_r               (nn x 3) */
    double *c;           /* second map R_ij v_i J_j r_a, tip only     (nn x 3) */
    double *KJ;          /* K_x xJ - scale dV_r/dx                    (nn x 3) */
    double *Kv;          /* K_x xv                                    (nn x 3) */
    double *s;           /* f3 + K_x c - scale d2V_r xv               (nn x 3) */
};

struct adjoint {
    struct pm_model *m;
    const struct pm_config *cfg;
    const double *p, *f;
    double scale;
    struct pm_rotation rot;
    ptrdiff_t n; /* columns in use */
    struct column col[PM_MAX_CHAMBERS];
    double *v;     /* q-vectors: v1 of the columns, then v2 ((n + 1) x nq) */
    double *field; /* storage of the nodal fields */
};

/* D = sum_ij M_ij v_i w_j of second derivatives */
static void contract2(const struct pm_rotation *rot, const double v[3], const double w[3],
                      double D[9])
{
    memset(D, 0, 9 * sizeof *D);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            pm_axpy9(v[i] * w[j], rot->Rij[i][j], D);
}

static void contract1(const struct pm_rotation *rot, const double v[3], double D[9])
{
    memset(D, 0, 9 * sizeof *D);
    for (int i = 0; i < 3; i++)
        pm_axpy9(v[i], rot->Ri[i], D);
}

/* The nodal fields of one column once v1_r is known. */
static void prepare_column(struct adjoint *A, struct column *k, const double *v1, const double *Jq)
{
    struct pm_model *m = A->m;
    ptrdiff_t nn = m->nn;
    double D[9];
    memcpy(k->vt, v1 + m->nq - 6, sizeof k->vt);
    memcpy(k->Jt, Jq + m->nq - 6, sizeof k->Jt);
    pm_model_expand(m, A->cfg, v1, k->xv);
    pm_model_expand(m, A->cfg, Jq, k->xJ);
    contract2(&A->rot, k->vt + 3, k->Jt + 3, D);
    for (ptrdiff_t a = 0; a < nn; a++)
        if (m->kind[a] == PM_NODE_TIP)
            pm_mul3(D, m->arm + 3 * a, k->c + 3 * a);
    pm_model_apply(m, A->cfg, A->p, k->xv, k->Kv);
    pm_model_apply(m, A->cfg, A->p, k->c, k->KJ);
    pm_model_third(m, A->cfg, A->p, k->xv, k->xJ, k->s);
    for (ptrdiff_t i = 0; i < 3 * nn; i++)
        k->s[i] += k->KJ[i];
    pm_model_volume_apply(m, A->cfg, k->r, -A->scale, k->xv, k->s);
    double *dV =
        k->KJ; /* KJ = K_x xJ - scale dV, through a sign: first dV, then the product is added */
    pm_model_volume_gradient(m, A->cfg, k->r, dV);
    for (ptrdiff_t i = 0; i < 3 * nn; i++)
        dV[i] *= -A->scale;
}

/* rhs -= D3 Pi[v1, J, .] + dK/dp_r v1 (q-vector). */
static void subtract_second_order(struct adjoint *A, const struct column *k, double *work,
                                  double *rhs)
{
    struct pm_model *m = A->m;
    pm_model_reduce(m, A->cfg, k->s, work);
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const double *r = m->arm + 3 * a;
        for (int i = 0; i < 3 && m->kind[a] == PM_NODE_TIP; i++) {
            double Dv[9] = {0}, DJ[9] = {0}, DvJ[9] = {0}, y[3], sum = 0.0;
            for (int j = 0; j < 3; j++) {
                pm_axpy9(k->vt[3 + j], A->rot.Rij[i][j], Dv);
                pm_axpy9(k->Jt[3 + j], A->rot.Rij[i][j], DJ);
                for (int l = 0; l < 3; l++)
                    pm_axpy9(k->vt[3 + j] * k->Jt[3 + l], A->rot.Rijk[i][j][l], DvJ);
            }
            pm_mul3(Dv, r, y);
            sum += pm_dot3(k->KJ + 3 * a, y);
            pm_mul3(DJ, r, y);
            sum += pm_dot3(k->Kv + 3 * a, y);
            pm_mul3(DvJ, r, y);
            sum += pm_dot3(A->f + 3 * a, y);
            work[m->nq - 3 + i] += sum;
        }
    }
    for (ptrdiff_t i = 0; i < m->nq; i++)
        rhs[i] -= work[i];
}

static enum pm_status allocate(struct adjoint *A, const double *b, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t nc = A->m->mesh->nc, size = 3 * A->m->nn;
    for (ptrdiff_t r = 0; r < nc; r++) {
        int used = 0;
        for (int l = 0; l < 6; l++)
            used |= b[l * nc + r] != 0.0;
        if (used)
            A->col[A->n++].r = r;
    }
    PM_TRY(PM_NEW(A->v, (A->n + 1) * A->m->nq, err));
    PM_TRY(PM_NEW(A->field, 6 * A->n * size, err));
    for (ptrdiff_t k = 0; k < A->n; k++) {
        double *x = A->field + k * size, **to[6] = {&A->col[k].xv, &A->col[k].xJ, &A->col[k].c,
                                                    &A->col[k].KJ, &A->col[k].Kv, &A->col[k].s};
        for (int i = 0; i < 6; i++)
            *to[i] =
                x +
                i * A->n *
                    size; /* xv of all columns adjacent, xJ likewise: pm_model_shape wants that */
    }
done:
    return status;
}

/* Solves for v1_r and v2; fills the columns. */
static enum pm_status solve_adjoints(struct adjoint *A, const double *Jq, const double a[6],
                                     const double *b, struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = A->m;
    ptrdiff_t nc = m->mesh->nc, nq = m->nq, nn3 = 3 * m->nn;
    double *v2 = A->v + A->n * nq, *work = NULL, *Kx = NULL;
    PM_TRY(PM_NEW(work, nq, err));
    PM_TRY(PM_NEW(Kx, nn3, err));
    for (ptrdiff_t k = 0; k < A->n; k++)
        for (int l = 0; l < 6; l++)
            A->v[(k + 1) * nq - 6 + l] = -b[l * nc + A->col[k].r];
    if (A->n > 0)
        PM_TRY(pm_model_solve(m, A->v, A->n, tolerance, err));
    for (int l = 0; l < 6; l++)
        v2[nq - 6 + l] = -a[l];
    for (ptrdiff_t k = 0; k < A->n; k++) {
        struct column *col = &A->col[k];
        prepare_column(A, col, A->v + k * nq, Jq + col->r * nq);
        pm_model_apply(m, A->cfg, A->p, col->xJ, Kx);
        for (ptrdiff_t i = 0; i < nn3; i++)
            col->KJ[i] += Kx[i];
        subtract_second_order(A, col, work, v2);
    }
    PM_TRY(pm_model_solve(m, v2, 1, tolerance, err));
done:
    pm_free(work);
    pm_free(Kx);
    return status;
}

/* Rows of nodes whose position depends on X explicitly: clamped, fixed components, tip. */
static void add_explicit(const struct adjoint *A, const double *s, const double *v2t, double *D,
                         double D_ref[3])
{
    const struct pm_model *m = A->m;
    double R2[9], Rv[PM_MAX_CHAMBERS][9], RJ[PM_MAX_CHAMBERS][9], RvJ[PM_MAX_CHAMBERS][9];
    contract1(&A->rot, v2t + 3, R2);
    for (ptrdiff_t k = 0; k < A->n; k++) {
        contract1(&A->rot, A->col[k].vt + 3, Rv[k]);
        contract1(&A->rot, A->col[k].Jt + 3, RJ[k]);
        contract2(&A->rot, A->col[k].vt + 3, A->col[k].Jt + 3, RvJ[k]);
    }
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        ptrdiff_t j = m->pattern.eq[a];
        if (m->kind[a] != PM_NODE_TIP) {
            for (int i = 0; i < 3; i++)
                if (j < 0 || m->fixed[3 * j + i])
                    D[3 * a + i] += s[3 * a + i];
            continue;
        }
        double t[3], y[3];
        pm_tmul3(A->rot.R, s + 3 * a, t);
        pm_tmul3(R2, A->f + 3 * a, y);
        for (int i = 0; i < 3; i++)
            t[i] += y[i];
        for (ptrdiff_t k = 0; k < A->n; k++) {
            const double *const M[3] = {Rv[k], RJ[k], RvJ[k]};
            const double *const v[3] = {A->col[k].KJ + 3 * a, A->col[k].Kv + 3 * a, A->f + 3 * a};
            for (int q = 0; q < 3; q++) {
                pm_tmul3(M[q], v[q], y);
                for (int i = 0; i < 3; i++)
                    t[i] += y[i];
            }
        }
        for (int i = 0; i < 3; i++) {
            D[3 * a + i] += t[i];
            D_ref[i] += s[3 * a + i] - t[i];
        }
    }
}

enum pm_status pm_adjoint(struct pm_model *m, const struct pm_config *c, const double *p,
                          const double *f, double scale, const double *Jq, const double a[6],
                          const double *b, double *D, double D_ref[3], struct pm_err *err)
{
    enum pm_status status;
    struct adjoint A = {.m = m, .cfg = c, .p = p, .f = f, .scale = scale};
    ptrdiff_t nn3 = 3 * m->nn;
    double *g = NULL, *s = NULL;
    pm_rotation_at(c->U + 3, 1, &A.rot);
    memset(D_ref, 0, 3 * sizeof *D_ref);
    PM_TRY(allocate(&A, b, err));
    PM_TRY(PM_NEW(g, nn3, err));
    PM_TRY(PM_NEW(s, nn3, err));
    PM_TRY(solve_adjoints(&A, Jq, a, b, err));
    const double *v2 = A.v + A.n * m->nq;
    pm_model_expand(m, c, v2, g);
    pm_model_apply(m, c, p, g, s);
    for (ptrdiff_t k = 0; k < A.n; k++)
        for (ptrdiff_t i = 0; i < nn3; i++) {
            s[i] += A.col[k].s[i];
            g[i] += A.col[k].c[i];
        }
    pm_model_shape(m, c, g, A.n, A.n > 0 ? A.col[0].xv : NULL, A.n > 0 ? A.col[0].xJ : NULL, D);
    add_explicit(&A, s, v2 + m->nq - 6, D, D_ref);
done:
    pm_free(g);
    pm_free(s);
    pm_free(A.v);
    pm_free(A.field);
    return status;
}
