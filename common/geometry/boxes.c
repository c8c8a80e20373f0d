#include "common/geometry/boxes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

enum { LEAF = 4, STACK = 128, BITS = 21 };

struct item {
    double box[6];
    uint64_t code; /* place of its centre on the Z-curve */
    int32_t id;
};

/* Preorder: the left child of node i is i + 1; right = 0 marks a leaf over items first .. last - 1.
 */
struct node {
    double box[6];
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

static void join(double *box, const double *other)
{
    for (int i = 0; i < 3; i++) {
        box[i] = fmin(box[i], other[i]);
        box[3 + i] = fmax(box[3 + i], other[3 + i]);
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
    build(t, first, (first + last) / 2);
    nd->right = t->nnodes;
    build(t, (first + last) / 2, last);
    memcpy(nd->box, t->node[at + 1].box, sizeof nd->box);
    join(nd->box, t->node[nd->right].box);
}

enum pm_status pm_boxes_new(ptrdiff_t n, const double *box, struct pm_boxes **boxes,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *t = NULL;
    double all[6];

    *boxes = NULL;
    PM_TRY(PM_NEW(t, 1, err));
    PM_TRY(PM_NEW(t->item, n, err));
    PM_TRY(PM_NEW(t->node, n + 1, err));
    for (ptrdiff_t i = 0; i < n; i++) {
        if (i == 0)
            memcpy(all, box, sizeof all);
        join(all, box + 6 * i);
    }
    for (ptrdiff_t i = 0; i < n; i++) {
        memcpy(t->item[i].box, box + 6 * i, sizeof t->item[i].box);
        t->item[i].code = place(box + 6 * i, all);
        t->item[i].id = (int32_t)i;
    }
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

/* Distance of the box from x; infinite where all of it lies outside of the cone. */
static double distance(const double *box, const double *x, const double *ahead, double cosine)
{
    double d2 = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        const double e = fmax(fmax(box[i] - x[i], x[i] - box[3 + i]), 0);
        d2 += e * e;
    }
    const double d = sqrt(d2);
    if (ahead == NULL)
        return d;
    for (int i = 0; i < 3; i++)
        most += ahead[i] * ((ahead[i] > 0 ? box[3 + i] : box[i]) - x[i]);
    return most < cosine * d ? HUGE_VAL : d;
}

double pm_boxes_nearest(const struct pm_boxes *boxes, const double x[3], const double *ahead,
                        double cosine, double best, pm_boxes_visit *visit, void *data)
{
    struct {
        ptrdiff_t at;
        double distance;
    } stack[STACK];
    int top = 0;

    if (boxes->nnodes > 0) {
        stack[top].at = 0;
        stack[top++].distance = distance(boxes->node[0].box, x, ahead, cosine);
    }
    while (top > 0) {
        const ptrdiff_t at = stack[--top].at;
        const struct node *nd = &boxes->node[at];
        if (!(stack[top].distance < best))
            continue;
        if (nd->right == 0) {
            for (ptrdiff_t i = nd->first; i < nd->last; i++)
                if (distance(boxes->item[i].box, x, ahead, cosine) < best)
                    best = visit(data, boxes->item[i].id, best);
            continue;
        }
        const double l = distance(boxes->node[at + 1].box, x, ahead, cosine),
                     r = distance(boxes->node[nd->right].box, x, ahead, cosine);
        const int left_last = l > r;
        stack[top].at = left_last ? at + 1 : nd->right;
        stack[top++].distance = fmax(l, r);
        stack[top].at = left_last ? nd->right : at + 1;
        stack[top++].distance = fmin(l, r);
    }
    return best;
}
