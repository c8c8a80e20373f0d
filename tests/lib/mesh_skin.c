/* What refit.sh takes from a mesh without symmetry planes, whose base lies in z = 0:
 *   mesh_skin obj MESH.h5 PREFIX          the boundary as PREFIX/body.obj, PREFIX/chamber1.obj ..,
 *                                         curved triangles as four; prints height, radius of the
 *                                         cylinder of equal volume and height, area of the side
 *                                         wall [mm, mm2], then a point inside each chamber
 *   mesh_skin straight MESH.h5 FILE.msh   its vertices alone: tetrahedra of 4 nodes, gmsh 2.2
 *   mesh_skin moved MESH.h5 FILE.msh SURF.h5   all its nodes, those of chambers and side wall at
 * the nearest points of these surfaces, the inner ones after them mesh_skin sizes MESH.h5
 * tetrahedra, mean edge [mm], volume of the body [mm3] */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/geometry/cloud.h"
#include "common/geometry/distance.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/curve.h"
#include "tools/tetmesh/quality.h"

static const double pi = 3.14159265358979323846;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *c)
{
    for (int i = 0; i < 3; i++)
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Triangles `part` of face f: vertices (3). */
static void part_of(const struct pm_mesh *m, ptrdiff_t f, int part, int32_t v[3])
{
    static const int corner[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    for (int k = 0; k < 3; k++)
        v[k] = m->tri[m->npf * f + (m->npf == 6 ? corner[part][k] : k)];
}

/* Where the line from o along d crosses a triangle: the distance in units of d, INFINITY where it
 * does not or where that is behind o. */
static double crossing(const double *o, const double *d, const double *a, const double *b,
                       const double *c)
{
    double u[3], v[3], w[3], n[3], k[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
        w[i] = o[i] - a[i];
    }
    cross(u, v, n);
    const double det = -dot(d, n);
    if (fabs(det) < DBL_MIN)
        return INFINITY;
    cross(w, d, k);
    const double s = dot(v, k) / det, r = -dot(u, k) / det, t = dot(w, n) / det;
    return s < 0 || r < 0 || s + r > 1 || t < 1e-9 ? (double)INFINITY : t;
}

/* The middle of the first chord of the chamber from its first face inwards: it lies in the air. */
static void point_inside(const struct pm_mesh *m, int32_t chamber, double at[3])
{
    double nearest = INFINITY, o[3], u[3], v[3], d[3];
    int32_t c[3];
    ptrdiff_t first = 0;
    while (m->tri_tag[first] != chamber)
        first++;
    part_of(m, first, 3, c);
    for (int i = 0; i < 3; i++) {
        const double a = m->x[3 * c[0] + i], b = m->x[3 * c[1] + i], e = m->x[3 * c[2] + i];
        o[i] = (a + b + e) / 3;
        u[i] = b - a;
        v[i] = e - a;
    }
    cross(u, v, d); /* out of the solid */
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int part = 0; part < (m->npf == 6 ? 4 : 1) && m->tri_tag[f] == chamber; part++) {
            if (f == first && part == 3)
                continue;
            part_of(m, f, part, c);
            nearest =
                fmin(nearest, crossing(o, d, m->x + 3 * c[0], m->x + 3 * c[1], m->x + 3 * c[2]));
        }
    for (int i = 0; i < 3; i++)
        at[i] = o[i] + nearest / 2 * d[i];
}

/* Chamber 0 is the body: base, tip and side wall. Chambers outward, against the mesh. */
static int write_obj(const struct pm_mesh *m, int32_t chamber, const char *path, int32_t *id)
{
    FILE *file = fopen(path, "w");
    int32_t n = 0, v[3];
    if (file == NULL)
        return 0;
    memset(id, 0, (size_t)m->nn * sizeof *id);
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int part = 0; part < (m->npf == 6 ? 4 : 1); part++) {
            if (chamber == 0 ? m->tri_tag[f] > 0 : m->tri_tag[f] != chamber)
                continue;
            part_of(m, f, part, v);
            for (int k = 0; k < 3; k++) {
                const double *x = m->x + 3 * v[k];
                if (id[v[k]] == 0) {
                    id[v[k]] = ++n;
                    fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
                }
            }
            fprintf(file, "f %d %d %d\n", id[v[0]], id[v[chamber > 0 ? 2 : 1]],
                    id[v[chamber > 0 ? 1 : 2]]);
        }
    return fclose(file) == 0;
}

static enum pm_status obj(const struct pm_mesh *m, const char *prefix, struct pm_err *err)
{
    enum pm_status status;
    int32_t *id = NULL;
    double side = 0, volume = 0, height = 0;
    PM_TRY(PM_NEW(id, m->nn, err));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        height = fmax(height, m->x[3 * a + 2]);
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const double z = m->x[3 * m->tri[m->npf * f] + 2];
        double area = 0, moment[3] = {0};
        if (m->tri_tag[f] <= PM_FACE_SYM_X)
            PM_TRY(pm_fail(err, PM_INPUT, "found a symmetry plane, expected a whole body"));
        if (z < -1e-9 * height || (m->tri_tag[f] == PM_FACE_BASE && z > 1e-9 * height))
            PM_TRY(pm_fail(err, PM_INPUT, "found z = %g mm, expected the base in z = 0", z));
        if (m->tri_tag[f] == PM_FACE_TIP && z < (1 - 1e-9) * height)
            PM_TRY(pm_fail(err, PM_INPUT, "found the tip at z = %g mm, expected %g", z, height));
        const double flux = pm_quality_face(m, f, &area, moment);
        side += m->tri_tag[f] == PM_FACE_EXTERIOR ? area : 0;
        volume += m->tri_tag[f] <= 0 ? flux : 0;
    }
    printf("%.17g %.9g %.9g\n", height, sqrt(volume / pi / height), side);
    for (int32_t k = 0; k <= m->nc; k++) {
        char path[4096], name[32] = "body";
        double at[3];
        if (k > 0) {
            snprintf(name, sizeof name, "chamber%d", k);
            point_inside(m, k, at);
            printf("%.9g %.9g %.9g\n", at[0], at[1], at[2]);
        }
        snprintf(path, sizeof path, "%s/%s.obj", prefix, name);
        if (!write_obj(m, k, path, id))
            PM_TRY(pm_fail(err, PM_SYSTEM, "cannot write '%s'", path));
    }
done:
    pm_free(id);
    return status;
}

/* npe: nodes of a tetrahedron that are written, 10 or 4. */
static enum pm_status write_msh(const struct pm_mesh *m, int npe, const char *path,
                                struct pm_err *err)
{
    enum pm_status status;
    const int npf = npe == 10 ? 6 : 3;
    int32_t *id = NULL, n = 0;
    FILE *file = fopen(path, "w");
    if (file == NULL)
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot write '%s'", path));
    PM_TRY(PM_NEW(id, m->nn, err));
    for (ptrdiff_t k = 0; k < npe * m->ne; k++) {
        int32_t *i = &id[m->tet[m->npe * (k / npe) + k % npe]];
        *i = *i == 0 ? ++n : *i;
    }
    fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%td\n3 1 \"body\"\n",
            m->nc + 4);
    fprintf(file, "2 2 \"base\"\n2 3 \"tip\"\n2 4 \"exterior\"\n");
    for (ptrdiff_t k = 1; k <= m->nc; k++)
        fprintf(file, "2 %td \"chamber%td\"\n", 4 + k, k);
    fprintf(file, "$EndPhysicalNames\n$Nodes\n%d\n", n);
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (id[a] > 0)
            fprintf(file, "%d %.17g %.17g %.17g\n", id[a], m->x[3 * a], m->x[3 * a + 1],
                    m->x[3 * a + 2]);
    fprintf(file, "$EndNodes\n$Elements\n%td\n", m->nf + m->ne);
    for (ptrdiff_t f = 0; f < m->nf; f++) {
        const int32_t *v = m->tri + m->npf * f, tag = m->tri_tag[f];
        const int32_t group = tag == PM_FACE_BASE ? 2 : tag == PM_FACE_TIP ? 3 : 4 + tag;
        fprintf(file, "%td %d 2 %d %d", f + 1, npf == 6 ? 9 : 2, group, group);
        for (int k = 0; k < npf; k++)
            fprintf(file, " %d", id[v[k]]);
        fprintf(file, "\n");
    }
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        const int32_t *v = m->tet + m->npe * e;
        fprintf(file, "%td %d 2 1 1", m->nf + e + 1, npe == 10 ? 11 : 4);
        for (int k = 0; k < npe; k++)
            fprintf(file, " %d", id[v[k]]);
        fprintf(file, "\n");
    }
    fprintf(file, "$EndElements\n");
done:
    pm_free(id);
    if (file != NULL && fclose(file) != 0 && status == PM_OK)
        status = pm_fail(err, PM_SYSTEM, "cannot write '%s'", path);
    return status;
}

/* Displacements u (nn x 3) [mm] to the nearest points of surface k of the nodes with its tag;
 * known: 1 where u is given. */
static enum pm_status to_surface(const struct pm_mesh *m, const struct pm_surfaces *s, int32_t k,
                                 const struct pm_samples *samples, double *u, uint8_t *known,
                                 struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *surface = &s->s[k];
    const ptrdiff_t first = samples->first[k], n = samples->first[k + 1] - first;
    struct pm_map *map = NULL;
    struct pm_cloud *to = NULL, *from = NULL;
    struct pm_basis work = {0};
    double *phi = NULL, *x = NULL, *far = NULL;
    uint8_t *wanted = NULL;
    int32_t *found = NULL;
    const struct pm_look look = {.cutoff = INFINITY};

    PM_TRY(PM_NEW(phi, 3 * s->offset[s->ns], err));
    PM_TRY(PM_NEW(x, 3 * samples->n, err));
    PM_TRY(PM_NEW(far, m->nn, err));
    PM_TRY(PM_NEW(found, m->nn, err));
    PM_TRY(PM_NEW(wanted, m->nn, err));
    pm_surfaces_gather(s, phi);
    pm_samples_all(samples, phi, x, NULL);
    PM_TRY(pm_map_new(surface, &map, err));
    PM_TRY(pm_cloud_new(n, x + 3 * first, NULL, &to, err));
    PM_TRY(pm_cloud_new(m->nn, m->x, NULL, &from, err));
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (ptrdiff_t j = 0; j < m->npf && m->tri_tag[f] == (k > 0 ? k : PM_FACE_EXTERIOR); j++)
            wanted[m->tri[m->npf * f + j]] = 1;
    pm_cloud_look(from, wanted, to, &look, found, far);
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        double S[3], r[3], d;
        if (!wanted[a])
            continue;
        memcpy(S, &samples->S[3 * (first + found[a])], sizeof S);
        PM_TRY(pm_distance_project(map, surface->type, surface->phi, &m->x[3 * a], &work, S, r, &d,
                                   err));
        for (int i = 0; i < (known[a] ? 2 : 3); i++) /* rims keep their planes */
            u[3 * a + i] = r[i] - m->x[3 * a + i];
        known[a] = 1;
    }
done:
    pm_map_free(map);
    pm_cloud_free(to);
    pm_cloud_free(from);
    pm_basis_release(&work);
    pm_free(phi);
    pm_free(x);
    pm_free(far);
    pm_free(wanted);
    pm_free(found);
    return status;
}

/* Every vertex that is not known goes by the mean of its neighbours, swept until that settles,
 * mid-side nodes by the mean of the ends. */
static enum pm_status spread(const struct pm_mesh *m, const uint8_t *known, double *u,
                             struct pm_err *err)
{
    enum pm_status status = PM_OK;
    double *sum = NULL, *count = NULL;

    PM_TRY(PM_NEW(sum, 3 * m->nn, err));
    PM_TRY(PM_NEW(count, m->nn, err));
    for (int sweep = 0; sweep < 100; sweep++) {
        memset(sum, 0, 3 * (size_t)m->nn * sizeof *sum);
        memset(count, 0, (size_t)m->nn * sizeof *count);
        for (ptrdiff_t k = 0; k < 16 * m->ne; k++) {
            const int32_t *v = m->tet + m->npe * (k / 16), a = v[k % 4], b = v[k / 4 % 4];
            for (int i = 0; i < 3 && a != b; i++)
                sum[3 * a + i] += u[3 * b + i];
            count[a] += a != b;
        }
        for (ptrdiff_t k = 0; k < 3 * m->nn; k++)
            u[k] = known[k / 3] || !(count[k / 3] > 0) ? u[k] : sum[k] / count[k / 3];
    }
    for (ptrdiff_t k = 0; k < 6 * m->ne && m->npe == 10; k++) {
        const int32_t *v = m->tet + 10 * (k / 6), *ends = pm_tet10_edge[k % 6];
        for (int i = 0; i < 3 && !known[v[4 + k % 6]]; i++)
            u[3 * v[4 + k % 6] + i] = (u[3 * v[ends[0]] + i] + u[3 * v[ends[1]] + i]) / 2;
    }
done:
    pm_free(sum);
    pm_free(count);
    return status;
}

/* Elements that curved sides would spoil get straight ones; returns how many. */
static ptrdiff_t straighten(struct pm_mesh *m)
{
    ptrdiff_t count = 0;
    int bad = m->npe == 10;

    for (int sweep = 0; sweep < 20 && bad; sweep++) {
        bad = 0;
        for (ptrdiff_t e = 0; e < m->ne; e++) {
            const int32_t *v = m->tet + 10 * e;
            double X[30], chord[30];
            pm_quality_gather(m, m->x, e, X);
            if (pm_quality_scaled(X) >= pm_curve_bound)
                continue;
            memcpy(chord, X, sizeof X);
            for (int k = 0; k < 18; k++)
                chord[12 + k] = (X[3 * pm_tet10_edge[k / 3][0] + k % 3] +
                                 X[3 * pm_tet10_edge[k / 3][1] + k % 3]) /
                                2;
            for (int k = 12; k < 30; k++)
                m->x[3 * v[k / 3] + k % 3] = chord[k];
            if (memcmp(chord, X, sizeof X) != 0) {
                bad = 1;
                count++;
            }
        }
    }
    return count;
}

static enum pm_status moved(struct pm_mesh *m, const char *path, const char *surfaces,
                            struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_surfaces s = {0};
    struct pm_samples samples = {0};
    double *u = NULL;
    uint8_t *known = NULL;

    PM_TRY(pm_surfaces_load(surfaces, &s, err));
    if (s.ns != m->nc + 1)
        PM_TRY(pm_fail(err, PM_INPUT, "found %td surfaces, expected %td", s.ns, m->nc + 1));
    PM_TRY(pm_samples_new(&s, HUGE_VAL, 2, &samples, err));
    PM_TRY(PM_NEW(u, 3 * m->nn, err));
    PM_TRY(PM_NEW(known, m->nn, err));
    for (ptrdiff_t k = 0; k < m->npf * m->nf; k++)
        if (m->tri_tag[k / m->npf] == PM_FACE_BASE || m->tri_tag[k / m->npf] == PM_FACE_TIP)
            known[m->tri[k]] = 1;
    for (int32_t k = 0; k < s.ns; k++)
        PM_TRY(to_surface(m, &s, k, &samples, u, known, err));
    PM_TRY(spread(m, known, u, err));
    for (ptrdiff_t k = 0; k < 3 * m->nn; k++)
        m->x[k] += u[k];
    printf("%td\n", straighten(m));
    PM_TRY(write_msh(m, (int)m->npe, path, err));
done:
    pm_surfaces_release(&s);
    pm_samples_release(&samples);
    pm_free(u);
    pm_free(known);
    return status;
}

static void sizes(const struct pm_mesh *m)
{
    double edges = 0, volume = 0, area = 0, moment[3] = {0};
    for (ptrdiff_t e = 0; e < m->ne; e++)
        for (int k = 0; k < 6; k++) {
            const int32_t *v = m->tet + m->npe * e;
            double d[3];
            for (int i = 0; i < 3; i++)
                d[i] = m->x[3 * v[pm_tet10_edge[k][0]] + i] - m->x[3 * v[pm_tet10_edge[k][1]] + i];
            edges += sqrt(dot(d, d));
        }
    for (ptrdiff_t f = 0; f < m->nf; f++)
        volume += pm_quality_face(m, f, &area, moment);
    printf("%td %.6g %.9g\n", m->ne, edges / (6 * (double)m->ne), volume);
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh m = {.nn = 0};
    enum pm_status status = PM_USAGE;
    const char *what = argc > 1 ? argv[1] : "";

    if (argc == (strcmp(what, "sizes") == 0 ? 3 : strcmp(what, "moved") == 0 ? 5 : 4))
        status = pm_mesh_load(argv[2], 0, &m, &err);
    if (status == PM_OK && strcmp(what, "obj") == 0)
        status = obj(&m, argv[3], &err);
    else if (status == PM_OK && strcmp(what, "straight") == 0)
        status = write_msh(&m, 4, argv[3], &err);
    else if (status == PM_OK && strcmp(what, "moved") == 0)
        status = moved(&m, argv[3], argv[4], &err);
    else if (status == PM_OK && strcmp(what, "sizes") == 0)
        sizes(&m);
    if (status != PM_OK)
        fprintf(stderr, "mesh_skin: cannot use '%s': %s\n", argc > 2 ? argv[2] : "", err.text);
    pm_mesh_release(&m);
    return (int)status;
}
