#include <math.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/trimesh.h"

enum { NODES_MAX = 2000000 };

static double length2(const struct pm_trimesh *m, ptrdiff_t a, ptrdiff_t b)
{
    const double *p = &m->x[3 * a], *q = &m->x[3 * b];
    const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};

    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

static ptrdiff_t entry(const struct pm_star *star, ptrdiff_t a, ptrdiff_t b)
{
    for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
        if (star->next[k] == b)
            return k;
    return -1;
}

/* middle (3 nt): for every directed edge the node in its middle, -1 where it stays. */
static enum pm_status halve_edges(const struct pm_trimesh *m, const struct pm_star *star,
                                  double longest, int32_t *middle, struct pm_trimesh *out,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t count = m->nn;

    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++) {
            ptrdiff_t b = star->next[k], back = entry(star, b, a);
            middle[k] = -1;
            if (!(length2(m, a, b) > longest * longest))
                continue;
            middle[k] = (int32_t)count; /* the other direction gets it too, once */
            if (back >= 0 && a > b)
                middle[k] = middle[back];
            else
                count++;
        }
    if (count > NODES_MAX)
        PM_TRY(pm_fail(err, PM_INPUT, "edges of %g mm need more than %d nodes", longest,
                       (int)NODES_MAX));
    PM_TRY(PM_NEW(out->x, 3 * count, err));
    memcpy(out->x, m->x, 3 * (size_t)m->nn * sizeof *out->x);
    out->nn = count;
    for (ptrdiff_t a = 0; a < m->nn; a++)
        for (ptrdiff_t k = star->ptr[a]; k < star->ptr[a + 1]; k++)
            for (int j = 0; j < 3 && middle[k] >= 0; j++)
                out->x[3 * (ptrdiff_t)middle[k] + j] =
                    (m->x[3 * a + j] + m->x[3 * (ptrdiff_t)star->next[k] + j]) / 2;
done:
    return status;
}

static void add(struct pm_trimesh *m, int32_t a, int32_t b, int32_t c)
{
    int32_t *t = &m->tri[3 * m->nt++];

    t[0] = a;
    t[1] = b;
    t[2] = c;
}

/* Triangle v with the nodes h[k] in the middle of its edges (v[k], v[k + 1]), -1: none. */
static void cut(const int32_t v[3], const int32_t h[3], struct pm_trimesh *out)
{
    const int n = (h[0] >= 0) + (h[1] >= 0) + (h[2] >= 0);
    int k = 0;

    if (n == 0) {
        add(out, v[0], v[1], v[2]);
    } else if (n == 3) {
        add(out, h[0], h[1], h[2]);
        for (k = 0; k < 3; k++)
            add(out, v[k], h[k], h[(k + 2) % 3]);
    } else if (n == 1) {
        while (h[k] < 0)
            k++;
        add(out, v[k], h[k], v[(k + 2) % 3]);
        add(out, h[k], v[(k + 1) % 3], v[(k + 2) % 3]);
    } else { /* the corner between both halved edges, and the shorter diagonal of what remains */
        while (h[k] >= 0)
            k++;
        const int32_t a = v[k], b = v[(k + 1) % 3], p = h[(k + 1) % 3], q = h[(k + 2) % 3];
        add(out, p, v[(k + 2) % 3], q);
        if (length2(out, a, p) < length2(out, b, q)) {
            add(out, a, b, p);
            add(out, a, p, q);
        } else {
            add(out, a, b, q);
            add(out, b, p, q);
        }
    }
}

static enum pm_status pass(const struct pm_trimesh *m, double longest, struct pm_trimesh *out,
                           struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_star star = {0};
    int32_t *middle = NULL;

    PM_TRY(pm_star_new(m, &star, err));
    PM_TRY(PM_NEW(middle, 3 * m->nt, err));
    PM_TRY(halve_edges(m, &star, longest, middle, out, err));
    PM_TRY(PM_NEW(out->tri, 12 * m->nt, err));
    for (ptrdiff_t t = 0; t < m->nt; t++) {
        const int32_t *v = &m->tri[3 * t];
        int32_t h[3];
        for (int k = 0; k < 3; k++)
            h[k] = middle[entry(&star, v[k], v[(k + 1) % 3])];
        cut(v, h, out);
    }
done:
    pm_star_release(&star);
    pm_free(middle);
    return status;
}

enum pm_status pm_trimesh_refine(const struct pm_trimesh *m, double longest, struct pm_trimesh *out,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_trimesh now = {0}, next = {0};

    PM_TRY(pass(m, longest, &now, err));
    for (ptrdiff_t before = m->nn; now.nn > before;) {
        before = now.nn;
        PM_TRY(pass(&now, longest, &next, err));
        pm_trimesh_release(&now);
        now = next;
        memset(&next, 0, sizeof next);
    }
    *out = now;
    memset(&now, 0, sizeof now);
done:
    pm_trimesh_release(&now);
    pm_trimesh_release(&next);
    return status;
}
