#include "tools/tetmesh/split.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "tools/tetmesh/quality.h"

enum { MAX_RING = 10, PASSES = 4 };
static const double min_quality =
    0.15; /* mean ratio of new tetrahedra; HXT's worst are about 0.3 */
static const int tet_face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
static const int face_apex[4] = {3, 2, 0, 1};

struct skin { /* a triangle of a surface */
    int32_t key[3], tag;
};

struct work {
    struct pm_tetra *t;
    struct skin *skin;
    ptrdiff_t nskin;
    ptrdiff_t ncap, ecap; /* room for nodes and tetrahedra */
    ptrdiff_t *ptr;
    int32_t *list; /* tetrahedra of a node (4 ne) */
    uint8_t *dead; /* (ecap) */
};

struct ring {
    int n;
    int32_t C, D;
    int32_t p[MAX_RING]; /* counter-clockwise seen from D */
    int32_t tet[MAX_RING];
    int cut[MAX_RING][MAX_RING];
};

static int ascending(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int by_key(const void *a, const void *b)
{
    const struct skin *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->key[k] != q->key[k])
            return p->key[k] < q->key[k] ? -1 : 1;
    return 0;
}

/* Tag of the surface triangle (a, b, c), INT32_MIN if it is none. */
static int32_t tag_of(const struct work *w, int32_t a, int32_t b, int32_t c)
{
    struct skin s = {{a, b, c}, 0};
    qsort(s.key, 3, sizeof s.key[0], ascending);
    const struct skin *found = bsearch(&s, w->skin, (size_t)w->nskin, sizeof s, by_key);
    return found != NULL ? found->tag : INT32_MIN;
}

/* Two faces of v on one smooth surface: 1 and the apexes (corners) opposite to them. */
static int two_faces(const struct work *w, const int32_t v[4], int apex[2])
{
    int32_t tag[4];
    for (int f = 0; f < 4; f++)
        tag[f] = tag_of(w, v[tet_face[f][0]], v[tet_face[f][1]], v[tet_face[f][2]]);
    for (int f = 0; f < 4; f++)
        for (int g = f + 1; g < 4; g++)
            if (tag[f] >= 0 && tag[f] == tag[g]) {
                apex[0] = face_apex[f];
                apex[1] = face_apex[g];
                return 1;
            }
    return 0;
}

static double quality_at(const struct work *w, const int32_t v[4])
{
    double X[12];
    for (int k = 0; k < 4; k++)
        memcpy(X + 3 * k, w->t->x + 3 * v[k], 3 * sizeof *X);
    return pm_quality_mean_ratio(X);
}

/* Mean ratio, 0 where the tetrahedron has two faces on one surface. */
static double quality(const struct work *w, int32_t a, int32_t b, int32_t c, int32_t d)
{
    const int32_t v[4] = {a, b, c, d};
    int apex[2];
    return two_faces(w, v, apex) ? 0 : quality_at(w, v);
}

static enum pm_status prepare(struct work *w, const struct pm_shell *shell, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    w->nskin = shell->nt;
    w->ncap = w->t->nn;
    w->ecap = w->t->ne;
    PM_TRY(PM_NEW(w->skin, shell->nt, err));
    for (ptrdiff_t f = 0; f < shell->nt; f++) {
        w->skin[f].tag = shell->tag[f];
        memcpy(w->skin[f].key, shell->tri + 3 * f, sizeof w->skin[f].key);
        qsort(w->skin[f].key, 3, sizeof(int32_t), ascending);
    }
    qsort(w->skin, (size_t)w->nskin, sizeof *w->skin, by_key);
    PM_TRY(PM_NEW(w->dead, w->ecap, err));
done:
    return status;
}

/* Tetrahedra around every node. */
static enum pm_status adjacency(struct work *w, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_tetra *t = w->t;
    pm_free(w->ptr);
    pm_free(w->list);
    w->list = NULL;
    PM_TRY(PM_NEW(w->ptr, t->nn + 2, err));
    PM_TRY(PM_NEW(w->list, 4 * t->ne, err));
    for (ptrdiff_t k = 0; k < 4 * t->ne; k++)
        w->ptr[t->tet[k] + 2]++;
    for (ptrdiff_t a = 0; a < t->nn; a++)
        w->ptr[a + 2] += w->ptr[a + 1];
    for (ptrdiff_t k = 0; k < 4 * t->ne; k++)
        w->list[w->ptr[t->tet[k] + 1]++] = (int32_t)(k / 4);
done:
    return status;
}

static int corner(const int32_t v[4], int32_t a)
{
    for (int k = 0; k < 4; k++)
        if (v[k] == a)
            return k;
    return -1;
}

/* The closed ring of living tetrahedra around the edge C D; 0 where it is open, touched in this
 * pass or long. */
static int find_ring(const struct work *w, struct ring *r)
{
    int32_t from[MAX_RING] = {0}, to[MAX_RING] = {0}, tet[MAX_RING] = {0};
    int n = 0;
    for (ptrdiff_t k = w->ptr[r->C]; k < w->ptr[r->C + 1]; k++) {
        const int32_t e = w->list[k], *v = w->t->tet + 4 * (ptrdiff_t)e;
        const int c = corner(v, r->C), d = corner(v, r->D);
        if (d < 0)
            continue;
        if (n == MAX_RING || w->dead[e])
            return 0;
        /* the other two corners such that (C, D, from, to) is positive */
        for (int f = 0; f < 4; f++)
            for (int g = 0; g < 4; g++)
                if (f != c && f != d && g != c && g != d && g != f) {
                    const int order[4] = {c, d, f, g};
                    int odd = 0;
                    for (int i = 0; i < 4; i++)
                        for (int j = i + 1; j < 4; j++)
                            odd ^= order[i] > order[j];
                    if (!odd) {
                        from[n] = v[f];
                        to[n] = v[g];
                    }
                }
        tet[n++] = e;
    }
    r->n = 0;
    for (int32_t at = from[0]; r->n < n; r->n++) {
        int k = 0;
        while (k < n && from[k] != at)
            k++;
        if (k == n)
            return 0;
        r->p[r->n] = at;
        r->tet[r->n] = tet[k];
        at = to[k];
        if (at == from[0])
            return ++r->n == n && n >= 3;
    }
    return 0;
}

/* Klincsek: best triangulation of the ring's polygon by the worst of its tetrahedra. */
static double best_triangulation(const struct work *w, struct ring *r)
{
    double q[MAX_RING][MAX_RING] = {{0}};
    for (int i = r->n - 2; i >= 0; i--) {
        q[i][i + 1] = INFINITY;
        for (int j = i + 2; j < r->n; j++) {
            q[i][j] = -INFINITY;
            for (int k = i + 1; k < j; k++) {
                double now = fmin(quality(w, r->p[i], r->p[k], r->p[j], r->D),
                                  quality(w, r->p[i], r->p[j], r->p[k], r->C));
                now = fmin(now, fmin(q[i][k], q[k][j]));
                if (now > q[i][j]) {
                    q[i][j] = now;
                    r->cut[i][j] = k;
                }
            }
        }
    }
    return q[0][r->n - 1];
}

static enum pm_status reserve(struct work *w, ptrdiff_t nodes, ptrdiff_t tets, struct pm_err *err)
{
    struct pm_tetra *t = w->t;
    if (t->nn + nodes > w->ncap) {
        double *x = pm_realloc(t->x, 6 * (t->nn + nodes), sizeof *x, err);
        if (x == NULL)
            return PM_SYSTEM;
        t->x = x;
        w->ncap = 2 * (t->nn + nodes);
    }
    if (t->ne + tets > w->ecap) {
        int32_t *tet = pm_realloc(t->tet, 8 * (t->ne + tets), sizeof *tet, err);
        if (tet == NULL)
            return PM_SYSTEM;
        t->tet = tet;
        uint8_t *dead = pm_realloc(w->dead, 2 * (t->ne + tets), sizeof *dead, err);
        if (dead == NULL)
            return PM_SYSTEM;
        w->dead = dead;
        w->ecap = 2 * (t->ne + tets);
    }
    return PM_OK;
}

static void add(struct work *w, int32_t a, int32_t b, int32_t c, int32_t d)
{
    const int32_t v[4] = {a, b, c, d};
    w->dead[w->t->ne] = 0;
    memcpy(w->t->tet + 4 * w->t->ne++, v, sizeof v);
}

static void kill_ring(struct work *w, const struct ring *r)
{
    for (int k = 0; k < r->n; k++)
        w->dead[r->tet[k]] = 1;
}

static void triangulate(struct work *w, const struct ring *r, int i, int j)
{
    if (j < i + 2)
        return;
    const int k = r->cut[i][j];
    add(w, r->p[i], r->p[k], r->p[j], r->D);
    add(w, r->p[i], r->p[j], r->p[k], r->C);
    triangulate(w, r, i, k);
    triangulate(w, r, k, j);
}

/* The best of some places between the middle of C D and the centroid of the ring, for the node `a`.
 */
static double best_place(struct work *w, const struct ring *r, int32_t a)
{
    double best = -1, found[3] = {0}, *x = w->t->x + 3 * (ptrdiff_t)a;
    for (int step = 0; step < 5; step++) {
        double worst = 1;
        for (int i = 0; i < 3; i++) {
            double centre = 0;
            for (int k = 0; k < r->n; k++)
                centre += w->t->x[3 * r->p[k] + i] / r->n;
            const double mid = (w->t->x[3 * r->C + i] + w->t->x[3 * r->D + i]) / 2;
            x[i] = mid + 0.2 * step * (centre - mid);
        }
        for (int k = 0; k < r->n; k++) {
            const int32_t p = r->p[k], q = r->p[(k + 1) % r->n];
            const int32_t u[4] = {a, r->D, p, q}, v[4] = {r->C, a, p, q};
            worst = fmin(worst, fmin(quality_at(w, u), quality_at(w, v)));
        }
        if (worst > best) {
            best = worst;
            memcpy(found, x, sizeof found);
        }
    }
    memcpy(x, found, sizeof found);
    return best;
}

static enum pm_status treat(struct work *w, struct ring *r, ptrdiff_t *left, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    PM_TRY(reserve(w, 1, 2 * MAX_RING, err));
    if (best_triangulation(w, r) > min_quality) {
        triangulate(w, r, 0, r->n - 1);
        kill_ring(w, r);
    } else if (best_place(w, r, (int32_t)w->t->nn) > min_quality) {
        const int32_t a = (int32_t)w->t->nn++;
        for (int k = 0; k < r->n; k++) {
            add(w, a, r->D, r->p[k], r->p[(k + 1) % r->n]);
            add(w, r->C, a, r->p[k], r->p[(k + 1) % r->n]);
        }
        kill_ring(w, r);
    } else {
        (*left)++;
    }
done:
    return status;
}

static void compact(struct work *w)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t e = 0; e < w->t->ne; e++)
        if (!w->dead[e])
            memmove(w->t->tet + 4 * n++, w->t->tet + 4 * e, 4 * sizeof *w->t->tet);
    w->t->ne = n;
    memset(w->dead, 0, (size_t)n);
}

enum pm_status pm_split_two_faces(const struct pm_shell *shell, struct pm_tetra *t, ptrdiff_t *left,
                                  struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct work w = {.t = t};
    PM_TRY(prepare(&w, shell, err));
    int changed = 1;
    for (int pass = 0; pass < PASSES && changed; pass++) {
        *left = 0;
        PM_TRY(adjacency(&w, err));
        const ptrdiff_t before = t->ne;
        for (ptrdiff_t e = 0; e < before; e++) {
            int apex[2];
            const int32_t *v = t->tet + 4 * e;
            if (w.dead[e] || !two_faces(&w, v, apex))
                continue;
            struct ring r = {.C = v[apex[0]], .D = v[apex[1]]};
            if (find_ring(&w, &r))
                PM_TRY(treat(&w, &r, left, err));
            else
                (*left)++;
        }
        changed = t->ne != before;
        compact(&w);
    }
done:
    pm_free(w.skin);
    pm_free(w.ptr);
    pm_free(w.list);
    pm_free(w.dead);
    return status;
}
