#include "common/geometry/cloud.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

enum { WIDTH = 8, STACK = 64 };

struct point {
    double x[3];
    int32_t id;
};

/* Points of a leaf side by side; behind the last ones points at infinity. */
struct leaf {
    double x[3][WIDTH], normal[3][WIDTH];
    int32_t id[WIDTH];
};

struct node {
    double x[6], normal[6]; /* lowest and highest of the places, of the normals */
};

/* Preorder: a tree of m > 1 leaves has its left part, of (m + 1) / 2 leaves, behind its root. */
struct pm_cloud {
    ptrdiff_t n, leaves;
    struct node *node;
    struct leaf *leaf;
    ptrdiff_t *leaf_of; /* leaf and place of a point: leaf * WIDTH + place (n) */
    double *ball;       /* boxes of the balls of a node, NULL without  (nodes x 6) */
    double *radius2;    /* of the points, leaf by leaf                 (leaves x WIDTH) [mm2] */
};

/* fmin and fmax are calls. */
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

static inline ptrdiff_t left_part(ptrdiff_t leaves)
{
    return (leaves + 1) / 2;
}

static inline ptrdiff_t right_child(ptrdiff_t at, ptrdiff_t leaves)
{
    return at + 2 * left_part(leaves);
}

/* Hoare's selection: the k least along the axis come first. */
static void divide(struct point *p, ptrdiff_t n, ptrdiff_t k, int axis)
{
    ptrdiff_t first = 0, last = n - 1;

    while (first < last) {
        const double pivot = p[(first + last) / 2].x[axis];
        ptrdiff_t i = first, j = last;
        while (i <= j) {
            while (p[i].x[axis] < pivot)
                i++;
            while (p[j].x[axis] > pivot)
                j--;
            if (i > j)
                break;
            const struct point swap = p[i];
            p[i++] = p[j];
            p[j--] = swap;
        }
        if (k <= j)
            last = j;
        else if (k >= i)
            first = i;
        else
            return;
    }
}

static struct node nowhere(void)
{
    struct node nd;

    for (int j = 0; j < 6; j++)
        nd.x[j] = nd.normal[j] = j < 3 ? HUGE_VAL : -HUGE_VAL;
    return nd;
}

/* Bounds grow to hold others. */
static void widen(double *bounds, const double *low, const double *high)
{
    for (int j = 0; j < 3; j++) {
        bounds[j] = lesser(bounds[j], low[j]);
        bounds[3 + j] = greater(bounds[3 + j], high[j]);
    }
}

static void fill(struct pm_cloud *c, ptrdiff_t number, const struct point *p, ptrdiff_t n,
                 const double *normal, struct node *nd)
{
    static const double none[3] = {0}, far[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    struct leaf *l = &c->leaf[number];

    for (ptrdiff_t k = 0; k < WIDTH; k++) {
        const double *x = k < n ? p[k].x : far;
        const double *m = k < n && normal != NULL ? &normal[3 * (ptrdiff_t)p[k].id] : none;
        for (int j = 0; j < 3; j++) {
            l->x[j][k] = x[j];
            l->normal[j][k] = m[j];
        }
        l->id[k] = k < n ? p[k].id : -1;
        if (k >= n)
            continue;
        widen(nd->x, x, x);
        widen(nd->normal, m, m);
        c->leaf_of[p[k].id] = number * WIDTH + k;
    }
}

static void build(struct pm_cloud *c, ptrdiff_t at, ptrdiff_t number, struct point *p, ptrdiff_t n,
                  const double *normal)
{
    const ptrdiff_t leaves = (n + WIDTH - 1) / WIDTH, left = left_part(leaves);
    struct node *nd = &c->node[at];

    *nd = nowhere();
    if (leaves == 1) {
        fill(c, number, p, n, normal, nd);
        return;
    }
    for (ptrdiff_t i = 0; i < n; i++)
        widen(nd->x, p[i].x, p[i].x);
    int axis = 0;
    for (int j = 1; j < 3; j++)
        if (nd->x[3 + j] - nd->x[j] > nd->x[3 + axis] - nd->x[axis])
            axis = j;
    divide(p, n, left * WIDTH, axis);
    build(c, at + 1, number, p, left * WIDTH, normal);
    build(c, right_child(at, leaves), number + left, p + left * WIDTH, n - left * WIDTH, normal);
    for (int k = 0; k < 2; k++) {
        const double *m = c->node[k == 0 ? at + 1 : right_child(at, leaves)].normal;
        widen(nd->normal, m, m + 3);
    }
}

enum pm_status pm_cloud_new(ptrdiff_t n, const double *x, const double *normal,
                            struct pm_cloud **cloud, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_cloud *c = NULL;
    struct point *p = NULL;

    *cloud = NULL;
    PM_TRY(PM_NEW(c, 1, err));
    c->n = n;
    c->leaves = (n + WIDTH - 1) / WIDTH;
    PM_TRY(PM_NEW(p, n, err));
    PM_TRY(PM_NEW(c->node, 2 * c->leaves, err));
    PM_TRY(PM_NEW(c->leaf, c->leaves, err));
    PM_TRY(PM_NEW(c->leaf_of, n, err));
    for (ptrdiff_t i = 0; i < n; i++) {
        p[i].id = (int32_t)i;
        memcpy(p[i].x, &x[3 * i], sizeof p[i].x);
        if (!(isfinite(p[i].x[0]) && isfinite(p[i].x[1]) && isfinite(p[i].x[2])))
            PM_TRY(pm_fail(err, PM_NUMERIC, "point %td of a surface is not finite", i));
    }
    if (n > 0)
        build(c, 0, 0, p, n, normal);
    *cloud = c;
    c = NULL;
done:
    pm_cloud_free(c);
    pm_free(p);
    return status;
}

void pm_cloud_free(struct pm_cloud *cloud)
{
    if (cloud == NULL)
        return;
    pm_free(cloud->node);
    pm_free(cloud->leaf);
    pm_free(cloud->leaf_of);
    pm_free(cloud->ball);
    pm_free(cloud->radius2);
    pm_free(cloud);
}

/* The boxes of the balls of a tree of so many leaves, from leaf `number` on. */
static void wrap(struct pm_cloud *c, ptrdiff_t at, ptrdiff_t number, ptrdiff_t leaves,
                 const double *radius)
{
    const ptrdiff_t right = right_child(at, leaves), left = left_part(leaves);
    struct node nd = nowhere();

    if (leaves > 1) {
        wrap(c, at + 1, number, left, radius);
        wrap(c, right, number + left, leaves - left, radius);
        widen(nd.x, &c->ball[6 * (at + 1)], &c->ball[6 * (at + 1) + 3]);
        widen(nd.x, &c->ball[6 * right], &c->ball[6 * right + 3]);
    }
    for (ptrdiff_t k = 0; k < WIDTH && leaves == 1; k++) {
        const struct leaf *l = &c->leaf[number];
        const double r = l->id[k] >= 0 ? radius[l->id[k]] : 0;
        const double low[3] = {l->x[0][k] - r, l->x[1][k] - r, l->x[2][k] - r};
        const double high[3] = {l->x[0][k] + r, l->x[1][k] + r, l->x[2][k] + r};
        if (l->id[k] >= 0)
            widen(nd.x, low, high);
        c->radius2[number * WIDTH + k] = l->id[k] >= 0 ? r * r : 0;
    }
    memcpy(&c->ball[6 * at], nd.x, sizeof nd.x);
}

enum pm_status pm_cloud_inflate(struct pm_cloud *cloud, const double *radius, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    PM_TRY(PM_NEW(cloud->ball, 6 * 2 * cloud->leaves, err));
    PM_TRY(PM_NEW(cloud->radius2, cloud->leaves * WIDTH, err));
    if (cloud->n > 0)
        wrap(cloud, 0, 0, cloud->leaves, radius);
done:
    return status;
}

/* Touching counts: small balls are lost in the rounding of their boxes. */
static inline int holds(const double *box, const double x[3])
{
    return (box[0] <= x[0]) & (x[0] <= box[3]) & (box[1] <= x[1]) & (x[1] <= box[4]) &
           (box[2] <= x[2]) & (x[2] <= box[5]);
}

ptrdiff_t pm_cloud_covering(const struct pm_cloud *cloud, const double x[3], int32_t *id)
{
    struct {
        ptrdiff_t at, number, leaves;
    } stack[STACK];
    ptrdiff_t found = 0;
    int top = cloud->n > 0;

    stack[0].at = stack[0].number = 0;
    stack[0].leaves = cloud->leaves;
    while (top > 0) {
        const ptrdiff_t at = stack[--top].at, leaves = stack[top].leaves;
        const ptrdiff_t number = stack[top].number, left = left_part(leaves);
        if (!holds(&cloud->ball[6 * at], x))
            continue;
        if (leaves > 1) {
            stack[top].at = right_child(at, leaves);
            stack[top].number = number + left;
            stack[top++].leaves = leaves - left;
            stack[top].at = at + 1;
            stack[top].number = number;
            stack[top++].leaves = left;
            continue;
        }
        const struct leaf *l = &cloud->leaf[number];
        double d2[WIDTH];
        for (int k = 0; k < WIDTH; k++) {
            const double d[3] = {x[0] - l->x[0][k], x[1] - l->x[1][k], x[2] - l->x[2][k]};
            d2[k] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        }
        for (int k = 0; k < WIDTH; k++)
            if (d2[k] < cloud->radius2[number * WIDTH + k])
                id[found++] = l->id[k];
    }
    return found;
}

/* Largest product of numbers from two intervals. */
static inline double most(double a, double A, double b, double B)
{
    return greater(greater(a * b, a * B), greater(A * b, A * B));
}

/* The points of a leaf that look, and the nearest of each so far: d2 <= cutoff^2. */
struct party {
    ptrdiff_t n;
    double x[WIDTH][3], normal[WIDTH][3], d2[WIDTH];
    int32_t id[WIDTH], found[WIDTH]; /* found: -1 at first */
    struct node bounds;
    double furthest; /* of d2 */
};

/* Squared distance of two boxes; infinite where nothing in them faces. */
static double node_distance2(const struct node *a, const struct node *b, const struct pm_look *q,
                             double furthest)
{
    double d2 = 0, ahead = 0, back = 0, opposite = 0;

    for (int i = 0; i < 3; i++) {
        const double e = greater(greater(b->x[i] - a->x[3 + i], a->x[i] - b->x[3 + i]), 0);
        d2 += e * e;
    }
    if (q->side == 0 || d2 > furthest)
        return d2;
    for (int i = 0; i < 3; i++) {
        const double lo = b->x[i] - a->x[3 + i], hi = b->x[3 + i] - a->x[i];
        const double n = q->side * a->normal[i], N = q->side * a->normal[3 + i];
        const double m = -q->side * b->normal[i], M = -q->side * b->normal[3 + i];
        ahead += most(lo, hi, n, N);
        back += most(lo, hi, m, M);
        opposite += most(n, N, m, M);
    }
    /* two cones about one direction: the normals are within twice their angle of opposite */
    const double c2 = q->cosine * q->cosine, least = lesser(ahead, back);
    return least < 0 || least * least < c2 * d2 || opposite < 2 * c2 - 1 ? HUGE_VAL : d2;
}

static double point_distance2(const double *x, const double *box)
{
    double d2 = 0;

    for (int i = 0; i < 3; i++) {
        const double e = greater(greater(box[i] - x[i], x[i] - box[3 + i]), 0);
        d2 += e * e;
    }
    return d2;
}

/* Squared distances of the points of a leaf from x, infinite where they are not faced. */
static void distances(const struct leaf *l, const struct pm_look *q, const double *x,
                      const double *normal, double d2[WIDTH])
{
    for (int k = 0; k < WIDTH; k++) {
        const double d[3] = {x[0] - l->x[0][k], x[1] - l->x[1][k], x[2] - l->x[2][k]};
        d2[k] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    }
    if (q->side == 0)
        return;
    double ahead[WIDTH] = {0}, back[WIDTH] = {0};
    const double c2 = q->cosine * q->cosine;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < WIDTH; k++) {
            const double d = q->side * (l->x[j][k] - x[j]);
            ahead[k] += normal[j] * d;
            back[k] -= l->normal[j][k] * d;
        }
    for (int k = 0; k < WIDTH; k++) { /* without branches: eight at a time */
        const double least = lesser(ahead[k], back[k]);
        const double shortest = greater(least, 0) * greater(least, 0);
        d2[k] = shortest > c2 * d2[k] ? d2[k] : HUGE_VAL;
    }
}

/* One of the party may take a point at this distance for its nearest. */
static void offer(struct party *p, ptrdiff_t k, const struct pm_look *q, double d2, int32_t id)
{
    const int nearer = d2 < p->d2[k] || (d2 == p->d2[k] && p->found[k] >= 0 && id < p->found[k]);

    if (!nearer || (q->accept != NULL && !q->accept(q->data, p->id[k], id)))
        return;
    p->d2[k] = d2;
    p->found[k] = id;
}

static void look_at_leaf(struct party *p, const struct leaf *l, const struct node *nd,
                         const struct pm_look *q)
{
    p->furthest = 0;
    for (ptrdiff_t k = 0; k < p->n; k++) {
        double d2[WIDTH], least = HUGE_VAL;
        if (point_distance2(p->x[k], nd->x) <= p->d2[k]) {
            distances(l, q, p->x[k], p->normal[k], d2);
            for (int i = 0; i < WIDTH; i++)
                least = lesser(least, d2[i]);
            for (int i = 0; i < WIDTH && least <= p->d2[k]; i++)
                offer(p, k, q, d2[i], l->id[i]);
        }
        p->furthest = greater(p->furthest, p->d2[k]);
    }
}

static void look_at(struct party *p, const struct pm_cloud *c, const struct pm_look *q)
{
    struct {
        ptrdiff_t at, number, leaves;
        double d2;
    } stack[STACK], next[2];
    int top = 0;

    if (c->n > 0) {
        stack[top].at = stack[top].number = 0;
        stack[top].leaves = c->leaves;
        stack[top++].d2 = 0;
    }
    while (top > 0) {
        next[0] = stack[--top];
        if (next[0].d2 > p->furthest)
            continue;
        if (next[0].leaves == 1) {
            look_at_leaf(p, &c->leaf[next[0].number], &c->node[next[0].at], q);
            continue;
        }
        const ptrdiff_t left = left_part(next[0].leaves);
        next[1].at = right_child(next[0].at, next[0].leaves);
        next[1].number = next[0].number + left;
        next[1].leaves = next[0].leaves - left;
        next[0].at++;
        next[0].leaves = left;
        for (int k = 0; k < 2; k++)
            next[k].d2 = node_distance2(&p->bounds, &c->node[next[k].at], q, p->furthest);
        const int last = next[1].d2 < next[0].d2; /* the nearer is taken first */
        if (next[!last].d2 <= p->furthest)
            stack[top++] = next[!last];
        if (next[last].d2 <= p->furthest)
            stack[top++] = next[last];
    }
}

/* The wanted points of a leaf, with what the party before has found for first guesses. */
static void gather(struct party *p, const struct leaf *l, const unsigned char *wanted,
                   const struct pm_cloud *to, const struct pm_look *q)
{
    int32_t guess[WIDTH];
    const ptrdiff_t guesses = p->n;

    memcpy(guess, p->found, sizeof guess);
    p->n = 0;
    p->bounds = nowhere();
    for (int k = 0; k < WIDTH; k++) {
        if (l->id[k] < 0 || (wanted != NULL && !wanted[l->id[k]]))
            continue;
        for (int j = 0; j < 3; j++) {
            p->x[p->n][j] = l->x[j][k];
            p->normal[p->n][j] = l->normal[j][k];
        }
        widen(p->bounds.x, p->x[p->n], p->x[p->n]);
        widen(p->bounds.normal, p->normal[p->n], p->normal[p->n]);
        p->id[p->n] = l->id[k];
        p->d2[p->n] = q->cutoff * q->cutoff;
        p->found[p->n++] = -1;
    }
    p->furthest = 0;
    for (ptrdiff_t k = 0; k < p->n; k++) {
        const ptrdiff_t at =
            guesses > 0 && guess[k % guesses] >= 0 ? to->leaf_of[guess[k % guesses]] : -1;
        double d2[WIDTH];
        if (at >= 0) {
            distances(&to->leaf[at / WIDTH], q, p->x[k], p->normal[k], d2);
            offer(p, k, q, d2[at % WIDTH], guess[k % guesses]);
        }
        p->furthest = greater(p->furthest, p->d2[k]);
    }
}

void pm_cloud_look(const struct pm_cloud *from, const unsigned char *wanted,
                   const struct pm_cloud *to, const struct pm_look *look, int32_t *found,
                   double *distance)
{
    struct party p = {.n = 0};

    for (ptrdiff_t l = 0; l < from->leaves; l++) {
        gather(&p, &from->leaf[l], wanted, to, look);
        if (p.n == 0)
            continue;
        look_at(&p, to, look);
        for (ptrdiff_t k = 0; k < p.n; k++) {
            found[p.id[k]] = p.found[k];
            distance[p.id[k]] = sqrt(p.d2[k]);
        }
    }
}

int pm_cloud_closest(const struct pm_cloud *a, const struct pm_cloud *b, double cutoff, int32_t *i,
                     int32_t *j, double *distance)
{
    struct pm_look look = {.cutoff = cutoff};
    struct party p = {.n = 0};

    *i = *j = -1;
    *distance = HUGE_VAL;
    for (ptrdiff_t l = 0; l < a->leaves; l++) {
        gather(&p, &a->leaf[l], NULL, b, &look);
        look_at(&p, b, &look);
        for (ptrdiff_t k = 0; k < p.n; k++) {
            if (p.found[k] < 0 || !(sqrt(p.d2[k]) < *distance))
                continue;
            *i = p.id[k];
            *j = p.found[k];
            *distance = look.cutoff = sqrt(p.d2[k]);
        }
    }
    return *i >= 0;
}
