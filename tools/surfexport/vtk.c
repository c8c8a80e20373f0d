#include "common/base/memory.h"
#include "common/files/h5.h"
#include "tools/surfexport/write.h"

static enum pm_status put(struct pm_h5 *f, const struct skin *s, int fields, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nodes[] = {s->nn, 3}, triangles[] = {s->nt, 3};
    PM_TRY(pm_h5_put(f, "/skin/x", nodes, s->x, err));
    PM_TRY(pm_h5_put(f, "/skin/tri", triangles, s->tri, err));
    PM_TRY(pm_h5_put(f, "/skin/tag", triangles, s->tag, err));
    PM_TRY(pm_h5_put(f, "/skin/surface", nodes, s->surface, err));
    PM_TRY(pm_h5_put_vtk(f, "/skin/x", s->nn, s->nt, 3, s->tri, err));
    PM_TRY(pm_h5_vtk_cell_field(f, "/skin/tag", "tag", err));
    PM_TRY(pm_h5_vtk_point_field(f, "/skin/surface", "surface", err));
    if (fields) {
        PM_TRY(pm_h5_put(f, "/skin/curvature", nodes, s->curvature, err));
        PM_TRY(pm_h5_put(f, "/skin/wall", nodes, s->wall, err));
        PM_TRY(pm_h5_vtk_point_field(f, "/skin/curvature", "curvature", err));
        PM_TRY(pm_h5_vtk_point_field(f, "/skin/wall", "wall", err));
    }
done:
    return status;
}

enum pm_status write_vtk(const struct skin *s, const struct pm_case *c, int fields,
                         const struct pm_common *common, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    PM_TRY(pm_h5_create(common->output, "skin", common, NULL, &f, err));
    PM_TRY(pm_h5_put_text(f, "/case/text", c->text, err));
    PM_TRY(put(f, s, fields, err));
    PM_TRY(pm_h5_commit(f, err));
    f = NULL;
done:
    pm_h5_close(f);
    return status;
}
