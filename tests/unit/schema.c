/* The schema table and the checks it drives: every damage to a file is refused by name. */
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/files/schema.h"
#include "tests/records.h"
#include "tests/tap.h"

static void test_table(void)
{
    ptrdiff_t n;
    const struct pm_item *item = pm_schema_items(&n);
    int index;
    for (ptrdiff_t i = 0; i < n; i++) {
        struct pm_size size[8];
        char kind[16], name[64];
        snprintf(kind, sizeof kind, "%.*s", (int)strcspn(item[i].kinds, " "), item[i].kinds);
        const char *hole = strstr(item[i].name, "%d");
        if (hole != NULL)
            snprintf(name, sizeof name, "%.*s7%s", (int)(hole - item[i].name), item[i].name,
                     hole + 2);
        else
            snprintf(name, sizeof name, "%s", item[i].name);
        int good = pm_schema_find(kind, name, &index) == &item[i] &&
                   index == (hole != NULL ? 7 : 0) &&
                   pm_schema_sizes(&item[i], index, 8, size) <= 4 && item[i].unit[0] != '\0' &&
                   item[i].text[0] != '\0' && item[i].name[0] == '/';
        if (!good)
            ok(0, "item '%s' is well formed and unique", item[i].name);
    }
    ok(n > 50, "%td items", n);
    struct pm_size size[4];
    const struct pm_item *phi = pm_schema_find("surface", "/surface12/phi", &index);
    ok(phi != NULL && index == 12 && pm_schema_sizes(phi, 12, 4, size) == 2 &&
           strcmp(size[0].symbol, "n12") == 0 && size[1].add == 3 && size[1].symbol[0] == '\0',
       "a size of a numbered item");
    const struct pm_item *ptr = pm_schema_find("mesh", "/mesh/weight_ptr", &index);
    ok(ptr != NULL && pm_schema_sizes(ptr, 0, 4, size) == 1 && strcmp(size[0].symbol, "nn") == 0 &&
           size[0].add == 1,
       "a size with an addend");
    ok(pm_schema_find("surface", "/surface/phi", &index) == NULL &&
           pm_schema_find("mesh", "/surface1/phi", &index) == NULL &&
           pm_schema_find("surf", "/case/text", &index) == NULL,
       "other names and kinds are not found");
    ok(pm_schema_word_in("step", "surface step") && !pm_schema_word_in("ste", "surface step") &&
           !pm_schema_word_in("", "surface step"),
       "words of a list");
}

static int mangle(const char *helper, const char *arguments)
{
    char command[512];
    snprintf(command, sizeof command, "%s %s", helper, arguments);
    int status = system(command);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static enum pm_status load(const char *kind, const char *path, struct pm_err *err)
{
    union sample r;
    enum pm_status status = sample_load(kind, path, &r, err);
    sample_release(kind, &r);
    return status;
}

static enum pm_status write_sample(const char *kind, const char *path, struct pm_err *err)
{
    union sample r;
    enum pm_status status = sample_make(kind, &r, err);
    if (status == PM_OK)
        status = sample_write(path, kind, &r, err);
    sample_release(kind, &r);
    return status;
}

/* Every required item of a kind: missing, short, of another type, not finite. */
static void test_damage(const char *helper, const char *kind, const char *path)
{
    static const char *const damage[] = {"drop", "shorten", "narrow", "set"};
    ptrdiff_t n;
    const struct pm_item *item = pm_schema_items(&n);
    for (ptrdiff_t i = 0; i < n; i++) {
        char name[64], arguments[256];
        const char *hole = strstr(item[i].name, "%d");
        /* VTK reads its own arrays; the case and the failure are texts. */
        if (!pm_schema_word_in(kind, item[i].kinds) || !item[i].required ||
            strncmp(item[i].name, "/VTKHDF/", 8) == 0)
            continue;
        snprintf(name, sizeof name, "%.*s%s%s", hole != NULL ? (int)(hole - item[i].name) : 64,
                 item[i].name, hole != NULL ? "1" : "", hole != NULL ? hole + 2 : "");
        for (int k = 0; k < 4; k++) {
            struct pm_err err = {.status = PM_OK};
            /* These sizes stand in no other item of the file. */
            int alone = strcmp(name, "/surface1/tri") == 0 || strcmp(name, "/gradient/phi") == 0 ||
                        strcmp(name, "/accepted/surface1/tri") == 0;
            if ((k == 1 && (item[i].shape[0] == '\0' || alone)) ||
                (k == 3 && item[i].type != PM_TYPE_DOUBLE))
                continue;
            snprintf(arguments, sizeof arguments, "%s %s %s%s", damage[k], path, name,
                     k == 3 ? " 0 nan" : "");
            int good = write_sample(kind, path, &err) == PM_OK && mangle(helper, arguments) &&
                       load(kind, path, &err) == PM_INPUT && strstr(err.text, path) != NULL;
            ok(good, "%s %s %s", kind, damage[k], name);
            if (!good)
                printf("# got: %s\n", err.text);
        }
    }
}

static void refuse_entry(const char *helper, const char *kind, const char *path, const char *entry,
                         const char *says)
{
    struct pm_err err = {.status = PM_OK};
    char arguments[256];
    snprintf(arguments, sizeof arguments, "set %s %s", path, entry);
    int good = write_sample(kind, path, &err) == PM_OK && mangle(helper, arguments) &&
               load(kind, path, &err) == PM_INPUT && strstr(err.text, says) != NULL;
    ok(good, "%s: set %s", kind, entry);
    if (!good)
        printf("# got: %s\n", err.text);
}

int main(void)
{
    char folder[] = "/tmp/pm-schema-XXXXXX", path[64], helper[256];
    const char *build = getenv("BUILD");
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    snprintf(path, sizeof path, "%s/r.h5", folder);
    snprintf(helper, sizeof helper, "%s/tests/lib/mangle", build != NULL ? build : "build");
    test_table();
    for (int k = 0; k < SAMPLE_KINDS; k++)
        test_damage(helper, sample_kinds[k], path);
    static const char *const entries[][3] = {
        {"surface", "/surface1/type 0 2", "/surface1/type"},
        {"surface", "/surface1/d0 2 0", "expected > 0"},
        {"surface", "/surface1/tri 3 6", "/surface1/tri' is 6 at entry 3, expected 0 to 5"},
        {"surface", "/surface0/nu 0 5", "/surface0/nu"},
        {"surface", "/surface0/free 1 3", "expected 0 or 1"},
        {"surface", "/symmetry/perm 0 1", "/symmetry/perm"},
        {"surface", "/symmetry/perm 30 30", "/symmetry/perm"},
        {"state", "/mesh/tet 4 10", "/mesh/tet' is 10 at entry 4, expected 0 to 9"},
        {"state", "/mesh/tri 0 -1", "/mesh/tri"},
        {"state", "/mesh/tri_tag 1 3", "/mesh/tri_tag' is 3 at entry 1, expected -5 to 2"},
        {"state", "/mesh/surface 1 -2", "/mesh/surface"},
        {"state", "/mesh/weight_ptr 5 7", "/mesh/weight_ptr' falls at entry 6"},
        {"state", "/mesh/weight_ptr 0 1", "/mesh/weight_ptr' runs from 1"},
        {"state", "/mesh/weight_col 0 28", "/mesh/weight_col"},
        {"state", "/mesh/chambers 0 3", "/mesh/chambers"},
        {"state", "/load/form 0 2", "/load/form"},
        {"step", "/step/radius 0 0", "/step/radius"},
        {"step", "/accepted/surface1/tri 0 -1", "/accepted/surface1/tri"},
        {"work", "/measure/orientation 0 0", "/measure/orientation"},
        {"work", "/measure/form 0 -1", "/measure/form"},
    };
    for (size_t i = 0; i < sizeof entries / sizeof entries[0]; i++)
        refuse_entry(helper, entries[i][0], path, entries[i][1], entries[i][2]);
    unlink(path);
    ok(rmdir(folder) == 0, "no temporary is left");
    return tap_done();
}
