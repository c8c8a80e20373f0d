/* The n-th allocation fails, n = 1, 2, .. until none does: the kernels of tetmesh end cleanly. */
#include <string.h>

#include "common/geometry/collide.h"
#include "common/geometry/remesh.h"
#include "tests/robot.h"
#include "tests/tap.h"
#include "tools/tetmesh/edges.h"
#include "tools/tetmesh/import_check.h"
#include "tools/tetmesh/middle.h"
#include "tools/tetmesh/relocate.h"
#include "tools/tetmesh/split.h"
#include "tools/tetmesh/walls.h"
#include "tools/tetmesh/weights.h"

static struct pm_surfaces robot;

static enum pm_status remesh(struct pm_err *err)
{
    const struct pm_remesh_opts o = {
        .size = 8, .size_min = 4, .crest = 1.2, .growth = 0.35, .sweeps = 2};
    struct pm_patch p;
    struct pm_contact c;
    enum pm_status status = pm_remesh(&robot.s[1], 1, &o, &p, err);
    if (status == PM_OK)
        status = pm_collide_pierce(p.x, p.nt, p.tri, &c, err);
    pm_patch_release(&p);
    return status;
}

static enum pm_status edges(struct pm_err *err)
{
    static const int32_t tet[8] = {0, 1, 2, 3, 1, 2, 3, 4};
    struct pm_edges e;
    int32_t *face = NULL, *element = NULL;
    ptrdiff_t n = 0;
    enum pm_status status = pm_edges_new(5, 2, tet, &e, err);
    if (status == PM_OK)
        status = pm_boundary_faces(2, tet, &n, &face, &element, err);
    pm_edges_release(&e);
    pm_free(face);
    pm_free(element);
    return status;
}

static enum pm_status weights(struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_weights w = {0};
    struct pm_map *map = NULL;
    const double S[3] = {0, 0, 1};
    double x[3];
    PM_TRY(pm_weights_init(&w, &robot, 40, err));
    PM_TRY(pm_map_new(&robot.s[1], &map, err));
    for (int a = 0; a < 40; a++) {
        PM_TRY(pm_weights_add(&w, map, 1, S, 1, err));
        PM_TRY(pm_weights_close_row(&w, x, err));
    }
done:
    pm_map_free(map);
    pm_weights_release(&w);
    return status;
}

/* Four tetrahedra around the edge 0 1, the first with two faces on a chamber. */
static enum pm_status split(struct pm_err *err)
{
    static const double corner[18] = {0, 0, -1, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
    static const int32_t nodes[16] = {0, 1, 2, 3, 0, 1, 3, 4, 0, 1, 4, 5, 0, 1, 5, 2};
    static int32_t skin[6] = {0, 3, 2, 1, 2, 3}, tag[2] = {1, 1};
    const struct pm_shell shell = {.nn = 6, .nt = 2, .tri = skin, .tag = tag};
    enum pm_status status = PM_OK;
    struct pm_tetra t = {.nn = 6, .ne = 4};
    ptrdiff_t left;
    PM_TRY(PM_NEW(t.x, 18, err));
    PM_TRY(PM_NEW(t.tet, 16, err));
    memcpy(t.x, corner, sizeof corner);
    memcpy(t.tet, nodes, sizeof nodes);
    PM_TRY(pm_split_two_faces(&shell, &t, &left, err));
done:
    pm_free(t.x);
    pm_free(t.tet);
    return status;
}

/* Two 10-node tetrahedra on one face,
 * no boundary faces. */
static enum pm_status import_checks(struct pm_err *err)
{
    static const int32_t vertices[8] = {0, 1, 2, 3, 1, 2, 3, 4};
    static const int32_t tet[20] = {0, 1, 2, 3, 5, 6, 7,  8,  9,  10,
                                    1, 2, 3, 4, 6, 9, 10, 11, 12, 13};
    static int64_t tag[14];
    static double x[42];
    struct pm_mesh m = {.nn = 14, .ne = 2, .npe = 10, .npf = 6, .x = x, .tag = tag};
    enum pm_status status = PM_OK;
    for (int i = 0; i < 42; i++)
        x[i] = i;
    PM_TRY(PM_NEW(m.tet, 20, err));
    memcpy(m.tet, tet, sizeof tet);
    PM_TRY(pm_import_check_nodes(&m, err));
    PM_TRY(pm_import_check_parts(&m, vertices, err));
    PM_TRY(pm_import_check_middles(&m, vertices, err));
    PM_TRY(pm_import_check_closed(&m, err));
done:
    pm_free(m.tet);
    return status;
}

static enum pm_status relocate(struct pm_err *err)
{
    static int32_t tet[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    static double x[30];
    const struct pm_relocate_opts o = {0.1, 0.1, {NULL, NULL}};
    struct pm_mesh m = {.nn = 10, .ne = 1, .npe = 10, .npf = 6, .x = x, .tet = tet};
    ptrdiff_t left;
    for (int i = 0; i < 30; i++)
        x[i] = i % 7;
    return pm_relocate(&o, &m, &left, err);
}

static enum pm_status walls(struct pm_err *err)
{
    static double x[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, size[4] = {1, 1, 1, 1};
    static double S[12];
    static int32_t surface[4] = {-1, -1, -1, -1}, tri[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    static int32_t tag[4] = {-1, -1, -1, -1};
    const struct pm_shell shell = {
        .nn = 4, .nt = 4, .x = x, .size = size, .S = S, .surface = surface, .tri = tri, .tag = tag};
    struct pm_middles m = {.s = NULL};
    struct pm_shell bent = {.nn = 0};
    struct pm_walls w = {.bent = NULL};
    enum pm_status status = PM_OK;
    PM_TRY(pm_middles_init(&m, &robot, 0, err));
    PM_TRY(pm_shell_bend(&m, &shell, &bent, err));
    PM_TRY(pm_shell_check(&shell, &bent, 0, err));
    PM_TRY(pm_walls_init(&w, &bent, 1, 1, 1, err));
done:
    pm_walls_release(&w);
    pm_shell_release(&bent);
    pm_middles_release(&m);
    return status;
}

static void check(const char *name, enum pm_status (*job)(struct pm_err *err))
{
    enum pm_status status = PM_SYSTEM;
    int bad = 0, n;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        struct pm_err err = {.status = PM_OK};
        pm_memory_fail_at(n);
        status = job(&err);
        pm_memory_fail_at(0);
        bad += status != PM_OK &&
               !(status == PM_SYSTEM && err.status == PM_SYSTEM && err.text[0] != '\0');
    }
    ok(bad == 0 && status == PM_OK && n > 2, "%s: %d failures, then success", name, n - 2);
}

int main(void)
{
    struct pm_err err = {.status = PM_OK};
    const struct robot_chamber chamber = {{5, 0, 50}, {8, 11, 40}, 0};
    if (robot_init(&robot, 20, 100, 1, &chamber, &err) != PM_OK)
        return tap_bail("%s", err.text);
    check("remesh", remesh);
    check("edges and faces", edges);
    check("weights", weights);
    check("two-face tetrahedra", split);
    check("distances of walls", walls);
    check("better places", relocate);
    check("checks of an imported mesh", import_checks);
    pm_surfaces_release(&robot);
    return tap_done();
}
