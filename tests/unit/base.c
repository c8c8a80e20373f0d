/* Memory, errors, numbers of the command line, atomic files. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/atomic.h"
#include "common/base/libraries.h"
#include "common/base/memory.h"
#include "common/base/tool.h"
#include "tests/tap.h"

static void test_memory(void)
{
    struct pm_err err = {.status = PM_OK};
    double *v = NULL;
    ok(PM_NEW(v, 5, &err) == PM_OK && v[4] == 0, "zeroed");
    v[4] = 2;
    double *w = pm_realloc(v, 10, sizeof *v, &err);
    ok(w != NULL && w[4] == 2, "grows");
    pm_free(w);
    char *none = pm_calloc(0, 8, &err);
    ok(none != NULL, "nothing is not NULL");
    pm_free(none);
    ok(pm_calloc(PTRDIFF_MAX, 8, &err) == NULL && err.status == PM_SYSTEM, "overflow is seen: %s",
       err.text);
    err.status = PM_OK;
    ok(pm_calloc(-1, 8, &err) == NULL && err.status == PM_SYSTEM, "negative count");
    pm_memory_fail_at(2);
    void *a = pm_calloc(1, 1, &err), *b = pm_calloc(1, 1, &err), *c = pm_calloc(1, 1, &err);
    ok(a != NULL && b == NULL && c != NULL, "the second request fails, only that");
    pm_free(a);
    pm_free(c);
    err = (struct pm_err){.status = PM_OK};
    ok(pm_fail(&err, PM_INPUT, "first %d", 1) == PM_INPUT &&
           pm_fail(&err, PM_SYSTEM, "second") == PM_SYSTEM && err.status == PM_INPUT &&
           strcmp(err.text, "first 1") == 0,
       "the first failure wins");
}

static void test_numbers(void)
{
    struct pm_err err = {.status = PM_OK};
    double d, list[3];
    long n;
    int count;
    ok(pm_parse_double("x", "-1.5e-3", &d, &err) == PM_OK && d == -1.5e-3, "a number");
    ok(pm_parse_long("x", "-12", &n, &err) == PM_OK && n == -12, "an integer");
    ok(pm_parse_doubles("x", "1,2.5,-3", 3, list, &count, &err) == PM_OK && count == 3 &&
           list[2] == -3,
       "a list");
    static const char *const bad[] = {"", "1x", "x", "nan", "inf", "1,2", "1 ", "1e999"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        err.status = PM_OK;
        ok(pm_parse_double("x", bad[i], &d, &err) == PM_USAGE && strstr(err.text, "'--x'") != NULL,
           "no number: '%s'", bad[i]);
    }
    ok(pm_parse_long("x", "1.5", &n, NULL) == PM_USAGE, "no integer: 1.5");
    ok(pm_parse_long("x", "99999999999999999999", &n, NULL) == PM_USAGE, "an integer too large");
    static const char *const bad_list[] = {"", "1,", ",1", "1,2,3,4", "1;2", "1,a"};
    for (size_t i = 0; i < sizeof bad_list / sizeof bad_list[0]; i++)
        ok(pm_parse_doubles("x", bad_list[i], 3, list, &count, NULL) == PM_USAGE, "no list: '%s'",
           bad_list[i]);
}

static int write_to(const char *path)
{
    FILE *stream = fopen(path, "w");
    return stream != NULL && fputs("x", stream) >= 0 && fclose(stream) == 0;
}

static void test_atomic(void)
{
    char folder[] = "/tmp/pm-base-XXXXXX", path[64], lost[64];
    struct pm_err err = {.status = PM_OK};
    struct pm_atomic a;
    if (mkdtemp(folder) == NULL) {
        ok(0, "temporary folder");
        return;
    }
    snprintf(path, sizeof path, "%s/out", folder);
    snprintf(lost, sizeof lost, "%s/no/out", folder);
    ok(pm_atomic_begin(&a, lost, &err) == PM_SYSTEM && strstr(err.text, lost) != NULL,
       "no folder: %s", err.text);
    err.status = PM_OK;
    ok(pm_atomic_begin(&a, path, &err) == PM_OK && write_to(a.temporary),
       "write beside the target");
    ok(access(path, F_OK) != 0, "the target is not there yet");
    pm_atomic_abort(&a);
    ok(access(a.temporary, F_OK) != 0, "an abort removes the temporary");
    ok(pm_atomic_begin(&a, path, &err) == PM_OK && write_to(a.temporary) &&
           pm_atomic_commit(&a, &err) == PM_OK,
       "a commit");
    pm_atomic_abort(&a);
    ok(access(path, F_OK) == 0 && unlink(path) == 0 && rmdir(folder) == 0,
       "leaves the target alone");
}

int main(void)
{
    test_memory();
    test_numbers();
    test_atomic();
    /* The check value that defines CRC-32/ISO-HDLC. */
    ok(pm_crc32(0, "123456789", 9) == 0xCBF43926u, "checksum");
    return tap_done();
}
