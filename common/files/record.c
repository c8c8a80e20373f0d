#include "common/files/record.h"

enum pm_status pm_record_get_case(struct pm_h5 *f, struct pm_case *c, struct pm_err *err)
{
    enum pm_status status;
    char *text = NULL;
    PM_TRY(pm_h5_get_text(f, "/case/text", &text, err));
    PM_TRY(pm_case_parse(text, pm_h5_path(f), c, err));
done:
    pm_free(text);
    return status;
}

enum pm_status pm_record_get_short(struct pm_h5 *f, const char *name, char *text, size_t size,
                                   struct pm_err *err)
{
    enum pm_status status;
    char *long_text = NULL;
    PM_TRY(pm_h5_get_text(f, name, &long_text, err));
    size_t length = strlen(long_text);
    if (length >= size)
        PM_TRY(
            pm_h5_refuse(f, err, name, "has %zu characters, expected less than %zu", length, size));
    memcpy(text, long_text, length + 1);
done:
    pm_free(long_text);
    return status;
}

enum pm_status pm_record_get_failure(struct pm_h5 *f, char *text, size_t size, struct pm_err *err)
{
    text[0] = '\0';
    if (!pm_h5_has(f, "/failure"))
        return PM_OK;
    enum pm_status status = pm_record_get_short(f, "/failure", text, size, err);
    if (status == PM_OK && text[0] == '\0')
        return pm_h5_refuse(f, err, "/failure", "is empty, expected a reason");
    return status;
}

enum pm_status pm_record_fail(const char *path, const char *failure, struct pm_err *err)
{
    return pm_fail(err, PM_INPUT, "cannot use '%s': it records a failure: %s", path, failure);
}

enum pm_status pm_check_range(const struct pm_h5 *f, const char *name, const int32_t *v,
                              ptrdiff_t n, ptrdiff_t low, ptrdiff_t high, struct pm_err *err)
{
    for (ptrdiff_t i = 0; i < n; i++)
        if (v[i] < low || v[i] >= high)
            return pm_h5_refuse(f, err, name, "is %d at entry %td, expected %td to %td", v[i], i,
                                low, high - 1);
    return PM_OK;
}

enum pm_status pm_copy_array(void *target, const void *from, ptrdiff_t n, size_t size,
                             struct pm_err *err)
{
    void *copy = pm_calloc(n, size, err);
    if (copy == NULL)
        return PM_SYSTEM;
    if (n > 0)
        memcpy(copy, from, (size_t)n * size);
    memcpy(target, &copy, sizeof copy);
    return PM_OK;
}
