#include "tools/surfexport/write.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/atomic.h"

enum pm_status write_format_of(const char *path, enum write_format *format, struct pm_err *err)
{
    static const struct {
        const char *suffix;
        enum write_format format;
    } known[] = {{".stl", WRITE_STL},
                 {".obj", WRITE_OBJ},
                 {".msh", WRITE_MSH},
                 {".h5", WRITE_VTK},
                 {".vtkhdf", WRITE_VTK}};
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot != NULL && k < sizeof known / sizeof *known; k++)
        if (strcmp(dot, known[k].suffix) == 0) {
            *format = known[k].format;
            return PM_OK;
        }
    return pm_fail(err, PM_USAGE,
                   "option -o: found '%s', expected a name that ends in .stl, .obj, .msh, .h5 or "
                   ".vtkhdf",
                   path);
}

/* ---- STL ---- */

static void unit_normal(const struct skin *s, ptrdiff_t t, double n[3])
{
    skin_normal(s, t, n);
    const double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        n[i] = l > 0 ? n[i] / l : 0;
}

/* Little endian, as the format wants. */
static void put32(unsigned char *to, uint32_t v)
{
    for (int k = 0; k < 4; k++)
        to[k] = (unsigned char)(v >> (8 * k));
}

static void put_float(unsigned char *to, double v)
{
    const float f = (float)v;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    put32(to, bits);
}

static void write_stl(const struct skin *s, const char *name, FILE *out)
{
    unsigned char head[84] = {0}, facet[50];
    snprintf((char *)head, 80, "pneumorph %s, mm", name);
    put32(head + 80, (uint32_t)s->nt);
    fwrite(head, 1, sizeof head, out);
    memset(facet, 0, sizeof facet);
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double n[3];
        unit_normal(s, t, n);
        for (int i = 0; i < 12; i++)
            put_float(facet + 4 * i, i < 3 ? n[i] : s->x[3 * s->tri[3 * t + i / 3 - 1] + i % 3]);
        fwrite(facet, 1, sizeof facet, out);
    }
}

static void write_stl_ascii(const struct skin *s, const char *name, FILE *out)
{
    fprintf(out, "solid %s\n", name);
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        double n[3];
        unit_normal(s, t, n);
        fprintf(out, "facet normal %.6e %.6e %.6e\nouter loop\n", n[0], n[1], n[2]);
        for (int k = 0; k < 3; k++) {
            const double *x = s->x + 3 * (ptrdiff_t)s->tri[3 * t + k];
            fprintf(out, "vertex %.8e %.8e %.8e\n", x[0], x[1], x[2]);
        }
        fprintf(out, "endloop\nendfacet\n");
    }
    fprintf(out, "endsolid %s\n", name);
}

/* ---- groups ---- */

/* The distinct tags in the order of the file: exterior, base, tip, chambers, others. */
static int order_of(int32_t tag)
{
    return tag > 0 ? 2 + tag : tag > SKIN_MOULD ? -tag : 1000 - tag;
}

static ptrdiff_t tags_of(const struct skin *s, ptrdiff_t max, int32_t *tag)
{
    ptrdiff_t n = 0;
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        ptrdiff_t k = 0;
        while (k < n && tag[k] != s->tag[t])
            k++;
        if (k < n || n == max)
            continue;
        for (n++; k > 0 && order_of(tag[k - 1]) > order_of(s->tag[t]); k--)
            tag[k] = tag[k - 1];
        tag[k] = s->tag[t];
    }
    return n;
}

enum { MAX_TAGS = PM_MAX_CHAMBERS + 8 };

static void write_obj(const struct skin *s, const char *name, FILE *out)
{
    int32_t tag[MAX_TAGS];
    char group[32];
    const ptrdiff_t n = tags_of(s, MAX_TAGS, tag);
    fprintf(out, "# pneumorph, mm\no %s\n", name);
    for (ptrdiff_t a = 0; a < s->nn; a++)
        fprintf(out, "v %.9g %.9g %.9g\n", s->x[3 * a], s->x[3 * a + 1], s->x[3 * a + 2]);
    for (ptrdiff_t k = 0; k < n; k++) {
        fprintf(out, "g %s\n", skin_tag_name(tag[k], group));
        for (ptrdiff_t t = 0; t < s->nt; t++)
            if (s->tag[t] == tag[k])
                fprintf(out, "f %d %d %d\n", s->tri[3 * t] + 1, s->tri[3 * t + 1] + 1,
                        s->tri[3 * t + 2] + 1);
    }
}

/* Format 2.2: physical group and surface of a triangle have the number of its tag. */
static void write_msh(const struct skin *s, FILE *out)
{
    int32_t tag[MAX_TAGS];
    char group[32];
    const ptrdiff_t n = tags_of(s, MAX_TAGS, tag);
    ptrdiff_t number = 0;
    fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%td\n", n);
    for (ptrdiff_t k = 0; k < n; k++)
        fprintf(out, "2 %td \"%s\"\n", k + 1, skin_tag_name(tag[k], group));
    fprintf(out, "$EndPhysicalNames\n$Nodes\n%td\n", s->nn);
    for (ptrdiff_t a = 0; a < s->nn; a++)
        fprintf(out, "%td %.17g %.17g %.17g\n", a + 1, s->x[3 * a], s->x[3 * a + 1],
                s->x[3 * a + 2]);
    fprintf(out, "$EndNodes\n$Elements\n%td\n", s->nt);
    for (ptrdiff_t k = 0; k < n; k++)
        for (ptrdiff_t t = 0; t < s->nt; t++)
            if (s->tag[t] == tag[k])
                fprintf(out, "%td 2 2 %td %td %d %d %d\n", ++number, k + 1, k + 1,
                        s->tri[3 * t] + 1, s->tri[3 * t + 1] + 1, s->tri[3 * t + 2] + 1);
    fprintf(out, "$EndElements\n");
}

struct job {
    const struct skin *skin;
    enum write_format format;
    const char *name;
};

static enum pm_status write_job(void *data, FILE *out, struct pm_err *err)
{
    const struct job *j = data;
    (void)err;
    if (j->format == WRITE_STL)
        write_stl(j->skin, j->name, out);
    else if (j->format == WRITE_STL_ASCII)
        write_stl_ascii(j->skin, j->name, out);
    else if (j->format == WRITE_OBJ)
        write_obj(j->skin, j->name, out);
    else
        write_msh(j->skin, out);
    return PM_OK;
}

enum pm_status write_triangles(const struct skin *s, enum write_format format, const char *name,
                               const char *path, struct pm_err *err)
{
    struct job job = {.skin = s, .format = format, .name = name};
    return pm_atomic_write(path, write_job, &job, err);
}
