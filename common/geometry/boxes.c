#include "common/geometry/boxes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

enum { LEAF = 2, STACK = 512, BITS = 21 };

struct item {
    double box[12];
    uint64_t code; /* place of its centre on the Z-curve */
    int32_t id;
};

/* A box holds the lowest and highest corner and the bounds of the normals. Preorder: the left child
 * of node i is i + 1; right = 0 marks a leaf over items first .. last - 1.
 */
struct node {
    double box[12];
    ptrdiff_t first, last, right;
};

struct pm_boxes {
    ptrdiff_t nnodes;
    struct item *item;
    struct node *node;
};

static int by_code(const void *a, const void *b)
{
    const struct item *p = a, *q = b;
    if (p->code != q->code)
        return p->code < q->code ? -1 : 1;
    return (p->id > q->id) - (p->id < q->id);
}

/* fmin and fmax are calls. */
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

static void join(double *box, const double *other)
{
    for (int k = 0; k < 12; k += 6)
        for (int i = k; i < k + 3; i++) {
            box[i] = lesser(box[i], other[i]);
            box[3 + i] = greater(box[3 + i], other[3 + i]);
        }
}

/* Interleaved bits of the centre, in parts of the box of all. */
static uint64_t place(const double *box, const double *all)
{
    uint64_t code = 0;
    for (int i = 0; i < 3; i++) {
        const double middle = 0.5 * (box[i] + box[3 + i]), width = all[3 + i] - all[i];
        const double t = width > 0 ? (middle - all[i]) / width : 0;
        const uint64_t cell = (uint64_t)(t * (double)((1 << BITS) - 1));
        for (int b = 0; b < BITS; b++)
            code |= (cell >> b & 1) << (3 * b + i);
    }
    return code;
}

/* Where the highest bit in which the sorted codes differ is set: the halves of a cell. */
static ptrdiff_t split(const struct item *item, ptrdiff_t first, ptrdiff_t last)
{
    uint64_t differ = item[first].code ^ item[last - 1].code, bit = 1;
    if (differ == 0)
        return (first + last) / 2;
    while (differ >>= 1)
        bit <<= 1;
    while (last - first > 1) {
        const ptrdiff_t middle = (first + last) / 2;
        if (item[middle].code & bit)
            last = middle;
        else
            first = middle;
    }
    return last;
}

static void build(struct pm_boxes *t, ptrdiff_t first, ptrdiff_t last)
{
    const ptrdiff_t at = t->nnodes++;
    struct node *nd = &t->node[at];
    nd->first = first;
    nd->last = last;
    if (last - first <= LEAF) {
        memcpy(nd->box, t->item[first].box, sizeof nd->box);
        for (ptrdiff_t i = first + 1; i < last; i++)
            join(nd->box, t->item[i].box);
        return;
    }
    const ptrdiff_t middle = split(t->item, first, last);
    build(t, first, middle);
    nd->right = t->nnodes;
    build(t, middle, last);
    memcpy(nd->box, t->node[at + 1].box, sizeof nd->box);
    join(nd->box, t->node[nd->right].box);
}

static void make_items(ptrdiff_t n, const double *box, const double *normal, struct item *item)
{
    double all[12] = {0};
    for (ptrdiff_t i = 0; i < n; i++) {
        memcpy(item[i].box, box + 6 * i, 6 * sizeof *box);
        for (int j = 0; j < 6 && normal != NULL; j++)
            item[i].box[6 + j] = normal[3 * i + j % 3];
        if (i == 0)
            memcpy(all, item[i].box, sizeof all);
        join(all, item[i].box);
    }
    for (ptrdiff_t i = 0; i < n; i++) {
        item[i].code = place(item[i].box, all);
        item[i].id = (int32_t)i;
    }
}

enum pm_status pm_boxes_new(ptrdiff_t n, const double *box, const double *normal,
                            struct pm_boxes **boxes, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *t = NULL;

    *boxes = NULL;
    PM_TRY(PM_NEW(t, 1, err));
    PM_TRY(PM_NEW(t->item, n, err));
    PM_TRY(PM_NEW(t->node, 2 * n + 1, err));
    make_items(n, box, normal, t->item);
    qsort(t->item, (size_t)n, sizeof *t->item, by_code);
    if (n > 0)
        build(t, 0, n);
    *boxes = t;
    t = NULL;
done:
    pm_boxes_free(t);
    return status;
}

void pm_boxes_free(struct pm_boxes *boxes)
{
    if (boxes == NULL)
        return;
    pm_free(boxes->item);
    pm_free(boxes->node);
    pm_free(boxes);
}

static int meet(const double *a, const double *b)
{
    return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] &&
           b[2] <= a[5];
}

ptrdiff_t pm_boxes_meet(const struct pm_boxes *boxes, const double box[6], int32_t *id)
{
    ptrdiff_t stack[STACK], top = 0, found = 0;

    if (boxes->nnodes > 0)
        stack[top++] = 0;
    while (top > 0) {
        const ptrdiff_t at = stack[--top];
        const struct node *nd = &boxes->node[at];
        if (!meet(nd->box, box))
            continue;
        if (nd->right > 0) {
            stack[top++] = nd->right;
            stack[top++] = at + 1;
            continue;
        }
        for (ptrdiff_t i = nd->first; i < nd->last; i++)
            if (meet(boxes->item[i].box, box))
                id[found++] = boxes->item[i].id;
    }
    return found;
}

static double point_distance2(const double *box, const double *x)
{
    double d2 = 0;
    for (int i = 0; i < 3; i++) {
        const double e = greater(greater(box[i] - x[i], x[i] - box[3 + i]), 0);
        d2 += e * e;
    }
    return d2;
}

double pm_boxes_nearest(const struct pm_boxes *boxes, const double x[3], double best,
                        pm_boxes_visit *visit, void *data)
{
    struct {
        ptrdiff_t at;
        double d2;
    } stack[STACK];
    int top = 0;

    if (boxes->nnodes > 0) {
        stack[top].at = 0;
        stack[top++].d2 = point_distance2(boxes->node[0].box, x);
    }
    while (top > 0) {
        const ptrdiff_t at = stack[--top].at;
        const struct node *nd = &boxes->node[at];
        if (!(stack[top].d2 < best * best))
            continue;
        if (nd->right == 0) {
            for (ptrdiff_t i = nd->first; i < nd->last; i++)
                if (point_distance2(boxes->item[i].box, x) < best * best)
                    best = visit(data, boxes->item[i].id, best);
            continue;
        }
        const double l = point_distance2(boxes->node[at + 1].box, x),
                     r = point_distance2(boxes->node[nd->right].box, x);
        const int left_last = l > r;
        stack[top].at = left_last ? at + 1 : nd->right;
        stack[top++].d2 = left_last ? l : r;
        stack[top].at = left_last ? nd->right : at + 1;
        stack[top++].d2 = left_last ? r : l;
    }
    return best;
}

/* Largest product of numbers from two intervals. */
static double most(double a, double A, double b, double B)
{
    return greater(greater(a * b, a * B), greater(A * b, A * B));
}

/* Squared distance of two boxes; infinite where beyond best or none of one can face any of the
 * other. */
static double pair_distance2(const double *a, const double *b, double cosine, double best)
{
    double d2 = 0, ahead = 0, back = 0, opposite = 0;
    for (int i = 0; i < 3; i++) {
        const double e = greater(greater(b[i] - a[3 + i], a[i] - b[3 + i]), 0);
        d2 += e * e;
    }
    if (d2 > best * best)
        return HUGE_VAL;
    if (cosine < 0)
        return d2;
    for (int i = 0; i < 3; i++) {
        const double lo = b[i] - a[3 + i], hi = b[3 + i] - a[i], *n = a + 6 + i, *m = b + 6 + i;
        ahead += most(lo, hi, n[0], n[3]);
        back += most(-hi, -lo, m[0], m[3]);
        opposite += most(n[0], n[3], -m[3], -m[0]);
    }
    const double c2 = cosine * cosine, least = lesser(ahead, back);
    /* two cones about one direction: the normals are within twice the angle of opposite */
    return least < 0 || least * least < c2 * d2 || opposite < 2 * c2 - 1 ? HUGE_VAL : d2;
}

struct pair {
    ptrdiff_t a, b;
    double d2;
};

static double visit_leaves(const struct pm_boxes *t, const struct node *a, const struct node *b,
                           double cosine, double best, pm_boxes_visit_pair *visit, void *data)
{
    for (ptrdiff_t i = a->first; i < a->last; i++)
        for (ptrdiff_t j = a == b ? i + 1 : b->first; j < b->last; j++)
            if (pair_distance2(t->item[i].box, t->item[j].box, cosine, best) < HUGE_VAL)
                best = visit(data, t->item[i].id, t->item[j].id, best);
    return best;
}

double pm_boxes_pairs(const struct pm_boxes *boxes, double cosine, double best,
                      pm_boxes_visit_pair *visit, void *data)
{
    struct pair stack[STACK];
    int top = 0;

    if (boxes->nnodes > 0)
        stack[top++] = (struct pair){0, 0, 0};
    while (top > 0) {
        const struct pair p = stack[--top];
        const struct node *a = &boxes->node[p.a], *b = &boxes->node[p.b];
        struct pair next[3];
        int n = 0;
        if (p.d2 > best * best)
            continue;
        if (a->right == 0 && b->right == 0) {
            best = visit_leaves(boxes, a, b, cosine, best, visit, data);
            continue;
        }
        const int split_a = a->last - a->first >= b->last - b->first;
        if (p.a == p.b) {
            next[n++] = (struct pair){p.a + 1, p.a + 1, 0};
            next[n++] = (struct pair){a->right, a->right, 0};
            next[n++] = (struct pair){p.a + 1, a->right, 0};
        } else {
            next[n++] = split_a ? (struct pair){p.a + 1, p.b, 0} : (struct pair){p.a, p.b + 1, 0};
            next[n++] = split_a ? (struct pair){a->right, p.b, 0} : (struct pair){p.a, b->right, 0};
        }
        for (int k = 0; k < n; k++)
            next[k].d2 = pair_distance2(boxes->node[next[k].a].box, boxes->node[next[k].b].box,
                                        cosine, best);
        if (next[0].d2 < next[n - 1].d2) { /* the nearest last: it is taken first */
            const struct pair near = next[0];
            next[0] = next[n - 1];
            next[n - 1] = near;
        }
        for (int k = 0; k < n; k++)
            if (next[k].d2 < HUGE_VAL)
                stack[top++] = next[k];
    }
    return best;
}
