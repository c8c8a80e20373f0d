#include "common/mechanics/transfer.h"

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
    double xi[3], offset[3]; /* X - Y */
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
    memcpy(p->offset, r, sizeof r);
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

/* u + (F - I) offset at the place. */
static void carry(const struct place *p, const double *u, double out[3])
{
    double y[3], D[9], B[9], d[3];
    field_at(p->m, p->e, p->m->x, p->xi, y, D);
    field_at(p->m, p->e, u, p->xi, out, B);
    if (!solve3(D, p->offset, d))
        return;
    for (int i = 0; i < 3; i++)
        out[i] += B[3 * i] * d[0] + B[3 * i + 1] * d[1] + B[3 * i + 2] * d[2];
}

static void hold(const struct pm_mesh *m, double *u)
{
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (ptrdiff_t a = 0; a < m->npf; a++) {
            double *v = u + 3 * (ptrdiff_t)m->tri[m->npf * f + a];
            const int axis = PM_FACE_SYM_X - m->tri_tag[f];
            if (m->tri_tag[f] == PM_FACE_BASE)
                memset(v, 0, 3 * sizeof *v);
            else if (axis >= 0 && axis <= 2)
                v[axis] = 0;
        }
}

enum pm_status pm_transfer(const struct pm_mesh *from, const double *u, const struct pm_mesh *to,
                           double *u_to, struct pm_err *err)
{
    enum pm_status status;
    struct pm_boxes *boxes = NULL;
    struct planes planes;
    PM_TRY(new_boxes(from, &boxes, err));
    find_planes(from, &planes);
    for (ptrdiff_t a = 0; a < to->nn; a++) {
        double X[3];
        const unsigned turned = fold(&planes, to->x + 3 * a, X);
        struct place p = {.m = from, .X = X};
        pm_boxes_nearest(boxes, X, HUGE_VAL, find_in, &p);
        carry(&p, u, u_to + 3 * a);
        for (int i = 0; i < 3; i++)
            if (turned >> i & 1)
                u_to[3 * a + i] = -u_to[3 * a + i];
    }
    hold(to, u_to);
done:
    pm_boxes_free(boxes);
    return status;
}
