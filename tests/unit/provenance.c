/* Root attributes: inputs, history of ancestors, also beyond the 64 kB that fit an object header.
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/files/provenance.h"
#include "tests/records.h"
#include "tests/tap.h"

/* A sens file made by `command` from the operands. */
static enum pm_status make(const char *path, const char *command, int n, char **operands,
                           struct pm_err *err)
{
    enum pm_status status;
    struct pm_sens s = {.N = 0};
    struct pm_h5 *f = NULL;
    const struct pm_common common = {
        .tool = "t", .command = command, .noperands = n, .operands = operands};
    PM_TRY(sample_sens(&s, err));
    PM_TRY(pm_h5_create(path, "sens", &common, NULL, &f, err));
    PM_TRY(pm_sens_write(f, &s, err));
    PM_TRY(pm_h5_commit(f, err));
    f = NULL;
done:
    pm_h5_close(f);
    pm_sens_release(&s);
    return status;
}

static void expect_history(const char *path, const char *want)
{
    char *kind, *history, *command;
    struct pm_err err = {.status = PM_OK};
    int good = pm_h5_ancestry(path, &kind, &history, &command, &err) == PM_OK && history != NULL &&
               strcmp(history, want) == 0 && strcmp(kind, "sens") == 0;
    ok(good, "history of %s", strrchr(path, '/') + 1);
    if (!good)
        printf("# got '%.200s'\n", history != NULL ? history : "nothing");
    pm_free(kind);
    pm_free(history);
    pm_free(command);
}

static void test_chain(const char *folder)
{
    char a[64], b[64], c[64], d[64], text[64], absent[64];
    struct pm_err err = {.status = PM_OK};
    snprintf(a, sizeof a, "%s/a.h5", folder);
    snprintf(b, sizeof b, "%s/b.h5", folder);
    snprintf(c, sizeof c, "%s/c.h5", folder);
    snprintf(d, sizeof d, "%s/d.h5", folder);
    snprintf(text, sizeof text, "%s/x.ini", folder);
    snprintf(absent, sizeof absent, "%s/absent", folder);
    FILE *stream = fopen(text, "w");
    ok(stream != NULL && fputs("123456789", stream) >= 0 && fclose(stream) == 0, "a text input");
    ok(make(a, "first x", 2, (char *[]){text, absent}, &err) == PM_OK, "a from the text %s",
       err.text);
    ok(make(b, "second a", 1, (char *[]){a}, &err) == PM_OK, "b from a %s", err.text);
    ok(make(c, "third a", 1, (char *[]){a}, &err) == PM_OK, "c from a %s", err.text);
    ok(make(d, "fourth b c", 2, (char *[]){b, c}, &err) == PM_OK, "d from b and c %s", err.text);
    expect_history(a, "");
    expect_history(b, "first x");
    expect_history(d, "first x\nsecond a\nthird a");
    struct pm_provenance p = {.inputs = NULL};
    const struct pm_common common = {.noperands = 2, .operands = (char *[]){text, absent}};
    ok(pm_provenance_collect(&p, &common, NULL, &err) == PM_OK &&
           strcmp(p.inputs, "case x.ini crc32:cbf43926") == 0,
       "inputs are the operands that exist");
    pm_provenance_release(&p);
    ok(pm_provenance_collect(&p, &common, (const char *const[]){absent, NULL}, &err) == PM_INPUT &&
           strstr(err.text, absent) != NULL,
       "a further input must exist: %s", err.text);
    pm_provenance_release(&p);
    unlink(a), unlink(b), unlink(c), unlink(d), unlink(text);
}

static void test_long(const char *folder)
{
    enum { LENGTH = 200000 };
    char a[64], b[64];
    struct pm_err err = {.status = PM_OK};
    char *text = calloc(LENGTH + 1, 1);
    snprintf(a, sizeof a, "%s/a.h5", folder);
    snprintf(b, sizeof b, "%s/b.h5", folder);
    if (text == NULL)
        return;
    memset(text, 'x', LENGTH);
    ok(make(a, text, 0, NULL, &err) == PM_OK && make(b, "b", 1, (char *[]){a}, &err) == PM_OK,
       "a command of 200 kB %s", err.text);
    expect_history(b, text);
    free(text);
    unlink(a), unlink(b);
}

int main(void)
{
    char folder[] = "/tmp/pm-provenance-XXXXXX";
    if (mkdtemp(folder) == NULL)
        return tap_bail("no temporary folder");
    test_chain(folder);
    test_long(folder);
    ok(rmdir(folder) == 0, "nothing is left");
    return tap_done();
}
