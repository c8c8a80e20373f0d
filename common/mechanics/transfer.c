#include "common/mechanics/transfer.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/boxes.h"
#include "common/mechanics/tensor.h"
#include "common/mechanics/tet10.h"

enum { ITERATIONS = 12 };
/* A point with barycentric coordinates above -INSIDE is in the element: beyond the rounding of
 * nodes on common faces. */
static const double INSIDE = 1e-9;

static const double dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* N_a and dN_a/dxi_j (npe x 3). */
static void shape(ptrdiff_t npe, const double xi[3], double *N, double *dN)
{
    const double L[4] = {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
    if (npe == 4) {
        memcpy(N, L, sizeof L);
        memcpy(dN, dL, sizeof dL);
        return;
    }
    for (int a = 0; a < 4; a++)
        N[a] = L[a] * (2 * L[a] - 1);
    for (int k = 0; k < 6; k++)
        N[4 + k] = 4 * L[pm_tet10_edge[k][0]] * L[pm_tet10_edge[k][1]];
    pm_tet10_shape_gradient(xi, dN);
}

/* v = sum_a v_a N_a and D_ij = dv_i/dxi_j of a nodal field (nn x 3) in element e at xi. */
static void field_at(const struct pm_mesh *m, ptrdiff_t e, const double *nodal, const double xi[3],
                     double v[3], double D[9])
{
    double N[10], dN[30];
    shape(m->npe, xi, N, dN);
    memset(v, 0, 3 * sizeof *v);
    memset(D, 0, 9 * sizeof *D);
    for (ptrdiff_t a = 0; a < m->npe; a++) {
        const double *w = nodal + 3 * (ptrdiff_t)m->tet[m->npe * e + a];
        for (int i = 0; i < 3; i++) {
            v[i] += w[i] * N[a];
            for (int j = 0; j < 3; j++)
                D[3 * i + j] += w[i] * dN[3 * a + j];
        }
    }
}

/* d = D^-1 r; 0 where D is singular or inverted. */
static int solve3(const double D[9], const double r[3], double d[3])
{
    double C[9];
    const double det = pm_cofactor(D, C);
    for (int i = 0; i < 3; i++)
        d[i] = (C[i] * r[0] + C[3 + i] * r[1] + C[6 + i] * r[2]) / det;
    return det > 0;
}

struct place {
    const struct pm_mesh *m;
    const double *X;
    int32_t e;
    double xi[3];
};

/* The point of element e by Newton's method, moved to the element's side: barycentric coordinates
 * below 0 become 0, the others keep their ratios. */
static double find_in(void *data, int32_t e, double best)
{
    struct place *p = data;
    double xi[3] = {0.25, 0.25, 0.25}, y[3], D[9], r[3], d[3], L[4], sum = 0, low, d2 = 0;
    for (int k = 0; k < ITERATIONS; k++) {
        double step = 0;
        field_at(p->m, e, p->m->x, xi, y, D);
        for (int i = 0; i < 3; i++)
            r[i] = p->X[i] - y[i];
        if (!solve3(D, r, d))
            break;
        for (int i = 0; i < 3; i++) {
            xi[i] = fmin(fmax(xi[i] + d[i], -4), 4);
            step = fmax(step, fabs(d[i]));
        }
        if (step < 1e-12)
            break;
    }
    L[0] = 1 - xi[0] - xi[1] - xi[2];
    memcpy(L + 1, xi, sizeof xi);
    low = fmin(fmin(L[0], L[1]), fmin(L[2], L[3]));
    for (int a = 0; a < 4; a++)
        sum += fmax(L[a], 0);
    for (int i = 0; i < 3 && low < -INSIDE; i++)
        xi[i] = fmax(xi[i], 0) / sum;
    field_at(p->m, e, p->m->x, xi, y, D);
    for (int i = 0; i < 3; i++) {
        r[i] = p->X[i] - y[i];
        d2 += r[i] * r[i];
    }
    const double distance = low < -INSIDE ? sqrt(d2) : 0;
    if (!(distance < best))
        return best;
    p->e = e;
    memcpy(p->xi, xi, sizeof xi);
    return distance;
}

/* Box of an element: quadratic edges stay within their vertices and 2 m - (a + b)/2. */
static void element_box(const struct pm_mesh *m, ptrdiff_t e, double box[6])
{
    const int32_t *t = m->tet + m->npe * e;
    for (int i = 0; i < 3; i++) {
        box[i] = HUGE_VAL;
        box[3 + i] = -HUGE_VAL;
        for (ptrdiff_t a = 0; a < m->npe; a++) {
            double v = m->x[3 * t[a] + i];
            if (a >= 4)
                v = 2 * v - 0.5 * (m->x[3 * t[pm_tet10_edge[a - 4][0]] + i] +
                                   m->x[3 * t[pm_tet10_edge[a - 4][1]] + i]);
            box[i] = fmin(box[i], v);
            box[3 + i] = fmax(box[3 + i], v);
        }
    }
}

static enum pm_status new_boxes(const struct pm_mesh *m, struct pm_boxes **boxes,
                                struct pm_err *err)
{
    enum pm_status status;
    double *box = NULL;
    PM_TRY(PM_NEW(box, 6 * m->ne, err));
    for (ptrdiff_t e = 0; e < m->ne; e++)
        element_box(m, e, box + 6 * e);
    PM_TRY(pm_boxes_new(m->ne, box, NULL, boxes, err));
done:
    pm_free(box);
    return status;
}

/* A symmetry plane across each axis: 0 none, else the side of it that the mesh is on. */
struct planes {
    int side[3];
    double at[3]; /* [mm] */
};

static void find_planes(const struct pm_mesh *m, struct planes *p)
{
    *p = (struct planes){.side = {0}};
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int axis = PM_FACE_SYM_X - m->tri_tag[f];
        if (axis < 0 || axis > 2 || p->side[axis] != 0)
            continue;
        double sum = 0;
        p->at[axis] = m->x[3 * (ptrdiff_t)m->tri[m->npf * f] + axis];
        for (ptrdiff_t a = 0; a < m->nn; a++)
            sum += m->x[3 * a + axis] - p->at[axis];
        p->side[axis] = sum < 0 ? -1 : 1;
    }
}

/* X or its image on the side of the mesh; bit i: reflected along axis i. */
static unsigned fold(const struct planes *p, const double *X, double Y[3])
{
    unsigned turned = 0;
    for (int i = 0; i < 3; i++) {
        const double off = X[i] - p->at[i];
        const int behind = p->side[i] * off < 0;
        Y[i] = behind ? p->at[i] - off : X[i];
        turned |= (unsigned)behind << i;
    }
    return turned;
}

/* G = du/dX at the place. */
static void gradient_at(const struct place *p, const double *u, double G[9])
{
    double y[3], D[9], B[9], C[9];
    field_at(p->m, p->e, p->m->x, p->xi, y, D);
    field_at(p->m, p->e, u, p->xi, y, B);
    const double det = pm_cofactor(D, C); /* D^-1_jk = C_kj / det */
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            G[3 * i + k] =
                (B[3 * i] * C[3 * k] + B[3 * i + 1] * C[3 * k + 1] + B[3 * i + 2] * C[3 * k + 2]) /
                det;
}

/* The linear function of xi nearest to values at the points of the quadrature is a sum of them with
 * weights weight_q = sum_k f_k(xi) c_kq, f = 1, xi: c = (sum_q f f^T)^-1 f_q. */
struct linear {
    int nq;
    double c[4][PM_MOST_POINTS];
};

static double monomial(int k, const double xi[3])
{
    return k == 0 ? 1 : xi[k - 1];
}

static enum pm_status linear_init(const struct pm_element_type *t, struct linear *l,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double N[16] = {0};
    gsl_matrix_view A = gsl_matrix_view_array(N, 4, 4);
    *l = (struct linear){.nq = t->nq};
    for (int q = 0; q < t->nq; q++) {
        l->c[0][q] = 1.0 / t->nq;
        for (int k = 0; k < 16; k++)
            N[k] += monomial(k / 4, t->xi[q]) * monomial(k % 4, t->xi[q]);
    }
    if (t->nq < 4)
        return PM_OK; /* the mean */
    if (gsl_linalg_cholesky_decomp1(&A.matrix) != GSL_SUCCESS)
        PM_TRY(pm_fail(err, PM_NUMERIC, "the points of element %s lie in a plane", t->name));
    for (int q = 0; q < t->nq; q++) {
        double f[4];
        gsl_vector_view v = gsl_vector_view_array(f, 4);
        for (int k = 0; k < 4; k++)
            f[k] = monomial(k, t->xi[q]);
        gsl_linalg_cholesky_svx(&A.matrix, &v.vector);
        for (int k = 0; k < 4; k++)
            l->c[k][q] = f[k];
    }
done:
    return status;
}

static void linear_weights(const struct linear *l, const double xi[3], double *weight)
{
    for (int q = 0; q < l->nq; q++) {
        weight[q] = 0;
        for (int k = 0; k < 4; k++)
            weight[q] += monomial(k, xi) * l->c[k][q];
    }
}

struct source {
    const struct pm_model *m;
    const struct pm_config *c;
    pm_lanes *mixed;
    struct pm_boxes *boxes;
    struct planes planes;
    struct linear linear;
};

/* Gradient and mixed of the source at X. */
static void look(const struct source *s, const double *X, double G[9], double S[PM_MIXED])
{
    double Y[3], weight[PM_MOST_POINTS];
    const unsigned turned = fold(&s->planes, X, Y);
    const ptrdiff_t nq = s->linear.nq;
    struct place p = {.m = s->m->mesh, .X = Y};
    pm_boxes_nearest(s->boxes, Y, HUGE_VAL, find_in, &p);
    gradient_at(&p, s->c->u, G);
    linear_weights(&s->linear, p.xi, weight);
    for (int n = 0; n < PM_MIXED; n++) {
        S[n] = 0;
        for (ptrdiff_t q = 0; q < nq; q++)
            S[n] +=
                weight[q] * s->mixed[PM_MIXED * (nq * (p.e / PM_LANES) + q) + n][p.e % PM_LANES];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if ((turned >> i ^ turned >> j) & 1)
                G[3 * i + j] = -G[3 * i + j];
    for (int n = 3; n < 6; n++) /* 12 23 13 */
        if ((turned >> n % 3 ^ turned >> (n + 1) % 3) & 1)
            S[1 + n] = -S[1 + n];
}

/* Place of point q of element e. */
static void place_of(const struct pm_model *m, ptrdiff_t e, int q, double X[3])
{
    const struct pm_mesh *mesh = m->mesh;
    const ptrdiff_t npe = m->space.type->npe < 10 ? m->space.type->npe : 10;
    double N[10], dN[30];
    shape(npe, m->space.type->xi[q], N, dN);
    memset(X, 0, 3 * sizeof *X);
    for (ptrdiff_t a = 0; a < npe; a++)
        for (int i = 0; i < 3; i++)
            X[i] += N[a] * mesh->x[3 * (ptrdiff_t)mesh->tet[mesh->npe * e + a] + i];
}

enum pm_status pm_transfer(const struct pm_model *from, const struct pm_config *c,
                           const struct pm_model *to, pm_lanes *gradient, pm_lanes *mixed,
                           struct pm_err *err)
{
    enum pm_status status;
    struct source s = {.m = from, .c = c};
    const ptrdiff_t nq = to->space.type->nq, ne = to->space.ne;
    double *still = NULL;

    PM_TRY(linear_init(from->space.type, &s.linear, err));
    PM_TRY(pm_model_mixed_new(from, &s.mixed, err));
    PM_TRY(PM_NEW(still, 3 * from->nn, err));
    pm_model_mixed(from, c, still, s.mixed);
    PM_TRY(new_boxes(from->mesh, &s.boxes, err));
    find_planes(from->mesh, &s.planes);
    for (ptrdiff_t k = 0; k < PM_LANES * to->nb * nq; k++) { /* lanes behind the last: the last */
        const ptrdiff_t e = k / nq, b = nq * (e / PM_LANES) + k % nq;
        double X[3], G[9], S[PM_MIXED];
        place_of(to, e < ne ? e : ne - 1, (int)(k % nq), X);
        look(&s, X, G, S);
        for (int i = 0; i < 9; i++)
            gradient[9 * b + i][e % PM_LANES] = G[i];
        for (int n = 0; n < PM_MIXED; n++)
            mixed[PM_MIXED * b + n][e % PM_LANES] = S[n];
    }
done:
    pm_boxes_free(s.boxes);
    pm_free(s.mixed);
    pm_free(still);
    return status;
}
