#include "common/files/sens.h"

#include <stdio.h>

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
    PM_TRY(pm_h5_get_int(f, "/gradient/shape_form", &s->shape_form, err));
    if (s->shape_form < 0 || s->shape_form > 1)
        PM_TRY(pm_h5_refuse(f, err, "/gradient/shape_form", "is %lld, expected 0 or 1",
                            (long long)s->shape_form));
    PM_TRY(pm_h5_get(f, "/gradient/phi", d, &s->gradient, err));
    s->N = d[0];
    if (pm_h5_has(f, "/close/value")) {
        PM_TRY(pm_h5_get(f, "/close/gradient", d, &s->close_gradient, err));
        PM_TRY(pm_h5_get(f, "/close/value", d, &s->close_value, err));
        s->nclose = d[0];
    }
    if (s->shape_form == 1)
        return PM_OK;
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

ptrdiff_t pm_entries_count(ptrdiff_t nc)
{
    return 6 + 6 * nc + nc + nc * nc;
}

static enum pm_status write_entries(struct pm_h5 *f, const char *group, ptrdiff_t nc,
                                    const struct pm_entries *e, struct pm_err *err)
{
    const struct {
        const char *name;
        ptrdiff_t rank, d[4], entries;
    } parts[] = {{"dU", 3, {6, e->n, 3, 0}, 6},
                 {"dJ", 4, {6, nc, e->n, 3}, 6 * nc},
                 {"dV", 3, {nc, e->n, 3, 0}, nc},
                 {"dC", 4, {nc, nc, e->n, 3}, nc * nc}};
    const double *d = e->d;
    for (size_t k = 0; k < sizeof parts / sizeof parts[0] && d != NULL; k++) {
        char name[32];
        snprintf(name, sizeof name, "/%s/%s", group, parts[k].name);
        enum pm_status status = pm_h5_put(f, name, parts[k].d, d, err);
        if (status != PM_OK)
            return status;
        d += 3 * parts[k].entries * e->n;
    }
    return PM_OK;
}

static enum pm_status write_gradient(struct pm_h5 *f, const struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t d[] = {s->N, 3}, close[] = {s->nclose, s->N, 3};
    PM_TRY(pm_h5_put(f, "/gradient/phi", d, s->gradient, err));
    if (s->nclose > 0) {
        PM_TRY(pm_h5_put(f, "/close/value", &s->nclose, s->close_value, err));
        PM_TRY(pm_h5_put(f, "/close/gradient", close, s->close_gradient, err));
    }
    if (s->shape_form == 1)
        return PM_OK;
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_translation", s->identity_translation, err));
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_scaling", s->identity_scaling, err));
    PM_TRY(pm_h5_put_double(f, "/gradient/identity_rotation", s->identity_rotation, err));
done:
    return status;
}

enum pm_status pm_sens_write(struct pm_h5 *f, const struct pm_sens *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_h5_put_text(f, "/case/text", s->pcase.text, err));
    PM_TRY(pm_h5_put_int(f, "/load/form", s->form, err));
    PM_TRY(pm_h5_put_int(f, "/load/index", s->load, err));
    PM_TRY(pm_h5_put_int(f, "/gradient/shape_form", s->shape_form, err));
    if (s->gradient != NULL)
        PM_TRY(write_gradient(f, s, err));
    if (s->compliance != NULL)
        PM_TRY(pm_h5_put(f, "/chamber/compliance", (const ptrdiff_t[]){s->nc, s->nc}, s->compliance,
                         err));
    PM_TRY(write_entries(f, "each", s->nc, &s->each, err));
    PM_TRY(write_entries(f, "nodal", s->nc, &s->nodal, err));
done:
    return status;
}

void pm_sens_release(struct pm_sens *s)
{
    pm_free(s->gradient);
    pm_free(s->close_value);
    pm_free(s->close_gradient);
    pm_free(s->compliance);
    pm_free(s->each.d);
    pm_free(s->nodal.d);
    pm_case_release(&s->pcase);
    *s = (struct pm_sens){.N = 0};
}
