#include "common/files/step.h"

#include <string.h>

#include "common/base/memory.h"
#include "common/files/record.h"

/* Members of struct pm_step and of struct pm_trial, in file order. */
struct item {
    const char *name;
    size_t offset;
    ptrdiff_t count;
};

#define AT(member) offsetof(struct pm_step, member)
static const struct item items[] = {
    {"/accepted/value", AT(value), 1},       {"/accepted/penalty", AT(penalty), 2},
    {"/accepted/worst", AT(worst), 2},       {"/step/weight", AT(weight), 2},
    {"/step/radius", AT(radius), 1},         {"/step/gain", AT(gain), 1},
    {"/step/penalty", AT(trial_penalty), 2}, {"/step/worst", AT(trial_worst), 2},
    {"/step/rms_step", AT(rms_step), 1},     {"/step/max_step", AT(max_step), 1},
};
#undef AT

#define AT(member) offsetof(struct pm_trial, member), 1
static const struct item columns[] = {
    {"/trial/iteration", AT(iteration)},
    {"/trial/accepted", AT(accepted)},
    {"/trial/renewed", AT(renewed)},
    {"/trial/jump", AT(jump)},
    {"/trial/measure", AT(measure)},
    {"/trial/amplification", AT(amplification)},
    {"/trial/gap", AT(gap)},
    {"/trial/merit", AT(merit)},
    {"/trial/predicted", AT(predicted)},
    {"/trial/ratio", AT(ratio)},
    {"/trial/radius", AT(radius)},
    {"/trial/worst_curvature", AT(worst_curvature)},
    {"/trial/worst_wall", AT(worst_wall)},
    {"/trial/rms_step", AT(rms_step)},
};
#undef AT

enum { NITEMS = sizeof items / sizeof *items, NCOLUMNS = sizeof columns / sizeof *columns };
/* Both column types have the size of a double. */
_Static_assert(sizeof(int64_t) == sizeof(double), "columns are copied by size");

/* Reasons are joined by line feeds, one line per trial. */
static enum pm_status split_reasons(struct pm_h5 *f, const char *text, struct pm_step *s,
                                    struct pm_err *err)
{
    const char *p = text;
    for (ptrdiff_t i = 0; i < s->ntrials; i++) {
        const size_t length = strcspn(p, "\n");
        if (p[length] != '\n' || length >= sizeof s->trials[i].reason)
            return pm_h5_refuse(f, err, "/trial/reason", "has no usable line %td of %td", i + 1,
                                s->ntrials);
        memcpy(s->trials[i].reason, p, length);
        p += length + 1;
    }
    return PM_OK;
}

static enum pm_status read_trials(struct pm_h5 *f, struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    ptrdiff_t d[PM_MAX_RANK];
    char *column = NULL, *text = NULL;

    for (int k = 0; k < NCOLUMNS; k++) {
        PM_TRY(pm_h5_get(f, columns[k].name, d, &column, err));
        if (k == 0) {
            s->ntrials = d[0];
            PM_TRY(PM_NEW(s->trials, s->ntrials, err));
        }
        for (ptrdiff_t i = 0; i < s->ntrials; i++)
            memcpy((char *)&s->trials[i] + columns[k].offset, column + (size_t)i * sizeof(double),
                   sizeof(double));
        pm_free(column);
        column = NULL;
    }
    PM_TRY(pm_h5_get_text(f, "/trial/reason", &text, err));
    PM_TRY(split_reasons(f, text, s, err));
done:
    pm_free(column);
    pm_free(text);
    return status;
}

enum pm_status pm_step_load(const char *path, struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_h5 *f = NULL;
    ptrdiff_t d[PM_MAX_RANK];

    *s = (struct pm_step){.ntrials = 0};
    PM_TRY(pm_h5_open(path, "step", &f, err));
    PM_TRY(pm_surfaces_read(f, &s->trial, err));
    PM_TRY(pm_surfaces_read_at(f, "/accepted", &s->accepted, err));
    PM_TRY(pm_record_get_short(f, "/step/verdict", s->verdict, sizeof s->verdict, err));
    for (int k = 0; k < NITEMS; k++)
        PM_TRY(pm_h5_get_into(f, items[k].name, items[k].count, (char *)s + items[k].offset, err));
    PM_TRY(pm_h5_get_int(f, "/step/renew", &s->renew, err));
    PM_TRY(pm_h5_get(f, "/accepted/gradient", d, &s->gradient, err));
    if (pm_h5_has(f, "/close/value")) {
        PM_TRY(pm_h5_get(f, "/close/weight", d, &s->close_weight, err));
        PM_TRY(pm_h5_get(f, "/close/gradient", d, &s->close_gradient, err));
        PM_TRY(pm_h5_get(f, "/close/value", d, &s->close_value, err));
        s->nclose = d[0];
    }
    if (pm_h5_has(f, "/pair/step")) {
        PM_TRY(pm_h5_get(f, "/pair/gradient", d, &s->pair_gradient, err));
        PM_TRY(pm_h5_get(f, "/pair/step", d, &s->pair_step, err));
        s->npairs = d[0];
    }
    PM_TRY(read_trials(f, s, err));
    if (s->ntrials < 1 || !(s->radius > 0))
        PM_TRY(pm_h5_refuse(f, err, "/step/radius",
                            "is %g after %td trials, expected > 0 after one or more", s->radius,
                            s->ntrials));
done:
    pm_h5_close(f);
    if (status != PM_OK)
        pm_step_release(s);
    return status;
}

static enum pm_status write_trials(struct pm_h5 *f, const struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    const size_t line = sizeof s->trials->reason + 1;
    char *text = NULL, *column = NULL;
    size_t at = 0;

    PM_TRY(PM_NEW(column, s->ntrials * (ptrdiff_t)sizeof(double), err));
    for (int k = 0; k < NCOLUMNS; k++) {
        for (ptrdiff_t i = 0; i < s->ntrials; i++)
            memcpy(column + (size_t)i * sizeof(double),
                   (const char *)&s->trials[i] + columns[k].offset, sizeof(double));
        PM_TRY(pm_h5_put(f, columns[k].name, &s->ntrials, column, err));
    }
    PM_TRY(PM_NEW(text, s->ntrials * (ptrdiff_t)line + 1, err));
    for (ptrdiff_t i = 0; i < s->ntrials; i++) {
        const size_t length = strcspn(s->trials[i].reason, "\n");
        memcpy(text + at, s->trials[i].reason, length);
        text[at + length] = '\n';
        at += length + 1;
    }
    PM_TRY(pm_h5_put_text(f, "/trial/reason", text, err));
done:
    pm_free(text);
    pm_free(column);
    return status;
}

enum pm_status pm_step_write(struct pm_h5 *f, const struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t d[] = {s->accepted.offset[s->accepted.ns], 3};
    const ptrdiff_t pairs[] = {s->npairs, d[0], 3}, close[] = {s->nclose, d[0], 3};

    PM_TRY(pm_surfaces_write(f, &s->trial, err));
    PM_TRY(pm_surfaces_write_at(f, "/accepted", &s->accepted, err));
    PM_TRY(pm_h5_put_text(f, "/step/verdict", s->verdict, err));
    for (int k = 0; k < NITEMS; k++)
        PM_TRY(pm_h5_put(f, items[k].name, items[k].count > 1 ? &items[k].count : NULL,
                         (const char *)s + items[k].offset, err));
    PM_TRY(pm_h5_put_int(f, "/step/renew", s->renew, err));
    PM_TRY(pm_h5_put(f, "/accepted/gradient", d, s->gradient, err));
    if (s->nclose > 0) {
        PM_TRY(pm_h5_put(f, "/close/weight", &s->nclose, s->close_weight, err));
        PM_TRY(pm_h5_put(f, "/close/value", &s->nclose, s->close_value, err));
        PM_TRY(pm_h5_put(f, "/close/gradient", close, s->close_gradient, err));
    }
    if (s->npairs > 0) {
        PM_TRY(pm_h5_put(f, "/pair/step", pairs, s->pair_step, err));
        PM_TRY(pm_h5_put(f, "/pair/gradient", pairs, s->pair_gradient, err));
    }
    PM_TRY(write_trials(f, s, err));
done:
    return status;
}

void pm_step_release(struct pm_step *s)
{
    pm_surfaces_release(&s->trial);
    pm_surfaces_release(&s->accepted);
    pm_free(s->gradient);
    pm_free(s->close_weight);
    pm_free(s->close_value);
    pm_free(s->close_gradient);
    pm_free(s->pair_step);
    pm_free(s->pair_gradient);
    pm_free(s->trials);
    *s = (struct pm_step){.ntrials = 0};
}
