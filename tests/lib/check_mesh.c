/* check_mesh MESH.h5 SURF.h5 TOLERANCE: does the mesh keep what its record promises for these
 * surfaces? Says what it does not and ends with 1; prints the volumes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "common/files/surfaces.h"
#include "common/geometry/distance.h"
#include "common/mechanics/tet10.h"
#include "tools/tetmesh/curve.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/mirror.h"
#include "tools/tetmesh/quality.h"

static int bad;

static void expect(int good, const char *what, double got, double want)
{
    if (!good)
        printf("%s: got %.17g, want %.17g\n", what, got, want);
    bad |= !good;
}

/* x = W phi and W 1 = 1 (rounding of sums of some hundred terms), rows where and only where they
 * belong. */
static void check_weights(const struct pm_mesh *m, const double *phi, unsigned char *on)
{
    double worst = 0, worst_sum = 0;
    ptrdiff_t misplaced = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int k = 0; k < 6; k++)
            on[m->tri[6 * f + k]] |= m->tri_tag[f] >= 0 ? 1 : 0;
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        double r[3] = {0}, sum = 0;
        misplaced += (m->wptr[a + 1] > m->wptr[a]) != on[a] || (m->surface[a] >= 0) != on[a];
        for (int64_t k = m->wptr[a]; k < m->wptr[a + 1]; k++) {
            sum += m->wval[k];
            for (int i = 0; i < 3; i++)
                r[i] += m->wval[k] * phi[3 * m->wcol[k] + i];
        }
        for (int i = 0; i < 3 && on[a]; i++)
            worst = fmax(worst, fabs(r[i] - m->x[3 * a + i]));
        worst_sum = fmax(worst_sum, on[a] ? fabs(sum - 1) : 0);
    }
    expect(worst <= 1e-11, "largest |W phi - x| [mm]", worst, 0);
    expect(worst_sum <= 1e-13, "largest |W 1 - 1|", worst_sum, 0);
    expect(misplaced == 0, "nodes with misplaced weights", (double)misplaced, 0);
}

/* Flux of x / 3 through the faces with low <= tag <= high: exact for tri6 (degree 4). */
static double flux(const struct pm_mesh *m, int low, int high)
{
    double sum = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int q = 0; q < PM_TRI_POINTS && m->tri_tag[f] >= low && m->tri_tag[f] <= high; q++) {
            double N[6], dN[12], x[3] = {0}, u[3] = {0}, v[3] = {0};
            pm_tri6_shape(pm_tri_xi[q], N, dN);
            for (int a = 0; a < 6; a++)
                for (int i = 0; i < 3; i++) {
                    const double X = m->x[3 * m->tri[6 * f + a] + i];
                    x[i] += N[a] * X;
                    u[i] += dN[2 * a] * X;
                    v[i] += dN[2 * a + 1] * X;
                }
            sum += pm_tri_weight[q] *
                   (x[0] * (u[1] * v[2] - u[2] * v[1]) + x[1] * (u[2] * v[0] - u[0] * v[2]) +
                    x[2] * (u[0] * v[1] - u[1] * v[0])) /
                   3;
        }
    return sum;
}

static void check_volumes(const struct pm_mesh *m, const struct pm_surfaces *s, const double *phi,
                          double tolerance)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_samples samples = {0};
    const unsigned planes = pm_mirrors_of(m);
    const double parts = (planes & 1 ? 2 : 1) * (planes & 2 ? 2 : 1); /* alike */
    double volume = 0;
    for (ptrdiff_t e = 0; e < m->ne; e++) {
        double X[30], b[20];
        pm_quality_gather(m, m->x, e, X);
        pm_quality_bernstein(X, b);
        for (int k = 0; k < 20; k++)
            volume += b[k] / 120;
    }
    const double through = flux(m, -100, 100);
    /* the divergence theorem is exact for these polynomials: rounding only */
    expect(fabs(through - volume) <= 1e-10 * volume, "volume by the boundary [mm3]", through,
           volume);
    printf("body: %.3f mm3 in the mesh\n", volume);
    expect(pm_samples_new(s, 1, 1, &samples, &err) == PM_OK, err.text, 0, 0);
    for (int k = 1; k < s->ns; k++) {
        const double mesh = -parts * flux(m, k, k), exact = pm_samples_volume(&samples, phi, k);
        printf("chamber %d: %.3f mm3 in the mesh, %.3f mm3 of the surface\n", k, mesh, exact);
        expect(fabs(mesh - exact) <= tolerance * exact, "volume of a chamber [mm3]", mesh, exact);
    }
    pm_samples_release(&samples);
}

static void check_elements(const struct pm_mesh *m)
{
    struct pm_err err = {.status = PM_OK};
    int32_t *vertices = pm_calloc(4 * m->ne, sizeof *vertices, &err), *face = NULL, *element = NULL;
    double scaled, mean_ratio;
    ptrdiff_t n = 0;
    for (ptrdiff_t k = 0; k < 4 * m->ne && vertices != NULL; k++)
        vertices[k] = m->tet[10 * (k / 4) + k % 4];
    expect(vertices != NULL &&
               pm_boundary_faces(m->ne, vertices, &n, &face, &element, &err) == PM_OK,
           err.text, 0, 0);
    expect(n == m->nf, "free faces", (double)n, (double)m->nf);
    pm_curve_quality(m, m->x, &scaled, &mean_ratio);
    expect(scaled == m->min_jacobian, "smallest scaled Jacobian", scaled, m->min_jacobian);
    expect(scaled >= (m->origin == PM_ORIGIN_GENERATED ? pm_curve_bound - 1e-9 : 0.1),
           "smallest scaled Jacobian", scaled, 0.1);
    pm_free(vertices);
    pm_free(face);
    pm_free(element);
}

/* Base and tip are planar, lie at z = 0 and z = H, and face away from the body. */
static void check_caps(const struct pm_mesh *m)
{
    double worst = 0, H = m->pcase.height;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int k = 0; k < 6 && m->tri_tag[f] < 0 && m->tri_tag[f] >= PM_FACE_TIP; k++)
            worst = fmax(worst, fabs(m->x[3 * m->tri[6 * f + k] + 2] -
                                     (m->tri_tag[f] == PM_FACE_TIP ? H : 0)));
    expect(worst <= 1e-12 * H, "caps off their planes [mm]", worst, 0);
    expect(flux(m, PM_FACE_TIP, PM_FACE_TIP) > 0, "flux through the tip",
           flux(m, PM_FACE_TIP, PM_FACE_TIP), 1);
}

/* Nodes of mirror planes are on them exactly. */
static void check_planes(const struct pm_mesh *m)
{
    double worst = 0;
    for (ptrdiff_t f = 0; f < m->nf; f++)
        for (int k = 0; k < 6 && m->tri_tag[f] <= PM_FACE_SYM_X; k++)
            worst = fmax(worst, fabs(m->x[3 * m->tri[6 * f + k] + PM_FACE_SYM_X - m->tri_tag[f]]));
    expect(worst == 0, "off the mirror plane [mm]", worst, 0);
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh m;
    struct pm_surfaces s;
    if (argc != 4 || pm_mesh_load(argv[1], 0, &m, &err) != PM_OK ||
        pm_surfaces_load(argv[2], &s, &err) != PM_OK) {
        fprintf(stderr, "check_mesh: %s\n", err.text);
        return 1;
    }
    double *phi = pm_calloc(3 * s.offset[s.ns], sizeof *phi, &err);
    unsigned char *on = pm_calloc(m.nn, 1, &err);
    if (phi == NULL || on == NULL)
        return 1;
    pm_surfaces_gather(&s, phi);
    check_weights(&m, phi, on);
    check_volumes(&m, &s, phi, strtod(argv[3], NULL));
    check_elements(&m);
    check_caps(&m);
    check_planes(&m);
    pm_free(phi);
    pm_free(on);
    pm_mesh_release(&m);
    pm_surfaces_release(&s);
    return bad;
}
