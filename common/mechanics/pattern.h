/* Sparsity pattern of a system on the nodes of elements, numbered in elimination order: each
 * used node has one block of `bs` equations, and `tail` dense equations (the rigid end-effector)
 * come last. */
#ifndef PM_PATTERN_H
#define PM_PATTERN_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_pattern {
    ptrdiff_t nodes, bs, tail, n; /* used nodes, block size, tail equations; n = bs*nodes + tail */
    ptrdiff_t *eq;                /* node -> place in elimination order, -1 for unused nodes (nn) */
    ptrdiff_t *lptr; /* place j: its places i >= j, ascending, j itself first: llist[lptr[j]..]
                        (nodes + 1) */
    ptrdiff_t *llist;
    ptrdiff_t *ptr; /* compressed columns, lower triangle, full diagonal blocks (n + 1) */
    ptrdiff_t *row;
};

/* What a pattern is made of. */
struct pm_pattern_source {
    ptrdiff_t nn, ne, npe;
    const int32_t *tet;     /* node ids of the elements (ne x npe) */
    const uint8_t *use;     /* 1: the node has equations (nn) */
    const uint8_t *couples; /* 1: it is coupled with the tail (nn), NULL: none is */
    ptrdiff_t bs, tail;
    const struct pm_pattern
        *like; /* its elimination order, further nodes last; NULL: a new order */
};

enum pm_status pm_pattern_new(const struct pm_pattern_source *from, struct pm_pattern *p,
                              struct pm_err *err);
/* Index in the values of entry (row component 0 of place i, column component 0 of place j), i >= j;
 * the block entry (d, c) is at  result of column c  + d:  pm_pattern_block(p, i, j, c) + d. */
ptrdiff_t pm_pattern_block(const struct pm_pattern *p, ptrdiff_t i, ptrdiff_t j, ptrdiff_t c);
void pm_pattern_release(struct pm_pattern *p);

#endif
