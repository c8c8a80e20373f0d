#include "common/geometry/balls.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

enum { LEAF = 6, STACK = 96 };

struct ball {
    double c[3], r;
    int32_t id;
};

/* Preorder: the left child of node i is i + 1; right = 0 marks a leaf over balls first .. last - 1.
 */
struct node {
    double lo[3], hi[3];
    ptrdiff_t first, last, right;
};

struct pm_balls {
    ptrdiff_t nnodes;
    struct ball *ball;
    struct node *node;
};

static int compare(const struct ball *a, const struct ball *b, int axis)
{
    if (a->c[axis] != b->c[axis])
        return a->c[axis] < b->c[axis] ? -1 : 1;
    return (a->id > b->id) - (a->id < b->id);
}

static int compare_x(const void *a, const void *b)
{
    return compare(a, b, 0);
}

static int compare_y(const void *a, const void *b)
{
    return compare(a, b, 1);
}

static int compare_z(const void *a, const void *b)
{
    return compare(a, b, 2);
}

static void build(struct pm_balls *t, ptrdiff_t first, ptrdiff_t last)
{
    static int (*const by[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    ptrdiff_t at = t->nnodes++;
    struct node *nd = &t->node[at];
    double low[3], high[3];
    int axis = 0;

    for (int j = 0; j < 3; j++) {
        const struct ball *b = &t->ball[first];
        low[j] = high[j] = b->c[j];
        nd->lo[j] = b->c[j] - b->r;
        nd->hi[j] = b->c[j] + b->r;
        for (b++; b < t->ball + last; b++) {
            low[j] = b->c[j] < low[j] ? b->c[j] : low[j];
            high[j] = b->c[j] > high[j] ? b->c[j] : high[j];
            nd->lo[j] = b->c[j] - b->r < nd->lo[j] ? b->c[j] - b->r : nd->lo[j];
            nd->hi[j] = b->c[j] + b->r > nd->hi[j] ? b->c[j] + b->r : nd->hi[j];
        }
        if (high[j] - low[j] > high[axis] - low[axis])
            axis = j;
    }
    nd->first = first;
    nd->last = last;
    if (last - first <= LEAF)
        return;
    qsort(t->ball + first, (size_t)(last - first), sizeof *t->ball, by[axis]);
    build(t, first, (first + last) / 2);
    t->node[at].right = t->nnodes;
    build(t, (first + last) / 2, last);
}

enum pm_status pm_balls_new(ptrdiff_t n, const double *centre, const double *radius,
                            struct pm_balls **balls, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_balls *t = NULL;

    *balls = NULL;
    PM_TRY(PM_NEW(t, 1, err));
    PM_TRY(PM_NEW(t->ball, n, err));
    PM_TRY(PM_NEW(t->node, n + 1, err));
    for (ptrdiff_t i = 0; i < n; i++) {
        memcpy(t->ball[i].c, &centre[3 * i], 3 * sizeof(double));
        t->ball[i].r = radius[i];
        t->ball[i].id = (int32_t)i;
    }
    if (n > 0)
        build(t, 0, n);
    *balls = t;
    t = NULL;
done:
    pm_balls_free(t);
    return status;
}

void pm_balls_free(struct pm_balls *balls)
{
    if (balls == NULL)
        return;
    pm_free(balls->ball);
    pm_free(balls->node);
    pm_free(balls);
}

static ptrdiff_t query_leaf(const struct pm_balls *t, const struct node *nd, const double x[3],
                            int32_t *id)
{
    ptrdiff_t found = 0;

    for (ptrdiff_t i = nd->first; i < nd->last; i++) {
        const struct ball *b = &t->ball[i];
        double e[3] = {x[0] - b->c[0], x[1] - b->c[1], x[2] - b->c[2]};
        if (e[0] * e[0] + e[1] * e[1] + e[2] * e[2] < b->r * b->r)
            id[found++] = b->id;
    }
    return found;
}

ptrdiff_t pm_balls_query(const struct pm_balls *balls, const double x[3], int32_t *id)
{
    ptrdiff_t stack[STACK], top = 0, found = 0;

    if (balls->nnodes > 0)
        stack[top++] = 0;
    while (top > 0) {
        ptrdiff_t at = stack[--top];
        const struct node *nd = &balls->node[at];
        if (x[0] < nd->lo[0] || x[0] > nd->hi[0] || x[1] < nd->lo[1] || x[1] > nd->hi[1] ||
            x[2] < nd->lo[2] || x[2] > nd->hi[2])
            continue;
        if (nd->right == 0) {
            found += query_leaf(balls, nd, x, id + found);
        } else {
            stack[top++] = nd->right;
            stack[top++] = at + 1;
        }
    }
    return found;
}
