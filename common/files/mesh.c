#include "common/files/mesh.h"

#include <math.h>

#include "common/base/memory.h"
#include "common/files/record.h"

static enum pm_status read_sizes(struct pm_h5 *f, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    int64_t nc, N;
    PM_TRY(pm_h5_get_int(f, "/mesh/chambers", &nc, err));
    PM_TRY(pm_h5_get_int(f, "/mesh/control_points", &N, err));
    if (nc < 0 || nc > PM_MAX_CHAMBERS)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/chambers", "is %lld, expected 0 to %d", (long long)nc,
                            (int)PM_MAX_CHAMBERS));
    if (m->pcase.nchambers > 0 && nc != m->pcase.nchambers)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/chambers", "is %lld, the case has %td", (long long)nc,
                            m->pcase.nchambers));
    if (N < 0 || N > INT32_MAX)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/control_points", "is %lld", (long long)N));
    m->nc = (ptrdiff_t)nc;
    m->N = (ptrdiff_t)N;
done:
    return status;
}

static enum pm_status read_arrays(struct pm_h5 *f, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_h5_get(f, "/mesh/x", d, &m->x, err));
    m->nn = d[0];
    PM_TRY(pm_h5_get(f, "/mesh/x_generated", d, &m->x_generated, err));
    PM_TRY(pm_h5_get(f, "/mesh/tet", d, &m->tet, err));
    m->ne = d[0];
    m->npe = d[1];
    PM_TRY(pm_h5_get(f, "/mesh/tri", d, &m->tri, err));
    m->nf = d[0];
    m->npf = d[1];
    PM_TRY(pm_h5_get(f, "/mesh/tri_tag", d, &m->tri_tag, err));
    PM_TRY(pm_h5_get(f, "/mesh/surface", d, &m->surface, err));
    PM_TRY(pm_h5_get(f, "/mesh/S", d, &m->S, err));
    PM_TRY(pm_h5_get(f, "/mesh/weight_ptr", d, &m->wptr, err));
    PM_TRY(pm_h5_get(f, "/mesh/weight_col", d, &m->wcol, err));
    m->nw = d[0];
    PM_TRY(pm_h5_get(f, "/mesh/weight_val", d, &m->wval, err));
    if (pm_h5_has(f, "/mesh/tag"))
        PM_TRY(pm_h5_get(f, "/mesh/tag", d, &m->tag, err));
    PM_TRY(pm_h5_get_double(f, "/mesh/max_damping", &m->max_damping, err));
    PM_TRY(pm_h5_get_double(f, "/mesh/min_jacobian", &m->min_jacobian, err));
    if (pm_h5_has(f, "/mesh/coarse"))
        PM_TRY(pm_h5_get_double(f, "/mesh/coarse", &m->coarse, err));
    PM_TRY(pm_h5_get_int(f, "/mesh/origin", &m->origin, err));
    PM_TRY(pm_h5_get_int(f, "/mesh/delaunay", &m->delaunay, err));
    PM_TRY(pm_h5_get_into(f, "/tip/reference_point", 3, m->reference_point, err));
done:
    return status;
}

static enum pm_status check_mesh(struct pm_h5 *f, const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    if (m->npe != 10 && m->npe != 4)
        PM_TRY(
            pm_h5_refuse(f, err, "/mesh/tet", "has %td nodes in a row, expected 10 or 4", m->npe));
    if (m->npf != (m->npe == 10 ? 6 : 3))
        PM_TRY(pm_h5_refuse(f, err, "/mesh/tri",
                            "has %td nodes in a row, expected %d with %td of "
                            "a tetrahedron",
                            m->npf, m->npe == 10 ? 6 : 3, m->npe));
    if (m->npe == 4 && m->N > 0)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/control_points",
                            "is %td, expected 0 in a mesh of 4-node tetrahedra", m->N));
    if (m->nn < m->npe || m->ne < 1 || m->nf < 4)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/tet", "is empty: %td nodes, %td tetrahedra, %td faces",
                            m->nn, m->ne, m->nf));
    PM_TRY(pm_check_range(f, "/mesh/tet", m->tet, m->npe * m->ne, 0, m->nn, err));
    PM_TRY(pm_check_range(f, "/mesh/tri", m->tri, m->npf * m->nf, 0, m->nn, err));
    PM_TRY(pm_check_range(f, "/mesh/tri_tag", m->tri_tag, m->nf, PM_FACE_SYM_Z, m->nc + 1, err));
    PM_TRY(pm_check_range(f, "/mesh/surface", m->surface, m->nn, -1, m->nc + 1, err));
    PM_TRY(pm_check_range(f, "/mesh/weight_col", m->wcol, m->nw, 0, m->N, err));
    if (m->wptr[0] != 0 || m->wptr[m->nn] != m->nw)
        PM_TRY(pm_h5_refuse(f, err, "/mesh/weight_ptr", "runs from %lld to %lld, expected 0 to %td",
                            (long long)m->wptr[0], (long long)m->wptr[m->nn], m->nw));
    for (ptrdiff_t a = 0; a < m->nn; a++)
        if (m->wptr[a + 1] < m->wptr[a])
            PM_TRY(pm_h5_refuse(f, err, "/mesh/weight_ptr", "falls at entry %td", a + 1));
done:
    return status;
}

enum pm_status pm_mesh_read(struct pm_h5 *f, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    *m = (struct pm_mesh){.nn = 0};
    PM_TRY(pm_record_get_case(f, &m->pcase, err));
    PM_TRY(pm_record_get_failure(f, m->failure, sizeof m->failure, err));
    if (m->failure[0] == '\0') {
        PM_TRY(read_sizes(f, m, err));
        PM_TRY(read_arrays(f, m, err));
        PM_TRY(check_mesh(f, m, err));
    }
done:
    if (status != PM_OK)
        pm_mesh_release(m);
    return status;
}

enum pm_status pm_mesh_load(const char *path, int allow_failure, struct pm_mesh *m,
                            struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *m = (struct pm_mesh){.nn = 0};
    PM_TRY(pm_h5_open(path, "mesh state", &f, err));
    PM_TRY(pm_mesh_read(f, m, err));
    if (m->failure[0] != '\0' && !allow_failure)
        PM_TRY(pm_record_fail(path, m->failure, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_mesh_release(m);
    return status;
}

static enum pm_status write_arrays(struct pm_h5 *f, const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t points[] = {m->nn, 3}, tets[] = {m->ne, m->npe}, faces[] = {m->nf, m->npf},
                    rows = m->nn + 1;
    const ptrdiff_t three = 3;
    PM_TRY(pm_h5_put(f, "/mesh/x", points, m->x, err));
    PM_TRY(pm_h5_put(f, "/mesh/x_generated", points, m->x_generated, err));
    PM_TRY(pm_h5_put(f, "/mesh/tet", tets, m->tet, err));
    PM_TRY(pm_h5_put(f, "/mesh/tri", faces, m->tri, err));
    PM_TRY(pm_h5_put(f, "/mesh/tri_tag", faces, m->tri_tag, err));
    PM_TRY(pm_h5_put(f, "/mesh/surface", points, m->surface, err));
    PM_TRY(pm_h5_put(f, "/mesh/S", points, m->S, err));
    PM_TRY(pm_h5_put(f, "/mesh/weight_ptr", &rows, m->wptr, err));
    PM_TRY(pm_h5_put(f, "/mesh/weight_col", &m->nw, m->wcol, err));
    PM_TRY(pm_h5_put(f, "/mesh/weight_val", &m->nw, m->wval, err));
    if (m->tag != NULL)
        PM_TRY(pm_h5_put(f, "/mesh/tag", points, m->tag, err));
    PM_TRY(pm_h5_put(f, "/tip/reference_point", &three, m->reference_point, err));
done:
    return status;
}

enum pm_status pm_mesh_write(struct pm_h5 *f, const struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_h5_put_text(f, "/case/text", m->pcase.text, err));
    if (m->failure[0] != '\0')
        return pm_h5_put_text(f, "/failure", m->failure, err);
    PM_TRY(pm_h5_put_int(f, "/mesh/chambers", m->nc, err));
    PM_TRY(pm_h5_put_int(f, "/mesh/control_points", m->N, err));
    PM_TRY(write_arrays(f, m, err));
    PM_TRY(pm_h5_put_double(f, "/mesh/max_damping", m->max_damping, err));
    PM_TRY(pm_h5_put_double(f, "/mesh/min_jacobian", m->min_jacobian, err));
    PM_TRY(pm_h5_put_double(f, "/mesh/coarse", m->coarse, err));
    PM_TRY(pm_h5_put_int(f, "/mesh/origin", m->origin, err));
    PM_TRY(pm_h5_put_int(f, "/mesh/delaunay", m->delaunay, err));
    PM_TRY(pm_h5_put_vtk(f, "/mesh/x", m->nn, m->ne, m->npe, m->tet, err));
done:
    return status;
}

void pm_mesh_release(struct pm_mesh *m)
{
    pm_free(m->x);
    pm_free(m->x_generated);
    pm_free(m->tet);
    pm_free(m->tri);
    pm_free(m->tri_tag);
    pm_free(m->surface);
    pm_free(m->S);
    pm_free(m->wptr);
    pm_free(m->wcol);
    pm_free(m->wval);
    pm_free(m->tag);
    pm_case_release(&m->pcase);
    *m = (struct pm_mesh){.nn = 0};
}
