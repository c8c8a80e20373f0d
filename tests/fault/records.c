/* The n-th allocation fails, n = 1, 2, .. until none does: every record is then read or written as
 * a clean failure (PM_SYSTEM, a message, no file), under the sanitizers without a leak. */
#include <stdlib.h>
#include <unistd.h>

#include "tests/records.h"
#include "tests/tap.h"

/* What a failed attempt must look like. */
static int clean(enum pm_status status, const struct pm_err *err)
{
    return status == PM_SYSTEM && err->status == PM_SYSTEM && err->text[0] != '\0';
}

static void test_kind(const char *kind, const char *path)
{
    union sample r;
    struct pm_err err = {.status = PM_OK};
    enum pm_status status = PM_SYSTEM;
    int bad = 0, n;
    if (!ok(sample_make(kind, &r, &err) == PM_OK, "sample %s", kind))
        return;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = sample_write(path, kind, &r, &err);
        pm_memory_fail_at(0);
        bad += status != PM_OK && (!clean(status, &err) || access(path, F_OK) == 0);
    }
    ok(bad == 0 && status == PM_OK && n > 2, "%s is written after %d failures", kind, n - 2);
    sample_release(kind, &r);
    status = PM_SYSTEM;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = sample_load(kind, path, &r, &err);
        pm_memory_fail_at(0);
        bad += status != PM_OK && !clean(status, &err);
    }
    ok(bad == 0 && status == PM_OK && n > 2, "%s is read after %d failures", kind, n - 2);
    sample_release(kind, &r);
    unlink(path);
}

static void test_copy(void)
{
    struct pm_surfaces a, b;
    struct pm_err err = {.status = PM_OK};
    enum pm_status status = PM_SYSTEM;
    int bad = 0, n;
    if (!ok(sample_surfaces(&a, &err) == PM_OK, "sample"))
        return;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = pm_surfaces_copy(&a, &b, &err);
        pm_memory_fail_at(0);
        bad += status != PM_OK && !clean(status, &err);
    }
    ok(bad == 0 && n > 2, "surfaces are copied after %d failures", n - 2);
    pm_surfaces_release(&a);
    pm_surfaces_release(&b);
}

int main(void)
{
    char folder[] = "/tmp/pm-fault-XXXXXX", path[64];
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    snprintf(path, sizeof path, "%s/r.h5", folder);
    for (int k = 0; k < SAMPLE_KINDS; k++)
        test_kind(sample_kinds[k], path);
    test_copy();
    ok(rmdir(folder) == 0, "no temporary is left");
    return tap_done();
}
