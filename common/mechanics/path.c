#include "common/mechanics/path.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tensor.h"

/* Of residuals: a predictor needs no more. */
static const double first_tolerance = 1e-4, second_tolerance = 1e-3;

/* Nodal fields along the path. */
struct fields {
    double *load; /* sum_r dp_r dV_r/dx            (nn x 3) */
    double *x1;   /* first map of dq               (nn x 3) */
    double *c;    /* second map R_ij v_i v_j r_a, tip (nn x 3) */
    double *K1;   /* K_x x1 - load                 (nn x 3) */
    double *s;    /* f3 + K_x c - 2 sum dp d2V x1  (nn x 3) */
};

static void load_field(const struct pm_model *m, const struct pm_config *cfg, const double *dp,
                       struct fields *f)
{
    for (ptrdiff_t r = 0; r < m->mesh->nc; r++) {
        if (dp[r] == 0.0)
            continue;
        pm_model_volume_gradient(m, cfg, r, f->s);
        for (ptrdiff_t k = 0; k < 3 * m->nn; k++)
            f->load[k] += dp[r] * f->s[k];
    }
}

/* Rows of the rotation: what the second and third derivatives of R add. */
static void add_rotation_rows(const struct pm_model *m, const struct pm_rotation *rot,
                              const double *t, const struct fields *k, const double *f, double *q)
{
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (int i = 0; i < 3 && m->kind[a] == PM_NODE_TIP; i++) {
            double D[9] = {0}, DD[9] = {0}, y[3], z[3];
            for (int j = 0; j < 3; j++) {
                pm_axpy9(t[j], rot->Rij[i][j], D);
                for (int l = 0; l < 3; l++)
                    pm_axpy9(t[j] * t[l], rot->Rijk[i][j][l], DD);
            }
            pm_mul3(D, m->arm + 3 * a, y);
            pm_mul3(DD, m->arm + 3 * a, z);
            q[m->nq - 3 + i] += 2.0 * pm_dot3(k->K1 + 3 * a, y) + pm_dot3(f + 3 * a, z);
        }
}

static void second_order(const struct pm_model *m, const struct pm_config *cfg, const double *p,
                         const double *f, const double *dp, const double *dq, struct fields *k,
                         double *ddq)
{
    ptrdiff_t n3 = 3 * m->nn;
    struct pm_rotation rot;
    const double *t = dq + m->nq - 3;
    double D[9] = {0};
    pm_rotation_at(cfg->U + 3, 1, &rot);
    for (int i = 0; i < 3 && m->tail > 0; i++)
        for (int j = 0; j < 3; j++)
            pm_axpy9(t[i] * t[j], rot.Rij[i][j], D);
    pm_model_expand(m, cfg, dq, k->x1);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->kind[a] == PM_NODE_TIP)
            pm_mul3(D, m->arm + 3 * a, k->c + 3 * a);
    pm_model_third(m, cfg, p, k->x1, k->x1, k->s);
    pm_model_apply(m, cfg, p, k->c, k->K1);
    for (ptrdiff_t i = 0; i < n3; i++)
        k->s[i] += k->K1[i];
    for (ptrdiff_t r = 0; r < m->mesh->nc; r++)
        if (dp[r] != 0.0)
            pm_model_volume_apply(m, cfg, r, -2.0 * dp[r], k->x1, k->s);
    pm_model_reduce(m, cfg, k->s, ddq);
    if (m->tail > 0) {
        pm_model_apply(m, cfg, p, k->x1, k->K1);
        for (ptrdiff_t i = 0; i < n3; i++)
            k->K1[i] -= k->load[i];
        add_rotation_rows(m, &rot, t, k, f, ddq);
    }
    for (ptrdiff_t i = 0; i < m->nq; i++)
        ddq[i] = -ddq[i];
}

enum pm_status pm_path_derivatives(struct pm_model *m, const struct pm_config *c, const double *p,
                                   const double *f, const double *dp, double *du1, double *du2,
                                   int *definite, struct pm_err *err)
{
    enum pm_status status;
    struct fields k;
    ptrdiff_t n3 = 3 * m->nn;
    double *store = NULL, *dq = NULL, *ddq;
    PM_TRY(PM_NEW(store, 4 * n3, err));
    PM_TRY(PM_NEW(dq, 2 * m->nq, err));
    ddq = dq + m->nq;
    k = (struct fields){store, du1, store + n3, store + 2 * n3, store + 3 * n3};
    load_field(m, c, dp, &k);
    pm_model_reduce(m, c, k.load, dq);
    PM_TRY(pm_model_prepare(m, c, p, f, NULL, dq, first_tolerance, definite, err));
    if (!*definite)
        goto done;
    second_order(m, c, p, f, dp, dq, &k, ddq);
    PM_TRY(pm_model_solve(m, ddq, 1, second_tolerance, err));
    pm_model_expand(m, c, ddq, du2);
    for (ptrdiff_t i = 0; i < n3; i++)
        du2[i] += k.c[i];
done:
    pm_free(store);
    pm_free(dq);
    return status;
}
