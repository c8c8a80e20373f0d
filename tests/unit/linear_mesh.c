/* The mesh record of 4-node and of 10-node tetrahedra: it comes back, ParaView's group fits it, and
 * nothing between the two passes. */
#include <stdlib.h>
#include <unistd.h>

#include "tests/linear.h"
#include "tests/records.h"
#include "tests/tap.h"

#define SAME(a, b, n) (memcmp((a), (b), (size_t)(n) * sizeof *(a)) == 0)

static void expect_int(struct pm_h5 *f, const char *name, int64_t want)
{
    struct pm_err err = {.status = PM_OK};
    int64_t got = -1;
    ok(pm_h5_get_into(f, name, 1, &got, &err) == PM_OK && got == want, "%s: %lld, expected %lld%s",
       name, (long long)got, (long long)want, err.text);
}

/* The sizes that VTK's reader relies on, and the type of the only cell. */
static void test_vtk(const char *path, const struct pm_mesh *m)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_h5 *f = NULL;
    ptrdiff_t d[PM_MAX_RANK];
    int64_t *node = NULL, *offset = NULL;
    uint8_t *type = NULL;
    if (!ok(pm_h5_open(path, "mesh", &f, &err) == PM_OK, "open %s", err.text))
        return;
    expect_int(f, "/VTKHDF/NumberOfPoints", m->nn);
    expect_int(f, "/VTKHDF/NumberOfCells", m->ne);
    expect_int(f, "/VTKHDF/NumberOfConnectivityIds", m->npe * m->ne);
    if (ok(pm_h5_get(f, "/VTKHDF/Connectivity", d, &node, &err) == PM_OK && d[0] == m->npe * m->ne,
           "a cell has %td nodes %s", m->npe, err.text))
        ok(SAME(node, ((const int64_t[]){0, 1, 2, 3, 4, 5, 6, 7, 9, 8}), m->npe),
           "in the order of VTK");
    if (ok(pm_h5_get(f, "/VTKHDF/Offsets", d, &offset, &err) == PM_OK && d[0] == m->ne + 1,
           "offsets %s", err.text))
        ok(offset[0] == 0 && offset[1] == m->npe, "run over the connectivity");
    if (ok(pm_h5_get(f, "/VTKHDF/Types", d, &type, &err) == PM_OK && d[0] == m->ne, "types %s",
           err.text))
        ok(type[0] == (m->npe == 4 ? 10 : 24), "VTK type %d", type[0]);
    pm_free(node);
    pm_free(offset);
    pm_free(type);
    pm_h5_close(f);
}

static void test_record(const char *path, int linear)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh a, b;
    if (!ok(sample_mesh(&a, &err) == PM_OK, "%s mesh %s", linear ? "linear" : "quadratic",
            err.text))
        return;
    if (linear)
        sample_linear(&a);
    ok(sample_write(path, "mesh", &a, &err) == PM_OK, "write %s", err.text);
    if (ok(pm_mesh_load(path, 0, &b, &err) == PM_OK, "load %s", err.text)) {
        ok(b.npe == a.npe && b.npf == a.npf && b.nn == a.nn && b.ne == a.ne && b.nf == a.nf &&
               b.N == a.N,
           "%td and %td nodes per element and face", b.npe, b.npf);
        ok(SAME(a.x, b.x, 3 * a.nn) && SAME(a.tet, b.tet, a.npe * a.ne) &&
               SAME(a.tri, b.tri, a.npf * a.nf) && SAME(a.tri_tag, b.tri_tag, a.nf),
           "nodes and elements come back");
        pm_mesh_release(&b);
    }
    test_vtk(path, &a);
    pm_mesh_release(&a);
}

/* A record of these counts is written (nobody looks) and refused by the reader. */
static void refuse(const char *path, ptrdiff_t npe, ptrdiff_t npf, ptrdiff_t N, const char *want)
{
    struct pm_err err = {.status = PM_OK};
    struct pm_mesh a, b;
    if (!ok(sample_mesh(&a, &err) == PM_OK, "sample %s", err.text))
        return;
    if (npe < 10)
        sample_linear(&a);
    a.npe = npe;
    a.npf = npf;
    a.N = N;
    ok(sample_write(path, "mesh", &a, &err) == PM_OK, "write %td and %td nodes, N = %td %s", npe,
       npf, N, err.text);
    const int refused = pm_mesh_load(path, 0, &b, &err) == PM_INPUT;
    ok(refused && strstr(err.text, want) != NULL, "is refused: %s", err.text);
    if (!refused)
        pm_mesh_release(&b);
    pm_mesh_release(&a);
}

int main(void)
{
    char folder[] = "/tmp/pm-linear-XXXXXX", path[64];
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    snprintf(path, sizeof path, "%s/m.h5", folder);
    test_record(path, 0);
    test_record(path, 1);
    refuse(path, 5, 3, 0, "item '/mesh/tet' has 5 nodes in a row, expected 10 or 4");
    refuse(path, 4, 6, 0, "item '/mesh/tri' has 6 nodes in a row, expected 3");
    refuse(path, 10, 3, 28, "item '/mesh/tri' has 3 nodes in a row, expected 6");
    refuse(path, 4, 3, 28, "item '/mesh/control_points' is 28, expected 0");
    unlink(path);
    ok(rmdir(folder) == 0, "no temporary is left");
    return tap_done();
}
