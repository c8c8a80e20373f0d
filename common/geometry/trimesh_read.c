#include "common/geometry/trimesh_read.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/geometry/collide.h"

enum { HEADER = 84, FACET = 50 }; /* bytes of a binary STL file */

static const double SIZE_MAX_FILE = 1e9;

struct reader {
    const char *path;
    char *text; /* the whole file and a NUL */
    ptrdiff_t size;
    ptrdiff_t line;
    ptrdiff_t nx, ni; /* numbers in x, in id */
    ptrdiff_t xcap, icap;
    double *x;
    int32_t *id; /* corners of triangles */
};

static enum pm_status load(struct reader *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    FILE *f = fopen(r->path, "rb");
    long size = 0;

    if (f == NULL)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", r->path, strerror(errno));
    if (fseek(f, 0, SEEK_END) != 0 || (size = ftell(f)) < 0 || fseek(f, 0, SEEK_SET) != 0)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", r->path, strerror(errno)));
    if ((double)size > SIZE_MAX_FILE)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': %ld bytes, expected at most %g", r->path,
                       size, SIZE_MAX_FILE));
    PM_TRY(PM_NEW(r->text, size + 1, err));
    r->size = (ptrdiff_t)fread(r->text, 1, (size_t)size, f);
    if (r->size != size)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", r->path, strerror(errno)));
done:
    fclose(f);
    return status;
}

static enum pm_status refuse(const struct reader *r, const char *expected, struct pm_err *err)
{
    return pm_fail(err, PM_INPUT, "cannot use '%s': line %td: expected %s", r->path, r->line,
                   expected);
}

static enum pm_status add_point(struct reader *r, const double x[3], struct pm_err *err)
{
    for (int j = 0; j < 3; j++)
        if (!isfinite(x[j]))
            return pm_fail(err, PM_INPUT, "cannot use '%s': coordinate %td is not a finite number",
                           r->path, r->nx + j);
    if (r->nx + 3 > r->xcap) {
        r->xcap = 2 * r->xcap + 3000;
        PM_GROW(r->x, r->xcap, err);
    }
    for (int j = 0; j < 3; j++)
        r->x[r->nx++] = x[j] + 0.0; /* no -0 */
    return PM_OK;
}

static enum pm_status add_corner(struct reader *r, ptrdiff_t id, struct pm_err *err)
{
    if (r->ni + 1 > r->icap) {
        r->icap = 2 * r->icap + 3000;
        PM_GROW(r->id, r->icap, err);
    }
    r->id[r->ni++] = (int32_t)id;
    return PM_OK;
}

static uint32_t little_endian(const char *p)
{
    uint32_t v = 0;

    for (int k = 3; k >= 0; k--)
        v = v << 8 | (unsigned char)p[k];
    return v;
}

static int is_binary(const struct reader *r)
{
    return r->size >= HEADER &&
           r->size - HEADER == FACET * (ptrdiff_t)little_endian(r->text + HEADER - 4);
}

static enum pm_status read_binary(struct reader *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;

    for (const char *p = r->text + HEADER; p < r->text + r->size; p += FACET)
        for (int k = 0; k < 3; k++) { /* the normal comes first and is not needed */
            double x[3];
            for (int j = 0; j < 3; j++) {
                uint32_t bits = little_endian(p + 12 + 12 * k + 4 * j);
                float f;
                memcpy(&f, &bits, sizeof f);
                x[j] = (double)f;
            }
            PM_TRY(add_corner(r, r->nx / 3, err));
            PM_TRY(add_point(r, x, err));
        }
done:
    return status;
}

/* The next line without leading blanks, cut at its end; NULL after the last. */
static char *next_line(struct reader *r, char **rest)
{
    char *line = *rest, *end;

    if (line == NULL || *line == '\0')
        return NULL;
    end = line + strcspn(line, "\r\n");
    *rest = *end == '\0' ? end : end + 1 + (*end == '\r' && end[1] == '\n');
    *end = '\0';
    r->line++;
    return line + strspn(line, " \t");
}

/* The word the line begins with, by its length; what follows through *after. */
static int begins(char *line, const char *word, char **after)
{
    size_t n = strlen(word);

    if (strncmp(line, word, n) != 0 || (line[n] != ' ' && line[n] != '\t' && line[n] != '\0'))
        return 0;
    *after = line + n;
    return 1;
}

static enum pm_status three_numbers(const struct reader *r, char *at, double x[3],
                                    struct pm_err *err)
{
    for (int j = 0; j < 3; j++) {
        char *end;
        x[j] = strtod(at, &end);
        if (end == at)
            return refuse(r, "three numbers x y z", err);
        at = end;
    }
    return PM_OK;
}

static enum pm_status read_text(struct reader *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    char *rest = r->text, *line, *after;
    ptrdiff_t corners = 0;

    while ((line = next_line(r, &rest)) != NULL) {
        double x[3];
        if (begins(line, "vertex", &after)) {
            PM_TRY(three_numbers(r, after, x, err));
            PM_TRY(add_corner(r, r->nx / 3, err));
            PM_TRY(add_point(r, x, err));
            corners++;
        } else if (begins(line, "endfacet", &after)) {
            if (corners != 3)
                PM_TRY(refuse(r, "three vertices in the facet before", err));
            corners = 0;
        } else if (*line != '\0' && !begins(line, "solid", &after) &&
                   !begins(line, "facet", &after) && !begins(line, "outer", &after) &&
                   !begins(line, "endloop", &after) && !begins(line, "endsolid", &after))
            PM_TRY(refuse(r, "a line of an STL file (or binary STL: wrong length)", err));
    }
    if (corners != 0)
        PM_TRY(refuse(r, "the end of the last facet", err));
done:
    return status;
}

/* "f 1 2 3", "f 1/4/2 ..", "f -3 -2 -1": a fan. */
static enum pm_status polygon(struct reader *r, char *at, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    ptrdiff_t first = -1, last = -1, count = 0;

    for (at += strspn(at, " \t"); *at != '\0'; at += strspn(at, " \t"), count++) {
        char *end;
        long id = strtol(at, &end, 10);
        ptrdiff_t node = id < 0 ? r->nx / 3 + id : id - 1;
        if (end == at || node < 0 || node >= r->nx / 3)
            return refuse(r, "numbers of vertices that were given before", err);
        at = end + strcspn(end, " \t");
        if (count >= 2) {
            PM_TRY(add_corner(r, first, err));
            PM_TRY(add_corner(r, last, err));
            PM_TRY(add_corner(r, node, err));
        }
        first = count == 0 ? node : first;
        last = node;
    }
    if (count < 3)
        PM_TRY(refuse(r, "a face of three vertices or more", err));
done:
    return status;
}

static enum pm_status read_obj(struct reader *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    char *rest = r->text, *line, *after;

    while ((line = next_line(r, &rest)) != NULL) {
        double x[3];
        if (begins(line, "v", &after)) {
            PM_TRY(three_numbers(r, after, x, err));
            PM_TRY(add_point(r, x, err));
        } else if (begins(line, "f", &after))
            PM_TRY(polygon(r, after, err));
    }
done:
    return status;
}

struct point {
    double x[3];
    ptrdiff_t id;
};

static int compare(const void *p, const void *q)
{
    const struct point *a = p, *b = q;

    for (int j = 0; j < 3; j++)
        if (a->x[j] != b->x[j])
            return a->x[j] < b->x[j] ? -1 : 1;
    return (a->id > b->id) - (a->id < b->id);
}

/* Nodes numbered by their first use in the triangles. */
static enum pm_status merge(const struct reader *r, struct pm_trimesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct point *p = NULL;
    ptrdiff_t n = r->nx / 3, *same = NULL, *node = NULL;

    PM_TRY(PM_NEW(p, n, err));
    PM_TRY(PM_NEW(same, n, err));
    PM_TRY(PM_NEW(node, n, err));
    PM_TRY(PM_NEW(m->x, r->nx, err));
    PM_TRY(PM_NEW(m->tri, r->ni, err));
    for (ptrdiff_t a = 0; a < n; a++) {
        memcpy(p[a].x, &r->x[3 * a], sizeof p[a].x);
        p[a].id = a;
        node[a] = -1;
    }
    qsort(p, (size_t)n, sizeof *p, compare);
    for (ptrdiff_t k = 0; k < n; k++)
        same[p[k].id] =
            k > 0 && memcmp(p[k].x, p[k - 1].x, sizeof p[k].x) == 0 ? same[p[k - 1].id] : p[k].id;
    for (ptrdiff_t t = 0; t < r->ni / 3; t++) {
        ptrdiff_t v[3];
        for (int k = 0; k < 3; k++)
            v[k] = same[r->id[3 * t + k]];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            continue;
        for (int k = 0; k < 3; k++) {
            if (node[v[k]] < 0) {
                node[v[k]] = m->nn;
                memcpy(&m->x[3 * m->nn++], &r->x[3 * v[k]], 3 * sizeof *m->x);
            }
            m->tri[3 * m->nt + k] = (int32_t)node[v[k]];
        }
        m->nt++;
    }
done:
    pm_free(p);
    pm_free(same);
    pm_free(node);
    return status;
}

/* One closed surface, its normals outward. */
static enum pm_status check(const char *path, struct pm_trimesh *m, struct pm_err *err)
{
    struct pm_star star = {0};
    struct pm_err why = {0};
    enum pm_status status = pm_star_new(m, &star, &why);

    if (status == PM_OK)
        status = pm_trimesh_check(m, &star, 0, &why);
    pm_star_release(&star);
    if (status != PM_OK)
        return pm_fail(err, status, "cannot use '%s': %s", path, why.text);
    if (pm_collide_volume(m->x, m->nt, m->tri) < 0)
        for (ptrdiff_t t = 0; t < m->nt; t++) {
            int32_t a = m->tri[3 * t];
            m->tri[3 * t] = m->tri[3 * t + 1];
            m->tri[3 * t + 1] = a;
        }
    return PM_OK;
}

enum pm_status pm_trimesh_read(const char *path, struct pm_trimesh *m, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct reader r = {.path = path};
    size_t length = strlen(path);

    memset(m, 0, sizeof *m);
    PM_TRY(load(&r, err));
    if (length > 4 &&
        (strcmp(path + length - 4, ".obj") == 0 || strcmp(path + length - 4, ".OBJ") == 0))
        PM_TRY(read_obj(&r, err));
    else if (is_binary(&r))
        PM_TRY(read_binary(&r, err));
    else
        PM_TRY(read_text(&r, err));
    PM_TRY(merge(&r, m, err));
    PM_TRY(check(path, m, err));
done:
    pm_free(r.text);
    pm_free(r.x);
    pm_free(r.id);
    if (status != PM_OK)
        pm_trimesh_release(m);
    return status;
}
