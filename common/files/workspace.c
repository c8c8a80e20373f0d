#include "common/files/workspace.h"

#include <math.h>

#include "common/base/memory.h"
#include "common/files/record.h"

#define AT(member) offsetof(struct pm_workspace, member)

static const struct {
    const char *name;
    size_t offset;
    int count; /* 0: a scalar */
} values[] = {
    {"/measure/value", AT(value), 0},
    {"/measure/orientation", AT(orientation), 0},
    {"/workspace/interval", AT(interval), 0},
    {"/measure/min_det", AT(min_det), 0},
    {"/measure/max_det", AT(max_det), 0},
    {"/measure/sign_changes", AT(sign_changes), 0},
    {"/measure/branch_jumps", AT(branch_jumps), 0},
    {"/workspace/interior", AT(interior), 0},
    {"/workspace/intersections", AT(intersections), 0},
    {"/workspace/tilt", AT(tilt), 3},
    {"/workspace/rotation", AT(rotation), 3},
    {"/workspace/twist", AT(twist), 0},
};

enum { NVALUES = sizeof values / sizeof values[0] };

static enum pm_status get_optional(struct pm_h5 *f, const char *name, double *value,
                                   struct pm_err *err)
{
    *value = NAN;
    return pm_h5_has(f, name) ? pm_h5_get_double(f, name, value, err) : PM_OK;
}

static enum pm_status read_workspace(struct pm_h5 *f, struct pm_workspace *w, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_record_get_case(f, &w->pcase, err));
    PM_TRY(pm_record_get_short(f, "/measure/name", w->name, sizeof w->name, err));
    PM_TRY(pm_record_get_short(f, "/measure/unit", w->unit, sizeof w->unit, err));
    for (int i = 0; i < NVALUES; i++)
        PM_TRY(pm_h5_get_into(f, values[i].name, values[i].count > 0 ? values[i].count : 1,
                              (char *)w + values[i].offset, err));
    PM_TRY(get_optional(f, "/workspace/value_polygon", &w->value_polygon, err));
    PM_TRY(get_optional(f, "/workspace/value_coarse", &w->value_coarse, err));
    PM_TRY(pm_h5_get(f, "/workspace/x", d, &w->x, err));
    PM_TRY(pm_h5_get(f, "/workspace/U", d, &w->U, err));
    PM_TRY(pm_h5_get(f, "/workspace/angle", d, &w->angle, err));
    PM_TRY(pm_h5_get(f, "/workspace/pressure", d, &w->pressure, err));
    w->nn = d[0];
    w->nc = d[1];
    PM_TRY(pm_h5_get(f, "/workspace/cell", d, &w->cell, err));
    w->ne = d[0];
    w->npe = d[1];
    if (w->npe != 2 && w->npe != 3)
        PM_TRY(pm_h5_refuse(f, err, "/workspace/cell", "has %td samples a cell, expected 2 or 3",
                            w->npe));
    PM_TRY(pm_check_range(f, "/workspace/cell", w->cell, w->ne * w->npe, 0, w->nn, err));
done:
    return status;
}

enum pm_status pm_workspace_load(const char *path, struct pm_workspace *w, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *w = (struct pm_workspace){.nn = 0};
    PM_TRY(pm_h5_open(path, "workspace", &f, err));
    PM_TRY(read_workspace(f, w, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_workspace_release(w);
    return status;
}

enum pm_status pm_workspace_write(struct pm_h5 *f, const struct pm_workspace *w, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t x[] = {w->nn, 3}, pressures[] = {w->nn, w->nc}, poses[] = {w->nn, 6},
                    cells[] = {w->ne, w->npe};
    PM_TRY(pm_h5_put_text(f, "/case/text", w->pcase.text, err));
    PM_TRY(pm_h5_put_text(f, "/measure/name", w->name, err));
    PM_TRY(pm_h5_put_text(f, "/measure/unit", w->unit, err));
    for (int i = 0; i < NVALUES; i++) {
        const ptrdiff_t count = values[i].count;
        PM_TRY(pm_h5_put(f, values[i].name, count > 0 ? &count : NULL,
                         (const char *)w + values[i].offset, err));
    }
    if (!isnan(w->value_polygon))
        PM_TRY(pm_h5_put_double(f, "/workspace/value_polygon", w->value_polygon, err));
    if (!isnan(w->value_coarse))
        PM_TRY(pm_h5_put_double(f, "/workspace/value_coarse", w->value_coarse, err));
    PM_TRY(pm_h5_put(f, "/workspace/x", x, w->x, err));
    PM_TRY(pm_h5_put(f, "/workspace/U", poses, w->U, err));
    PM_TRY(pm_h5_put(f, "/workspace/angle", &w->nn, w->angle, err));
    PM_TRY(pm_h5_put(f, "/workspace/pressure", pressures, w->pressure, err));
    PM_TRY(pm_h5_put(f, "/workspace/cell", cells, w->cell, err));
    PM_TRY(pm_h5_put_vtk(f, "/workspace/x", w->nn, w->ne, w->npe, w->cell, err));
    PM_TRY(pm_h5_vtk_point_field(f, "/workspace/pressure", "pressure", err));
    PM_TRY(pm_h5_vtk_point_field(f, "/workspace/angle", "angle", err));
    PM_TRY(pm_h5_vtk_point_field(f, "/workspace/U", "U", err));
done:
    return status;
}

void pm_workspace_release(struct pm_workspace *w)
{
    pm_free(w->x);
    pm_free(w->U);
    pm_free(w->angle);
    pm_free(w->pressure);
    pm_free(w->cell);
    pm_case_release(&w->pcase);
    *w = (struct pm_workspace){.nn = 0};
}
