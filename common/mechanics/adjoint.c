#include "common/mechanics/adjoint.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/hadamard.h"
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

enum pm_status pm_compliance(const struct pm_model *m, const struct pm_config *c, const double *Jq,
                             double *C, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t nc = m->mesh->nc, nq = m->nq;
    double *dV = NULL, *g = NULL;
    PM_TRY(PM_NEW(dV, 3 * m->nn, err));
    PM_TRY(PM_NEW(g, nq, err));
    for (ptrdiff_t r = 0; r < nc; r++) {
        pm_model_volume_gradient(m, c, r, dV);
        pm_model_reduce(m, c, dV, g);
        for (ptrdiff_t s = 0; s < nc; s++)
            C[nc * r + s] = pm_dot(nq, g, Jq + s * nq);
    }
done:
    pm_free(dV);
    pm_free(g);
    return status;
}

/* One function and one chamber s of its dw/dJ_.s and dw/dC_.s. */
struct column {
    ptrdiff_t s;
    const struct pm_objective *w;
    double vt[6], Jt[6]; /* end-effector rows of v1_s and J_s */
    double *xv, *xJ;     /* first maps of v1_s and J_s                         (nn x 3) */
    double *c;           /* second map R_ij v_i J_j r_a, tip only              (nn x 3) */
    double *KJ;          /* K_x xJ - scale dV_s/dx                             (nn x 3) */
    double *Kv;          /* K_x xv + sum_r C_rs dV_r/dx                        (nn x 3) */
    double *f3;          /* D3 Pi + K_x c - scale d2V_s xv + sum_r C_rs d2V_r xJ (nn x 3) */
};

enum { FIELDS = 6 };

struct adjoint {
    const struct pm_adjoint_at *at;
    struct pm_rotation rot;
    ptrdiff_t n;        /* functions */
    ptrdiff_t *first;   /* columns of function k are first[k] .. first[k + 1] - 1 (n + 1) */
    struct column *col; /* those that are not 0, by function */
    double *v;          /* q-vectors: v1 of the columns, then v2 of the functions */
    double *field;      /* storage of the nodal fields */
    double *dV;         /* dV_r/dx (nc x nn x 3), NULL where no function needs it */
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

/* y += s x of nodal fields */
static void add(const struct pm_model *m, double s, const double *x, double *y)
{
    for (ptrdiff_t i = 0; s != 0.0 && i < 3 * m->nn; i++)
        y[i] += s * x[i];
}

/* ---- which columns there are ---- */

static int is_used(const struct pm_objective *w, ptrdiff_t s)
{
    int used = 0;
    for (int l = 0; l < 6; l++)
        used |= w->J[l][s] != 0.0;
    for (int r = 0; r < PM_MAX_CHAMBERS; r++)
        used |= w->C[r][s] != 0.0;
    return used;
}

static int needs_volumes(const struct pm_objective *w, ptrdiff_t nc)
{
    int used = 0;
    for (ptrdiff_t r = 0; r < nc; r++) {
        used |= w->V[r] != 0.0;
        for (ptrdiff_t s = 0; s < nc; s++)
            used |= w->C[r][s] != 0.0;
    }
    return used;
}

static enum pm_status allocate(struct adjoint *A, const struct pm_objective *w, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_model *m = A->at->m;
    ptrdiff_t nc = m->mesh->nc, size = 3 * m->nn, n = 0;
    int volumes = 0;
    PM_TRY(PM_NEW(A->first, A->n + 1, err));
    PM_TRY(PM_NEW(A->col, A->n * nc, err));
    for (ptrdiff_t k = 0; k < A->n; k++) {
        for (ptrdiff_t s = 0; s < nc; s++)
            if (is_used(&w[k], s))
                A->col[n++] = (struct column){.s = s, .w = &w[k]};
        A->first[k + 1] = n;
        volumes |= needs_volumes(&w[k], nc);
    }
    PM_TRY(PM_NEW(A->v, (n + A->n) * m->nq, err));
    PM_TRY(PM_NEW(A->field, FIELDS * n * size, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        struct column *c = &A->col[k];
        double **to[FIELDS] = {&c->xv, &c->xJ, &c->c, &c->KJ, &c->Kv, &c->f3};
        for (int i = 0; i < FIELDS; i++) /* xv of a function's columns adjacent, xJ likewise */
            *to[i] = A->field + (i * n + k) * size;
    }
    if (volumes)
        PM_TRY(PM_NEW(A->dV, nc * size, err));
    for (ptrdiff_t r = 0; r < nc && volumes; r++)
        pm_model_volume_gradient(m, A->at->c, r, A->dV + r * size);
done:
    return status;
}

/* ---- adjoint equations ---- */

/* K v1_s = -Q(dw/dJ_.s) - sum_r C_rs T^T dV_r/dx, all columns at once. */
static enum pm_status solve_first(struct adjoint *A, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_model *m = A->at->m;
    ptrdiff_t nq = m->nq, n = A->first[A->n];
    double *sum = NULL;
    PM_TRY(PM_NEW(sum, 3 * m->nn, err));
    for (ptrdiff_t k = 0; k < n; k++) {
        const struct column *c = &A->col[k];
        double *v = A->v + k * nq;
        if (A->dV != NULL) {
            memset(sum, 0, 3 * (size_t)m->nn * sizeof *sum);
            for (ptrdiff_t r = 0; r < m->mesh->nc; r++)
                add(m, -c->w->C[r][c->s], A->dV + 3 * r * m->nn, sum);
            pm_model_reduce(m, A->at->c, sum, v);
        }
        for (int l = 0; l < 6 && m->tail > 0; l++)
            v[nq - 6 + l] -= c->w->J[l][c->s];
    }
    if (n > 0)
        PM_TRY(pm_model_solve(m, A->v, n, tolerance, err));
done:
    pm_free(sum);
    return status;
}

/* The nodal fields of a column, from v1_s and J_s. */
static void prepare(const struct adjoint *A, struct column *k, const double *v1, const double *Jq,
                    double *work)
{
    const struct pm_adjoint_at *at = A->at;
    struct pm_model *m = at->m;
    double D[9];
    if (m->tail > 0) {
        memcpy(k->vt, v1 + m->nq - 6, sizeof k->vt);
        memcpy(k->Jt, Jq + m->nq - 6, sizeof k->Jt);
    }
    pm_model_expand(m, at->c, v1, k->xv);
    pm_model_expand(m, at->c, Jq, k->xJ);
    contract2(&A->rot, k->vt + 3, k->Jt + 3, D);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->kind[a] == PM_NODE_TIP)
            pm_mul3(D, m->arm + 3 * a, k->c + 3 * a);
    pm_model_apply(m, at->c, at->p, k->xv, k->Kv);
    pm_model_third(m, at->c, at->p, k->xv, k->xJ, k->f3);
    if (m->tail > 0) {
        pm_model_apply(m, at->c, at->p, k->c, work);
        add(m, 1.0, work, k->f3);
    }
    pm_model_volume_apply(m, at->c, k->s, -at->scale, k->xv, k->f3);
    for (ptrdiff_t r = 0; r < m->mesh->nc; r++) {
        double C = k->w->C[r][k->s];
        if (C == 0.0)
            continue;
        add(m, C, A->dV + 3 * r * m->nn, k->Kv);
        pm_model_volume_apply(m, at->c, r, C, k->xJ, k->f3);
    }
    pm_model_apply(m, at->c, at->p, k->xJ, k->KJ);
    pm_model_volume_gradient(m, at->c, k->s, work);
    add(m, -at->scale, work, k->KJ);
}

/* rhs -= the derivative by q of the column's part of the Lagrangian. */
static void subtract_second_order(const struct adjoint *A, const struct column *k, double *work,
                                  double *rhs)
{
    const struct pm_model *m = A->at->m;
    pm_model_reduce(m, A->at->c, k->f3, work);
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
            sum += pm_dot3(A->at->f + 3 * a, y);
            work[m->nq - 3 + i] += sum;
        }
    }
    for (ptrdiff_t i = 0; i < m->nq; i++)
        rhs[i] -= work[i];
}

/* K v2 = -(Q(dw/dU) + sum_r V_r T^T dV_r/dx + second-order parts of the columns), all functions at
 * once. */
static enum pm_status solve_second(struct adjoint *A, const struct pm_objective *w,
                                   struct pm_err *err)
{
    enum pm_status status;
    struct pm_model *m = A->at->m;
    ptrdiff_t nq = m->nq;
    double *v2 = A->v + A->first[A->n] * nq, *work = NULL, *field = NULL;
    PM_TRY(PM_NEW(work, nq, err));
    PM_TRY(PM_NEW(field, 3 * m->nn, err));
    for (ptrdiff_t k = 0; k < A->n; k++) {
        double *rhs = v2 + k * nq;
        for (int l = 0; l < 6 && m->tail > 0; l++)
            rhs[nq - 6 + l] = -w[k].U[l];
        for (ptrdiff_t r = 0; r < m->mesh->nc; r++)
            if (w[k].V[r] != 0.0) {
                pm_model_reduce(m, A->at->c, A->dV + 3 * r * m->nn, work);
                for (ptrdiff_t i = 0; i < nq; i++)
                    rhs[i] -= w[k].V[r] * work[i];
            }
        if (w[k].x != NULL) {
            pm_model_reduce(m, A->at->c, w[k].x, work);
            for (ptrdiff_t i = 0; i < m->nq; i++)
                rhs[i] -= work[i];
        }
        for (ptrdiff_t c = A->first[k]; c < A->first[k + 1]; c++) {
            prepare(A, &A->col[c], A->v + c * nq, A->at->Jq + A->col[c].s * nq, field);
            subtract_second_order(A, &A->col[c], work, rhs);
        }
    }
    PM_TRY(pm_model_solve(m, v2, A->n, tolerance, err));
done:
    pm_free(work);
    pm_free(field);
    return status;
}

/* ---- shape derivative ---- */

/* Rows of nodes whose position depends on X explicitly: clamped, fixed components, tip. */
static void add_explicit(const struct adjoint *A, ptrdiff_t k, const double *s, const double *v2t,
                         double *D, double D_ref[3])
{
    const struct pm_model *m = A->at->m;
    const struct column *col = A->col + A->first[k];
    ptrdiff_t n = A->first[k + 1] - A->first[k];
    double R2[9], Rv[PM_MAX_CHAMBERS][9], RJ[PM_MAX_CHAMBERS][9], RvJ[PM_MAX_CHAMBERS][9];
    contract1(&A->rot, v2t + 3, R2);
    for (ptrdiff_t c = 0; c < n; c++) {
        contract1(&A->rot, col[c].vt + 3, Rv[c]);
        contract1(&A->rot, col[c].Jt + 3, RJ[c]);
        contract2(&A->rot, col[c].vt + 3, col[c].Jt + 3, RvJ[c]);
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
        pm_tmul3(R2, A->at->f + 3 * a, y);
        for (int i = 0; i < 3; i++)
            t[i] += y[i];
        for (ptrdiff_t c = 0; c < n; c++) {
            const double *const M[3] = {Rv[c], RJ[c], RvJ[c]};
            const double *const v[3] = {col[c].KJ + 3 * a, col[c].Kv + 3 * a, A->at->f + 3 * a};
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

/* g: nodal field of v2 with the second maps; s: work. */
static enum pm_status shape_of(const struct adjoint *A, ptrdiff_t k, const struct pm_objective *w,
                               enum pm_shape_form form, double *g, double *s, double *D,
                               double D_ref[3], struct pm_err *err)
{
    const struct pm_adjoint_at *at = A->at;
    struct pm_model *m = at->m;
    const struct column *col = A->col + A->first[k];
    ptrdiff_t n = A->first[k + 1] - A->first[k];
    const double *v2 = A->v + (A->first[A->n] + k) * m->nq, none[6] = {0};
    pm_model_expand(m, at->c, v2, g);
    pm_model_apply(m, at->c, at->p, g, s);
    for (ptrdiff_t c = 0; c < n; c++) {
        add(m, 1.0, col[c].f3, s);
        add(m, 1.0, col[c].c, g);
    }
    memset(D_ref, 0, 3 * sizeof *D_ref);
    if (form == PM_SHAPE_BOUNDARY) {
        struct pm_hadamard h = {.p = at->p, .scale = at->scale, .g = g, .n = n};
        for (ptrdiff_t c = 0; c < n; c++)
            h.column[c] = (struct pm_hadamard_column){col[c].s, col[c].xv, col[c].xJ};
        return pm_hadamard(m, at->c, &h, w, D, err);
    }
    for (ptrdiff_t r = 0; r < m->mesh->nc && A->dV != NULL; r++)
        add(m, w->V[r], A->dV + 3 * r * m->nn, s);
    if (w->x != NULL)
        add(m, 1.0, w->x, s);
    pm_model_shape(m, at->c, g, n, n > 0 ? col[0].xv : NULL, n > 0 ? col[0].xJ : NULL, D);
    add_explicit(A, k, s, m->tail > 0 ? v2 + m->nq - 6 : none, D, D_ref);
    return PM_OK;
}

enum pm_status pm_adjoint(const struct pm_adjoint_at *at, ptrdiff_t n, const struct pm_objective *w,
                          enum pm_shape_form form, double *D, double *D_ref, struct pm_err *err)
{
    enum pm_status status;
    struct adjoint A = {.at = at, .n = n};
    ptrdiff_t nn3 = 3 * at->m->nn;
    double *g = NULL, *s = NULL;
    pm_rotation_at(at->c->U + 3, 1, &A.rot);
    PM_TRY(allocate(&A, w, err));
    PM_TRY(PM_NEW(g, nn3, err));
    PM_TRY(PM_NEW(s, nn3, err));
    PM_TRY(solve_first(&A, err));
    PM_TRY(solve_second(&A, w, err));
    for (ptrdiff_t k = 0; k < n; k++)
        PM_TRY(shape_of(&A, k, &w[k], form, g, s, D + k * nn3, D_ref + 3 * k, err));
done:
    pm_free(g);
    pm_free(s);
    pm_free(A.first);
    pm_free(A.col);
    pm_free(A.v);
    pm_free(A.field);
    pm_free(A.dV);
    return status;
}
