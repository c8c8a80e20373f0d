#include "common/mechanics/model.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/mechanics/tensor.h"

/* ---- construction ---- */

static enum pm_status node_kinds(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_mesh *mesh = m->mesh;
    PM_TRY(PM_NEW(m->kind, m->nn, err));
    PM_TRY(PM_NEW(m->arm, 3 * m->nn, err));
    for (int pass = 0; pass < 2; pass++) /* a node of both is clamped */
        for (ptrdiff_t f = 0; f < mesh->nf; f++)
            if (mesh->tri_tag[f] == (pass ? PM_FACE_BASE : PM_FACE_TIP))
                for (int a = 0; a < mesh->npf; a++)
                    m->kind[mesh->tri[mesh->npf * f + a]] = pass ? PM_NODE_CLAMPED : PM_NODE_TIP;
    for (ptrdiff_t f = 0; f < mesh->nf && m->cavity.n == 7; f++)
        if (mesh->tri_tag[f] == PM_FACE_BASE || mesh->tri_tag[f] == PM_FACE_TIP)
            m->kind[m->space.tri[7 * f + 6]] = PM_NODE_CLAMPED; /* rigid faces have no bubble */
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (m->kind[a] == PM_NODE_TIP)
            m->tail = 6;
        for (int i = 0; i < 3; i++)
            m->arm[3 * a + i] = m->space.x[3 * a + i] - mesh->reference_point[i];
    }
done:
    return status;
}

static enum pm_status build_pattern(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t npe = m->space.type->npe;
    uint8_t *use = NULL, *couples = NULL;
    PM_TRY(PM_NEW(use, m->nn, err));
    PM_TRY(PM_NEW(couples, m->nn, err));
    for (ptrdiff_t e = 0; e < m->space.ne; e++) {
        const int32_t *t = m->space.tet + npe * e;
        int tip = 0;
        for (ptrdiff_t a = 0; a < npe; a++) {
            use[t[a]] = m->kind[t[a]] == PM_NODE_FREE;
            tip |= m->kind[t[a]] == PM_NODE_TIP;
        }
        for (ptrdiff_t a = 0; a < npe && tip; a++)
            couples[t[a]] = 1;
    }
    PM_TRY(pm_pattern_new(&(struct pm_pattern_source){m->nn, m->space.ne, npe, m->space.tet, use,
                                                      couples, 3, m->tail, NULL},
                          &m->pattern, err));
    m->nq = m->pattern.n;
    PM_TRY(PM_NEW(m->fixed, m->nq, err));
    PM_TRY(PM_NEW(m->value, m->pattern.ptr[m->nq], err));
done:
    pm_free(use);
    pm_free(couples);
    return status;
}

/* Places of the blocks of every element, found once. */
static enum pm_status find_slots(struct pm_model *m, struct pm_err *err)
{
    enum pm_status status;
    const struct pm_pattern *p = &m->pattern;
    ptrdiff_t npe = m->space.type->npe;
    struct pm_slot *s;
    PM_TRY(PM_NEW(m->slot, m->space.ne * npe * (npe + 1) / 2, err));
    s = m->slot;
    for (ptrdiff_t e = 0; e < m->space.ne; e++)
        for (ptrdiff_t b = 0; b < npe; b++)
            for (ptrdiff_t a = 0; a <= b; a++, s++) {
                const int32_t *t = m->space.tet + npe * e;
                ptrdiff_t i = p->eq[t[a]], j = p->eq[t[b]];
                s->at =
                    m->kind[t[a]] == PM_NODE_CLAMPED || m->kind[t[b]] == PM_NODE_CLAMPED ? -1 : -2;
                if (i < 0 || j < 0)
                    continue;
                s->transposed = i < j;
                ptrdiff_t column = i < j ? i : j;
                s->at = pm_pattern_block(p, i < j ? j : i, column, 0);
                s->height = (int32_t)(p->ptr[3 * column + 1] - p->ptr[3 * column]);
            }
done:
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
        const int32_t *t = m->space.tri + m->cavity.n * f;
        m->origin[axis] = mesh->x[3 * (ptrdiff_t)t[0] + axis];
        for (int a = 0; a < m->cavity.n; a++) {
            ptrdiff_t j = m->pattern.eq[t[a]];
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
    const struct pm_element_type *t = m->space.type;
    PM_TRY(PM_NEW_LANES(m->dN, 3 * m->nb * t->nq * t->npe, err));
    PM_TRY(PM_NEW_LANES(m->w, m->nb * t->nq, err));
    PM_TRY(PM_NEW_LANES(m->phi, m->nb * t->modes * t->nq, err));
    for (ptrdiff_t k = 0; k < PM_LANES * m->nb; k++) {
        double X[3 * PM_MOST_NODES];
        ptrdiff_t b = k / PM_LANES, e = k < m->space.ne ? k : m->space.ne - 1;
        pm_gather(m->space.tet + t->npe * e, t->npe, m->space.x, X);
        double det = pm_element_geometry(t, X, (int)(k % PM_LANES), m->dN + 3 * t->nq * t->npe * b,
                                         m->w + t->nq * b, m->phi + t->modes * t->nq * b);
        if (!(det > 0.0))
            return pm_fail(err, PM_INPUT,
                           "element %td has reference det dX/dxi = %g at a quadrature point, "
                           "expected > 0",
                           e, det);
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
    const struct pm_element_type *type;
    clock_t start = clock();
    m->mesh = mesh;
    PM_TRY(pm_element_type(element, mesh, &type, err));
    PM_TRY(pm_space_new(mesh, type, &m->space, err));
    m->nn = m->space.nn;
    m->nb = (mesh->ne + PM_LANES - 1) / PM_LANES;
    pm_cavity_set(&m->cavity, type->npf);
    PM_TRY(pm_law_set(&m->law, c->law, c->nlaw_parameter, c->law_parameter, c->kappa, err));
    m->blend = pm_element_blend(type, &m->law);
    PM_TRY(element_geometry(m, err));
    PM_TRY(node_kinds(m, err));
    PM_TRY(build_pattern(m, err));
    PM_TRY(find_slots(m, err));
    fix_symmetry(m);
    PM_TRY(pm_cholesky_new(m->nq, m->pattern.ptr, m->pattern.row, &m->factor, err));
    pm_cost_add(&m->cost.order, start);
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
    pm_space_release(&m->space);
    pm_free(m->slot);
    pm_free(m->dN);
    pm_free(m->w);
    pm_free(m->phi);
    pm_free(m->arm);
    pm_free(m->value);
    pm_free(m);
}

void pm_cost_add(double *cost, clock_t start)
{
    *cost += (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* ---- configurations and maps ---- */

enum pm_status pm_config_new(const struct pm_model *m, struct pm_config *c, struct pm_err *err)
{
    *c = (struct pm_config){0};
    return PM_NEW(c->u, 3 * m->nn, err);
}

void pm_config_copy(const struct pm_model *m, const struct pm_config *from, struct pm_config *to)
{
    memmove(to->u, from->u, 3 * (size_t)m->nn * sizeof *to->u);
    memmove(to->U, from->U, sizeof to->U);
}

void pm_config_release(struct pm_config *c)
{
    pm_free(c->u);
    *c = (struct pm_config){0};
}

/* The rigid end-effector moves its nodes: u_a = t + (R - I) r_a. */
void pm_model_place_tip(const struct pm_model *m, struct pm_config *c)
{
    struct pm_rotation rot;
    pm_rotation_at(c->U + 3, 0, &rot);
    for (ptrdiff_t a = 0; a < m->nn; a++)
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
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        ptrdiff_t j = m->pattern.eq[a];
        for (int i = 0; i < 3 && j >= 0; i++)
            to->u[3 * a + i] += s * dq[3 * j + i];
    }
    if (m->tail == 0)
        return;
    for (int k = 0; k < 6; k++)
        to->U[k] += s * dq[m->nq - 6 + k];
    pm_model_place_tip(m, to);
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
    for (ptrdiff_t a = 0; a < m->nn; a++) {
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
    for (ptrdiff_t a = 0; a < m->nn; a++) {
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
