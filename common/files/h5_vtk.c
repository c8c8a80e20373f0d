/* The VTKHDF side of a file: an UnstructuredGrid of lines, of triangles or of linear or quadratic
 * tetrahedra. */
#include <stdio.h>

#include "common/base/memory.h"
#include "common/files/h5.h"

enum { VTK_LINE = 3, VTK_TRIANGLE = 5, VTK_TETRA = 10, VTK_QUADRATIC_TETRA = 24 };

/* VTK numbers the edges (01)(12)(20)(30)(13)(23): the last two of ours swapped. */
static const int vtk_order[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

static enum pm_status put_cells(struct pm_h5 *f, ptrdiff_t ne, ptrdiff_t npe, const int32_t *tet,
                                struct pm_err *err)
{
    enum pm_status status;
    int64_t *node = NULL, *offset = NULL;
    uint8_t *type = NULL;
    PM_TRY(PM_NEW(node, npe * ne, err));
    PM_TRY(PM_NEW(offset, ne + 1, err));
    PM_TRY(PM_NEW(type, ne, err));
    for (ptrdiff_t e = 0; e < ne; e++) {
        for (ptrdiff_t a = 0; a < npe; a++)
            node[npe * e + a] = tet[npe * e + vtk_order[a]];
        offset[e + 1] = npe * (e + 1);
        type[e] = npe == 2   ? VTK_LINE
                  : npe == 3 ? VTK_TRIANGLE
                  : npe == 4 ? VTK_TETRA
                             : VTK_QUADRATIC_TETRA;
    }
    PM_TRY(pm_h5_put(f, "/VTKHDF/Connectivity", (const ptrdiff_t[]){npe * ne}, node, err));
    PM_TRY(pm_h5_put(f, "/VTKHDF/Offsets", (const ptrdiff_t[]){ne + 1}, offset, err));
    PM_TRY(pm_h5_put(f, "/VTKHDF/Types", (const ptrdiff_t[]){ne}, type, err));
done:
    pm_free(node);
    pm_free(offset);
    pm_free(type);
    return status;
}

enum pm_status pm_h5_put_vtk(struct pm_h5 *f, const char *points, ptrdiff_t nn, ptrdiff_t ne,
                             ptrdiff_t npe, const int32_t *tet, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t one = 1;
    const int64_t points_count = nn, cells = ne, ids = npe * ne;
    PM_TRY(pm_h5_put(f, "/VTKHDF/NumberOfPoints", &one, &points_count, err));
    PM_TRY(pm_h5_put(f, "/VTKHDF/NumberOfCells", &one, &cells, err));
    PM_TRY(pm_h5_put(f, "/VTKHDF/NumberOfConnectivityIds", &one, &ids, err));
    PM_TRY(put_cells(f, ne, npe, tet, err));
    PM_TRY(pm_h5_link(f, points, "/VTKHDF/Points", err));
    PM_TRY(pm_h5_mark_vtk(f, "UnstructuredGrid", err));
done:
    return status;
}

enum pm_status pm_h5_vtk_point_field(struct pm_h5 *f, const char *dataset, const char *label,
                                     struct pm_err *err)
{
    char name[128];
    snprintf(name, sizeof name, "/VTKHDF/PointData/%s", label);
    return pm_h5_link(f, dataset, name, err);
}

enum pm_status pm_h5_vtk_cell_field(struct pm_h5 *f, const char *dataset, const char *label,
                                    struct pm_err *err)
{
    char name[128];
    snprintf(name, sizeof name, "/VTKHDF/CellData/%s", label);
    return pm_h5_link(f, dataset, name, err);
}
