/* The n-th allocation fails, n = 1, 2, .. until none does: every record is then read or written as
 * a clean failure (PM_SYSTEM, a message, no file), under the sanitizers without a leak. */
#include <stdlib.h>
#include <unistd.h>

#include "tests/records.h"
#include "tests/tap.h"

union record {
    struct pm_surfaces surfaces;
    struct pm_mesh mesh;
    struct pm_state state;
    struct pm_work work;
    struct pm_sens sens;
};

static enum pm_status sample(const char *kind, union record *r, struct pm_err *err)
{
    switch (kind[1]) {
    case 'u':
        return sample_surfaces(&r->surfaces, err);
    case 'e':
        return kind[0] == 'm' ? sample_mesh(&r->mesh, err) : sample_sens(&r->sens, err);
    case 't':
        return sample_state(&r->state, err);
    default:
        return sample_work(&r->work, err);
    }
}

static enum pm_status load(const char *kind, const char *path, union record *r, struct pm_err *err)
{
    switch (kind[1]) {
    case 'u':
        return pm_surfaces_load(path, &r->surfaces, err);
    case 'e':
        return kind[0] == 'm' ? pm_mesh_load(path, 0, &r->mesh, err)
                              : pm_sens_load(path, &r->sens, err);
    case 't':
        return pm_state_load(path, 0, &r->state, err);
    default:
        return pm_work_load(path, 0, &r->work, err);
    }
}

static void release(const char *kind, union record *r)
{
    switch (kind[1]) {
    case 'u':
        pm_surfaces_release(&r->surfaces);
        break;
    case 'e':
        kind[0] == 'm' ? pm_mesh_release(&r->mesh) : pm_sens_release(&r->sens);
        break;
    case 't':
        pm_state_release(&r->state);
        break;
    default:
        pm_work_release(&r->work);
    }
}

/* What a failed attempt must look like. */
static int clean(enum pm_status status, const struct pm_err *err)
{
    return status == PM_SYSTEM && err->status == PM_SYSTEM && err->text[0] != '\0';
}

static void test_kind(const char *kind, const char *path)
{
    union record r;
    struct pm_err err = {.status = PM_OK};
    enum pm_status status = PM_SYSTEM;
    int bad = 0, n;
    if (!ok(sample(kind, &r, &err) == PM_OK, "sample %s", kind))
        return;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = sample_write(path, kind, &r, &err);
        pm_memory_fail_at(0);
        bad += status != PM_OK && (!clean(status, &err) || access(path, F_OK) == 0);
    }
    ok(bad == 0 && status == PM_OK && n > 2, "%s is written after %d failures", kind, n - 2);
    release(kind, &r);
    status = PM_SYSTEM;
    for (n = 1; status != PM_OK && n < 1000; n++) {
        err = (struct pm_err){.status = PM_OK};
        pm_memory_fail_at(n);
        status = load(kind, path, &r, &err);
        pm_memory_fail_at(0);
        bad += status != PM_OK && !clean(status, &err);
    }
    ok(bad == 0 && status == PM_OK && n > 2, "%s is read after %d failures", kind, n - 2);
    release(kind, &r);
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
    static const char *const kinds[] = {"surface", "mesh", "state", "work", "sens"};
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    snprintf(path, sizeof path, "%s/r.h5", folder);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        test_kind(kinds[i], path);
    test_copy();
    ok(rmdir(folder) == 0, "no temporary is left");
    return tap_done();
}
