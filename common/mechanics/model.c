#include "common/mechanics/model.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/cavity.h"
#include "common/mechanics/tensor.h"

void pm_gather(const int32_t *nodes, int n, const double *nodal, double *local)
{
    for (int a = 0; a < n; a++)
        memcpy(local + 3 * a, nodal + 3 * (ptrdiff_t)nodes[a], 3 * sizeof *local);
}

static void scatter_add(const int32_t *nodes, int n, double s, const double *local, double *nodal)
{
    for (int a = 0; a < n; a++)
        for (int i = 0; i < 3; i++)
            nodal[3 * (ptrdiff_t)nodes[a] + i] += s * local[3 * a + i];
}

struct pm_element pm_model_element(const struct pm_model *m, ptrdiff_t e)
{
    return (struct pm_element){&m->law, m->blend, m->dN + 120 * e, m->w + 4 * e};
}

void pm_model_face(const struct pm_model *m, const struct pm_config *c, ptrdiff_t f, double x[18])
{
    const int32_t *t = m->mesh->tri + 6 * f;
    for (int a = 0; a < 6; a++)
        for (int i = 0; i < 3; i++)
            x[3 * a + i] =
                m->mesh->x[3 * (ptrdiff_t)t[a] + i] + c->u[3 * (ptrdiff_t)t[a] + i] - m->origin[i];
}

/* ---- construction ---- */

static enum pm_status node_kinds(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *mesh = m->mesh;
    PM_TRY(PM_NEW(m->kind, mesh->nn, err));
    PM_TRY(PM_NEW(m->arm, 3 * mesh->nn, err));
    for (int pass = 0; pass < 2; pass++) /* a node of both is clamped */
        for (ptrdiff_t f = 0; f < mesh->nf; f++)
            if (mesh->tri_tag[f] == (pass ? PM_FACE_BASE : PM_FACE_TIP))
                for (int a = 0; a < 6; a++)
                    m->kind[mesh->tri[6 * f + a]] = pass ? PM_NODE_CLAMPED : PM_NODE_TIP;
    for (ptrdiff_t a = 0; a < mesh->nn; a++) {
        if (m->kind[a] == PM_NODE_TIP)
            m->tail = 6;
        for (int i = 0; i < 3; i++)
            m->arm[3 * a + i] = mesh->x[3 * a + i] - mesh->reference_point[i];
    }
done:
    return status;
}

static enum pm_status build_pattern(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *mesh = m->mesh;
    uint8_t *use = NULL, *couples = NULL;
    PM_TRY(PM_NEW(use, mesh->nn, err));
    PM_TRY(PM_NEW(couples, mesh->nn, err));
    for (ptrdiff_t a = 0; a < mesh->nn; a++)
        use[a] = m->kind[a] == PM_NODE_FREE;
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        const int32_t *t = mesh->tet + 10 * e;
        int tip = 0;
        for (int a = 0; a < 10; a++)
            tip |= m->kind[t[a]] == PM_NODE_TIP;
        for (int a = 0; a < 10 && tip; a++)
            couples[t[a]] = 1;
    }
    PM_TRY(
        pm_pattern_new(mesh->nn, mesh->ne, mesh->tet, use, couples, 3, m->tail, &m->pattern, err));
    m->nq = m->pattern.n;
    PM_TRY(PM_NEW(m->fixed, m->nq, err));
    PM_TRY(PM_NEW(m->value, m->pattern.ptr[m->nq], err));
done:
    pm_free(use);
    pm_free(couples);
    return status;
}

/* A symmetry plane e = const fixes u_e there, U_e and the two rotations about the other axes. */
static void fix_symmetry(struct pm_model *m)
{
    const struct pm_mesh *mesh = m->mesh;
    for (ptrdiff_t f = 0; f < mesh->nf; f++) {
        int axis = PM_FACE_SYM_X - mesh->tri_tag[f];
        if (axis < 0 || axis > 2)
            continue;
        m->origin[axis] = mesh->x[3 * (ptrdiff_t)mesh->tri[6 * f] + axis];
        for (int a = 0; a < 6; a++) {
            ptrdiff_t j = m->pattern.eq[mesh->tri[6 * f + a]];
            if (j >= 0)
                m->fixed[3 * j + axis] = 1;
        }
        for (int i = 0; i < 3 && m->tail > 0; i++) {
            m->fixed[m->nq - 6 + axis] = 1;
            if (i != axis)
                m->fixed[m->nq - 3 + i] = 1;
        }
    }
}

static enum pm_status element_geometry(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *mesh = m->mesh;
    PM_TRY(PM_NEW(m->dN, 120 * mesh->ne, err));
    PM_TRY(PM_NEW(m->w, 4 * mesh->ne, err));
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        double X[30];
        pm_gather(mesh->tet + 10 * e, 10, mesh->x, X);
        for (int q = 0; q < PM_TET_POINTS; q++) {
            double det = pm_tet10_gradient(X, pm_tet_xi[q], m->dN + 120 * e + 30 * q);
            if (!(det > 0.0))
                return pm_fail(
                    err, PM_INPUT,
                    "element %td has reference det dX/dxi = %g at point %d, expected > 0", e, det,
                    q);
            m->w[4 * e + q] = pm_tet_weight[q] * det;
        }
    }
done:
    return status;
}

enum pm_status pm_model_new(const struct pm_mesh *mesh, const char *element, struct pm_model **out,
                            struct pm_err *err)
{
    enum pm_status status;
    const struct pm_case *c = &mesh->pcase;
    struct pm_model *m = pm_calloc(1, sizeof *m, err);
    if (m == NULL)
        return PM_SYSTEM;
    m->mesh = mesh;
    PM_TRY(pm_law_set(&m->law, c->law, c->nlaw_parameter, c->law_parameter, c->kappa, err));
    PM_TRY(pm_element_blend(element, &m->law, &m->blend, err));
    PM_TRY(element_geometry(m, err));
    PM_TRY(node_kinds(m, err));
    PM_TRY(build_pattern(m, err));
    fix_symmetry(m);
    PM_TRY(pm_cholesky_new(m->nq, m->pattern.ptr, m->pattern.row, &m->factor, err));
    *out = m;
    m = NULL;
done:
    pm_model_free(m);
    return status;
}

void pm_model_free(struct pm_model *m)
{
    if (m == NULL)
        return;
    pm_pattern_release(&m->pattern);
    pm_cholesky_free(m->factor);
    pm_free(m->kind);
    pm_free(m->fixed);
    pm_free(m->dN);
    pm_free(m->w);
    pm_free(m->arm);
    pm_free(m->value);
    pm_free(m);
}

/* ---- configurations and maps ---- */

enum pm_status pm_config_new(const struct pm_model *m, struct pm_config *c, struct pm_err *err)
{
    *c = (struct pm_config){0};
    return PM_NEW(c->u, 3 * m->mesh->nn, err);
}

void pm_config_copy(const struct pm_model *m, const struct pm_config *from, struct pm_config *to)
{
    memmove(to->u, from->u, 3 * (size_t)m->mesh->nn * sizeof *to->u);
    memmove(to->U, from->U, sizeof to->U);
}

void pm_config_release(struct pm_config *c)
{
    pm_free(c->u);
    *c = (struct pm_config){0};
}

/* The rigid end-effector moves its nodes: u_a = t + (R - I) r_a. */
static void place_tip(const struct pm_model *m, struct pm_config *c)
{
    struct pm_rotation rot;
    pm_rotation_at(c->U + 3, 0, &rot);
    for (ptrdiff_t a = 0; a < m->mesh->nn; a++)
        if (m->kind[a] == PM_NODE_TIP) {
            double y[3];
            pm_mul3(rot.R, m->arm + 3 * a, y);
            for (int i = 0; i < 3; i++)
                c->u[3 * a + i] = c->U[i] + y[i] - m->arm[3 * a + i];
        }
}

void pm_model_move(const struct pm_model *m, const struct pm_config *from, const double *dq,
                   double s, struct pm_config *to)
{
    if (to != from)
        pm_config_copy(m, from, to);
    for (ptrdiff_t a = 0; a < m->mesh->nn; a++) {
        ptrdiff_t j = m->pattern.eq[a];
        for (int i = 0; i < 3 && j >= 0; i++)
            to->u[3 * a + i] += s * dq[3 * j + i];
    }
    if (m->tail == 0)
        return;
    for (int k = 0; k < 6; k++)
        to->U[k] += s * dq[m->nq - 6 + k];
    place_tip(m, to);
}

void pm_model_expand(const struct pm_model *m, const struct pm_config *c, const double *v,
                     double *nodal)
{
    struct pm_rotation rot;
    double D[9] = {0}; /* R_i v_i */
    const double *vt = v + m->nq - 6;
    pm_rotation_at(c->U + 3, 0, &rot);
    for (int i = 0; i < 3 && m->tail > 0; i++)
        pm_axpy9(vt[3 + i], rot.Ri[i], D);
    for (ptrdiff_t a = 0; a < m->mesh->nn; a++) {
        double *y = nodal + 3 * a;
        ptrdiff_t j = m->pattern.eq[a];
        memset(y, 0, 3 * sizeof *y);
        if (j >= 0)
            memcpy(y, v + 3 * j, 3 * sizeof *y);
        if (m->kind[a] == PM_NODE_TIP) {
            pm_mul3(D, m->arm + 3 * a, y);
            for (int i = 0; i < 3; i++)
                y[i] += vt[i];
        }
    }
}

void pm_model_reduce(const struct pm_model *m, const struct pm_config *c, const double *nodal,
                     double *q)
{
    struct pm_rotation rot;
    pm_rotation_at(c->U + 3, 0, &rot);
    memset(q, 0, (size_t)m->nq * sizeof *q);
    for (ptrdiff_t a = 0; a < m->mesh->nn; a++) {
        ptrdiff_t j = m->pattern.eq[a];
        if (j >= 0)
            memcpy(q + 3 * j, nodal + 3 * a, 3 * sizeof *q);
        for (int i = 0; i < 3 && m->kind[a] == PM_NODE_TIP; i++) {
            double y[3];
            pm_mul3(rot.Ri[i], m->arm + 3 * a, y);
            q[m->nq - 6 + i] += nodal[3 * a + i];
            q[m->nq - 3 + i] += pm_dot3(nodal + 3 * a, y);
        }
    }
    for (ptrdiff_t k = 0; k < m->nq; k++)
        if (m->fixed[k])
            q[k] = 0.0;
}

/* ---- potential, forces ---- */

/* Chamber faces point into the cavity: the volume is minus the form of their node order. */
static ptrdiff_t chamber_of(const struct pm_model *m, ptrdiff_t f)
{
    int32_t tag = m->mesh->tri_tag[f];
    return tag >= 1 ? tag - 1 : -1;
}

double pm_model_potential(const struct pm_model *m, const struct pm_config *c, const double *p,
                          double *f, double *volume, double *min_det)
{
    const struct pm_mesh *mesh = m->mesh;
    double Pi = 0.0;
    *min_det = INFINITY;
    if (f != NULL)
        memset(f, 0, 3 * (size_t)mesh->nn * sizeof *f);
    if (volume != NULL)
        memset(volume, 0, (size_t)mesh->nc * sizeof *volume);
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        struct pm_element el = pm_model_element(m, e);
        double u[30], fe[30] = {0};
        pm_gather(mesh->tet + 10 * e, 10, c->u, u);
        Pi += pm_element_energy(&el, u, f != NULL ? fe : NULL, min_det);
        if (f != NULL)
            scatter_add(mesh->tet + 10 * e, 10, 1.0, fe, f);
    }
    for (ptrdiff_t k = 0; k < mesh->nf; k++) {
        ptrdiff_t r = chamber_of(m, k);
        double x[18], g[18], V = 0.0;
        if (r < 0)
            continue;
        pm_model_face(m, c, k, x);
        pm_cavity_vec(x, x, g);
        for (int i = 0; i < 18; i++)
            V -= x[i] * g[i] / 6.0;
        Pi -= p[r] * V;
        if (volume != NULL)
            volume[r] += V;
        if (f != NULL)
            scatter_add(mesh->tri + 6 * k, 6, 0.5 * p[r], g, f);
    }
    return Pi;
}

void pm_model_volume_gradient(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                              double *nodal)
{
    memset(nodal, 0, 3 * (size_t)m->mesh->nn * sizeof *nodal);
    for (ptrdiff_t k = 0; k < m->mesh->nf; k++) {
        double x[18], g[18];
        if (chamber_of(m, k) != r)
            continue;
        pm_model_face(m, c, k, x);
        pm_cavity_vec(x, x, g);
        scatter_add(m->mesh->tri + 6 * k, 6, -0.5, g, nodal);
    }
}

void pm_model_volume_apply(const struct pm_model *m, const struct pm_config *c, ptrdiff_t r,
                           double s, const double *v, double *out)
{
    for (ptrdiff_t k = 0; k < m->mesh->nf; k++) {
        double x[18], d[18], g[18];
        if (chamber_of(m, k) != r)
            continue;
        pm_model_face(m, c, k, x);
        pm_gather(m->mesh->tri + 6 * k, 6, v, d);
        pm_cavity_vec(x, d, g);
        scatter_add(m->mesh->tri + 6 * k, 6, -s, g, out);
    }
}

void pm_model_apply(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, double *out)
{
    const struct pm_mesh *mesh = m->mesh;
    memset(out, 0, 3 * (size_t)mesh->nn * sizeof *out);
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        struct pm_element el = pm_model_element(m, e);
        double u[30], d[30], f[30] = {0};
        pm_gather(mesh->tet + 10 * e, 10, c->u, u);
        pm_gather(mesh->tet + 10 * e, 10, v, d);
        pm_element_apply(&el, u, d, f);
        scatter_add(mesh->tet + 10 * e, 10, 1.0, f, out);
    }
    for (ptrdiff_t r = 0; r < mesh->nc; r++)
        pm_model_volume_apply(m, c, r, -p[r], v, out);
}

void pm_model_third(const struct pm_model *m, const struct pm_config *c, const double *p,
                    const double *v, const double *w, double *out)
{
    const struct pm_mesh *mesh = m->mesh;
    memset(out, 0, 3 * (size_t)mesh->nn * sizeof *out);
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        struct pm_element el = pm_model_element(m, e);
        double u[30], d[30], g[30], f[30] = {0};
        pm_gather(mesh->tet + 10 * e, 10, c->u, u);
        pm_gather(mesh->tet + 10 * e, 10, v, d);
        pm_gather(mesh->tet + 10 * e, 10, w, g);
        pm_element_third(&el, u, d, g, f);
        scatter_add(mesh->tet + 10 * e, 10, 1.0, f, out);
    }
    for (ptrdiff_t k = 0; k < mesh->nf; k++) {
        ptrdiff_t r = chamber_of(m, k);
        double d[18], g[18], f[18];
        if (r < 0 || p[r] == 0.0)
            continue;
        pm_gather(mesh->tri + 6 * k, 6, v, d);
        pm_gather(mesh->tri + 6 * k, 6, w, g);
        pm_cavity_vec(d, g, f);
        scatter_add(mesh->tri + 6 * k, 6, p[r], f, out);
    }
}

void pm_model_shape(const struct pm_model *m, const struct pm_config *c, const double *g,
                    ptrdiff_t n, const double *v, const double *h, double *D)
{
    enum { MOST = 8 };
    const struct pm_mesh *mesh = m->mesh;
    memset(D, 0, 3 * (size_t)mesh->nn * sizeof *D);
    for (ptrdiff_t e = 0; e < mesh->ne; e++) {
        struct pm_element el = pm_model_element(m, e);
        const int32_t *t = mesh->tet + 10 * e;
        double u[30], ge[30], ve[30 * MOST], he[30 * MOST], De[30] = {0};
        pm_gather(t, 10, c->u, u);
        pm_gather(t, 10, g, ge);
        for (ptrdiff_t k = 0; k < n && k < MOST; k++) {
            pm_gather(t, 10, v + 3 * k * mesh->nn, ve + 30 * k);
            pm_gather(t, 10, h + 3 * k * mesh->nn, he + 30 * k);
        }
        pm_element_shape(&el, u, ge, (int)n, ve, he, De);
        scatter_add(t, 10, 1.0, De, D);
    }
}

void pm_model_pressure(const struct pm_model *m, const struct pm_config *c, const double *du,
                       double *pressure)
{
    for (ptrdiff_t e = 0; e < m->mesh->ne; e++) {
        struct pm_element el = pm_model_element(m, e);
        double u[30], d[30];
        pm_gather(m->mesh->tet + 10 * e, 10, c->u, u);
        pm_gather(m->mesh->tet + 10 * e, 10, du, d);
        pm_element_pressure(&el, u, d, pressure + 4 * e);
    }
}
