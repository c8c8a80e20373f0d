#include "common/files/work.h"

#include "common/base/memory.h"
#include "common/files/record.h"

struct scalar {
    const char *name;
    size_t offset;
};

#define AT(member) offsetof(struct pm_work, member)

static const struct scalar scalars[] = {
    {"/measure/value", AT(value)},
    {"/measure/form", AT(form)},
    {"/measure/orientation", AT(orientation)},
    {"/measure/value_other", AT(value_other)},
    {"/measure/quadrature_error", AT(quadrature_error)},
    {"/measure/objective", AT(objective)},
    {"/measure/amplification", AT(amplification)},
    {"/measure/closeness", AT(closeness)},
    {"/measure/min_det", AT(min_det)},
    {"/measure/max_det", AT(max_det)},
    {"/measure/sign_changes", AT(sign_changes)},
    {"/measure/branch_jumps", AT(branch_jumps)},
    {"/measure/max_rotation", AT(max_rotation)},
    {"/measure/max_tilt", AT(max_tilt)},
};

enum { NSCALARS = sizeof scalars / sizeof scalars[0] };

static enum pm_status read_points(struct pm_h5 *f, struct pm_work *w, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_h5_get(f, "/point/pressure", d, &w->pressure, err));
    w->ng = d[0];
    w->nc = d[1];
    PM_TRY(pm_h5_get(f, "/point/load", d, &w->load, err));
    PM_TRY(pm_h5_get(f, "/point/U", d, &w->U, err));
    PM_TRY(pm_h5_get(f, "/point/J", d, &w->J, err));
    PM_TRY(pm_h5_get(f, "/point/w", d, &w->w, err));
    PM_TRY(pm_h5_get(f, "/point/dw_dU", d, &w->dw_dU, err));
    PM_TRY(pm_h5_get(f, "/point/dw_dJ", d, &w->dw_dJ, err));
    PM_TRY(pm_h5_get(f, "/point/intersections", d, &w->intersections, err));
    PM_TRY(pm_h5_get(f, "/point/gap", d, &w->gap, err));
    PM_TRY(pm_h5_get(f, "/point/closeness", d, &w->closeness_at, err));
    PM_TRY(pm_h5_get(f, "/point/dw_dG", d, &w->dw_dG, err));
    if (w->ng < 1 || w->nc < 1 || w->nc > PM_MAX_CHAMBERS)
        PM_TRY(pm_h5_refuse(f, err, "/point/pressure", "is %td x %td", w->ng, w->nc));
    if (w->form < 0 || w->form > 1)
        PM_TRY(
            pm_h5_refuse(f, err, "/measure/form", "is %lld, expected 0 or 1", (long long)w->form));
    if (w->orientation != 1 && w->orientation != -1)
        PM_TRY(pm_h5_refuse(f, err, "/measure/orientation", "is %g, expected 1 or -1",
                            w->orientation));
done:
    return status;
}

static enum pm_status read_work(struct pm_h5 *f, struct pm_work *w, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_record_get_case(f, &w->pcase, err));
    PM_TRY(pm_record_get_failure(f, w->failure, sizeof w->failure, err));
    if (w->failure[0] != '\0')
        goto done;
    PM_TRY(pm_record_get_short(f, "/measure/name", w->name, sizeof w->name, err));
    PM_TRY(pm_record_get_short(f, "/measure/unit", w->unit, sizeof w->unit, err));
    for (int i = 0; i < NSCALARS; i++)
        PM_TRY(pm_h5_get_into(f, scalars[i].name, 1, (char *)w + scalars[i].offset, err));
    PM_TRY(read_points(f, w, err));
done:
    return status;
}

enum pm_status pm_work_load(const char *path, int allow_failure, struct pm_work *w,
                            struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *w = (struct pm_work){.ng = 0};
    PM_TRY(pm_h5_open(path, "work", &f, err));
    PM_TRY(read_work(f, w, err));
    if (w->failure[0] != '\0' && !allow_failure)
        PM_TRY(pm_record_fail(path, w->failure, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_work_release(w);
    return status;
}

enum pm_status pm_work_write(struct pm_h5 *f, const struct pm_work *w, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_h5_put_text(f, "/case/text", w->pcase.text, err));
    if (w->failure[0] != '\0')
        return pm_h5_put_text(f, "/failure", w->failure, err);
    PM_TRY(pm_h5_put_text(f, "/measure/name", w->name, err));
    PM_TRY(pm_h5_put_text(f, "/measure/unit", w->unit, err));
    for (int i = 0; i < NSCALARS; i++)
        PM_TRY(pm_h5_put(f, scalars[i].name, NULL, (const char *)w + scalars[i].offset, err));
    const ptrdiff_t pressures[] = {w->ng, w->nc}, poses[] = {w->ng, 6},
                    jacobians[] = {w->ng, 6, w->nc};
    PM_TRY(pm_h5_put(f, "/point/pressure", pressures, w->pressure, err));
    PM_TRY(pm_h5_put(f, "/point/load", &w->ng, w->load, err));
    PM_TRY(pm_h5_put(f, "/point/U", poses, w->U, err));
    PM_TRY(pm_h5_put(f, "/point/J", jacobians, w->J, err));
    PM_TRY(pm_h5_put(f, "/point/w", &w->ng, w->w, err));
    PM_TRY(pm_h5_put(f, "/point/dw_dU", poses, w->dw_dU, err));
    PM_TRY(pm_h5_put(f, "/point/dw_dJ", jacobians, w->dw_dJ, err));
    PM_TRY(pm_h5_put(f, "/point/intersections", &w->ng, w->intersections, err));
    PM_TRY(pm_h5_put(f, "/point/gap", &w->ng, w->gap, err));
    PM_TRY(pm_h5_put(f, "/point/closeness", &w->ng, w->closeness_at, err));
    PM_TRY(pm_h5_put(f, "/point/dw_dG", &w->ng, w->dw_dG, err));
done:
    return status;
}

void pm_work_release(struct pm_work *w)
{
    pm_free(w->load);
    pm_free(w->pressure);
    pm_free(w->U);
    pm_free(w->J);
    pm_free(w->w);
    pm_free(w->dw_dU);
    pm_free(w->dw_dJ);
    pm_free(w->intersections);
    pm_free(w->gap);
    pm_free(w->closeness_at);
    pm_free(w->dw_dG);
    pm_case_release(&w->pcase);
    *w = (struct pm_work){.ng = 0};
}
