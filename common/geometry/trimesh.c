#include "common/geometry/trimesh.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/boxes.h"

void pm_trimesh_release(struct pm_trimesh *m)
{
    pm_free(m->x);
    pm_free(m->tri);
    memset(m, 0, sizeof *m);
}

void pm_star_release(struct pm_star *star)
{
    pm_free(star->ptr);
    pm_free(star->next);
    pm_free(star->after);
    memset(star, 0, sizeof *star);
}

int32_t pm_star_after(const struct pm_star *star, ptrdiff_t a, ptrdiff_t b)
{
    for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
        if (star->next[k] == b)
            return star->after[k];
    return -1;
}

int32_t pm_star_last(const struct pm_star *star, ptrdiff_t a)
{
    for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
        if (pm_star_after(star, a, star->after[k]) < 0)
            return star->after[k];
    return -1;
}

static enum pm_status refuse_edge(const struct pm_trimesh *m, ptrdiff_t a, ptrdiff_t b,
                                  const char *what, struct pm_err *err)
{
    const double *p = &m->x[3 * a], *q = &m->x[3 * b];

    return pm_fail(err, PM_INPUT, "edge from (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g) %s", p[0],
                   p[1], p[2], q[0], q[1], q[2], what);
}

enum pm_status pm_star_new(const struct pm_trimesh *m, struct pm_star *star, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t *fill = NULL;

    memset(star, 0, sizeof *star);
    PM_TRY(PM_NEW(star->ptr, m->nn + 1, err));
    PM_TRY(PM_NEW(star->next, 3 * m->nt, err));
    PM_TRY(PM_NEW(star->after, 3 * m->nt, err));
    PM_TRY(PM_NEW(fill, m->nn, err));
    for (ptrdiff_t k = 0; k < 3 * m->nt; k++)
        star->ptr[m->tri[k] + 1]++;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        star->ptr[a + 1] += star->ptr[a];
        fill[a] = star->ptr[a];
    }
    for (ptrdiff_t k = 0; k < 3 * m->nt; k++) {
        const int32_t *v = &m->tri[k / 3 * 3], a = v[k % 3], b = v[(k + 1) % 3];
        for (ptrdiff_t e = star->ptr[a]; e < fill[a]; e++)
            if (star->next[e] == b)
                PM_TRY(refuse_edge(m, a, b, "belongs to two triangles on the same side", err));
        star->next[fill[a]] = b;
        star->after[fill[a]++] = v[(k + 2) % 3];
    }
done:
    pm_free(fill);
    if (status != PM_OK)
        pm_star_release(star);
    return status;
}

/* Triangles of the fan of node a that begins with its triangle k. */
static ptrdiff_t fan_length(const struct pm_star *star, ptrdiff_t a, ptrdiff_t k)
{
    ptrdiff_t n = 0;

    for (int32_t b = star->next[k]; n < star->ptr[a + 1] - star->ptr[a]; n++) {
        b = pm_star_after(star, a, b);
        if (b < 0)
            break;
    }
    return n;
}

/* The fan of node a comes back to its first triangle, or has one gap; adds the gaps to *open. */
static int one_fan(const struct pm_star *star, ptrdiff_t a, ptrdiff_t *open)
{
    ptrdiff_t first = star->ptr[a], gaps = 0, n = 0;

    for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
        if (pm_star_after(star, star->next[k], a) < 0) {
            gaps++;
            first = k;
        }
    *open += gaps;
    if (gaps > 0)
        return gaps == 1 && fan_length(star, a, first) == star->ptr[a + 1] - star->ptr[a];
    for (int32_t b = star->next[first];;) {
        b = pm_star_after(star, a, b);
        n++;
        if (b == star->next[first])
            return n == star->ptr[a + 1] - star->ptr[a];
    }
}

/* The first boundary edge refused where there should be none. */
static enum pm_status check_closed(const struct pm_trimesh *m, const struct pm_star *star,
                                   struct pm_err *err)
{
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
            if (pm_star_after(star, star->next[k], a) < 0)
                return refuse_edge(m, a, star->next[k], "has one triangle, expected two", err);
    return PM_OK;
}

static enum pm_status check_fans(const struct pm_trimesh *m, const struct pm_star *star,
                                 ptrdiff_t *open, struct pm_err *err)
{
    *open = 0;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        const double *p = &m->x[3 * a];
        if (star->ptr[a + 1] == star->ptr[a])
            return pm_fail(err, PM_INPUT, "node at (%.4g, %.4g, %.4g) has no triangle", p[0], p[1],
                           p[2]);
        if (!one_fan(star, a, open))
            return pm_fail(err, PM_INPUT,
                           "parts of the surface touch in a node at (%.4g, %.4g, %.4g)", p[0], p[1],
                           p[2]);
    }
    return PM_OK;
}

/* Nodes reached from node 0 along edges. */
static enum pm_status reach(const struct pm_trimesh *m, const struct pm_star *star,
                            ptrdiff_t *count, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    int32_t *queue = NULL;
    uint8_t *seen = NULL;

    *count = 0;
    PM_TRY(PM_NEW(queue, m->nn, err));
    PM_TRY(PM_NEW(seen, m->nn, err));
    seen[0] = 1;
    *count = 1;
    for (ptrdiff_t at = 0; at < *count; at++)
        for (ptrdiff_t k = star->ptr[queue[at]]; k < star->ptr[queue[at] + 1]; k++) {
            const int32_t both[2] = {star->next[k], star->after[k]};
            for (int j = 0; j < 2; j++)
                if (!seen[both[j]]) {
                    seen[both[j]] = 1;
                    queue[(*count)++] = both[j];
                }
        }
done:
    pm_free(queue);
    pm_free(seen);
    return status;
}

enum pm_status pm_trimesh_check(const struct pm_trimesh *m, const struct pm_star *star, int loops,
                                struct pm_err *err)
{
    ptrdiff_t open, count, euler;
    enum pm_status status = PM_OK;

    if (m->nt == 0)
        return pm_fail(err, PM_INPUT, "surface has no triangle");
    if (loops == 0)
        PM_TRY(check_closed(m, star, err));
    PM_TRY(check_fans(m, star, &open, err));
    PM_TRY(reach(m, star, &count, err));
    if (count != m->nn)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "surface has several parts: %td of its %td nodes hang together", count,
                       m->nn));
    euler = m->nn - (3 * m->nt + open) / 2 + m->nt;
    if (euler != 2 - loops)
        PM_TRY(pm_fail(err, PM_INPUT, "surface has the Euler number %td, expected %d: %s", euler,
                       2 - loops,
                       euler < 2 - loops ? "it has a handle or a hole" : "it is closed"));
done:
    return status;
}

void pm_trimesh_box(const struct pm_trimesh *m, double low[3], double high[3])
{
    for (int j = 0; j < 3; j++) {
        low[j] = HUGE_VAL;
        high[j] = -HUGE_VAL;
    }
    for (ptrdiff_t k = 0; k < 3 * m->nn; k++) {
        low[k % 3] = fmin(low[k % 3], m->x[k]);
        high[k % 3] = fmax(high[k % 3], m->x[k]);
    }
}

enum pm_status pm_trimesh_mirror(const struct pm_trimesh *m, int axis, double at, double tolerance,
                                 int32_t *image, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_boxes *tree = NULL;
    double *box = NULL;
    int32_t *id = NULL;

    PM_TRY(PM_NEW(box, 6 * m->nn, err));
    PM_TRY(PM_NEW(id, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        memcpy(&box[6 * a], &m->x[3 * a], 3 * sizeof *box);
        memcpy(&box[6 * a + 3], &m->x[3 * a], 3 * sizeof *box);
    }
    PM_TRY(pm_boxes_new(m->nn, box, NULL, &tree, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        double y[3], query[6];
        memcpy(y, &m->x[3 * a], sizeof y);
        y[axis] = 2 * at - y[axis];
        for (int j = 0; j < 3; j++) {
            query[j] = y[j] - tolerance;
            query[3 + j] = y[j] + tolerance;
        }
        if (pm_boxes_meet(tree, query, id) != 1)
            PM_TRY(pm_fail(err, PM_INPUT,
                           "node at (%.6g, %.6g, %.6g) has no mirror image in the plane %c = %.6g "
                           "within %.1e mm",
                           m->x[3 * a], m->x[3 * a + 1], m->x[3 * a + 2], 'x' + axis, at,
                           tolerance));
        image[a] = id[0];
    }
done:
    pm_boxes_free(tree);
    pm_free(box);
    pm_free(id);
    return status;
}
