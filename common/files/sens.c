#include "common/files/sens.h"

#include "common/base/memory.h"
#include "common/files/record.h"

static enum pm_status read_sens(struct pm_h5 *f, struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    PM_TRY(pm_record_get_case(f, &s->pcase, err));
    PM_TRY(pm_h5_get_int(f, "/load/form", &s->form, err));
    PM_TRY(pm_h5_get_int(f, "/load/index", &s->load, err));
    if (s->form < 0 || s->form > 1 || s->load < -1)
        PM_TRY(pm_h5_refuse(f, err, "/load/form", "and index are %lld and %lld", (long long)s->form,
                            (long long)s->load));
    PM_TRY(pm_h5_get(f, "/gradient/phi", d, &s->gradient, err));
    s->N = d[0];
    PM_TRY(pm_h5_get_double(f, "/gradient/identity_translation", &s->identity_translation, err));
    PM_TRY(pm_h5_get_double(f, "/gradient/identity_scaling", &s->identity_scaling, err));
    PM_TRY(pm_h5_get_double(f, "/gradient/identity_rotation", &s->identity_rotation, err));
done:
    return status;
}

enum pm_status pm_sens_load(const char *path, struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    *s = (struct pm_sens){.N = 0};
    PM_TRY(pm_h5_open(path, "sens", &f, err));
    PM_TRY(read_sens(f, s, err));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_sens_release(s);
    return status;
}

enum pm_status pm_sens_write(struct pm_h5 *f, const struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t d[] = {s->N, 3};
    PM_TRY(pm_h5_put_text(f, "/case/text", s->pcase.text, err));
    PM_TRY(pm_h5_put_int(f, "/load/form", s->form, err));
    PM_TRY(pm_h5_put_int(f, "/load/index", s->load, err));
    PM_TRY(pm_h5_put(f, "/gradient/phi", d, s->gradient, err));
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_translation", s->identity_translation, err));
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_scaling", s->identity_scaling, err));
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_rotation", s->identity_rotation, err));
done:
    return status;
}

void pm_sens_release(struct pm_sens *s)
{
    pm_free(s->gradient);
    pm_case_release(&s->pcase);
    *s = (struct pm_sens){.N = 0};
}
