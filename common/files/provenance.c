#include "common/files/provenance.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/libraries.h"
#include "common/base/memory.h"

static enum pm_status append(char **text, const char *line, size_t length, struct pm_err *err)
{
    size_t old = *text != NULL ? strlen(*text) : 0;
    char *longer = pm_realloc(*text, (ptrdiff_t)(old + length + 2), 1, err);
    if (longer == NULL)
        return PM_SYSTEM;
    if (old > 0)
        longer[old++] = '\n';
    memcpy(longer + old, line, length);
    longer[old + length] = '\0';
    *text = longer;
    return PM_OK;
}

static int holds_line(const char *text, const char *line, size_t length)
{
    for (const char *p = text; p != NULL && *p != '\0';) {
        size_t n = strcspn(p, "\n");
        if (n == length && strncmp(p, line, n) == 0)
            return 1;
        p += n + (p[n] == '\n');
    }
    return 0;
}

/* Appends the lines of `more` that are not there yet. */
static enum pm_status merge(char **text, const char *more, struct pm_err *err)
{
    for (const char *p = more; p != NULL && *p != '\0';) {
        size_t n = strcspn(p, "\n");
        if (!holds_line(*text, p, n)) {
            enum pm_status status = append(text, p, n, err);
            if (status != PM_OK)
                return status;
        }
        p += n + (p[n] == '\n');
    }
    return PM_OK;
}

static enum pm_status digest(const char *path, unsigned long *crc, struct pm_err *err)
{
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno));
    char block[16384];
    size_t n;
    *crc = 0;
    while ((n = fread(block, 1, sizeof block, stream)) > 0)
        *crc = pm_crc32(*crc, block, n);
    int failed = ferror(stream);
    fclose(stream);
    return failed ? pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", path, strerror(errno)) : PM_OK;
}

static enum pm_status add_input(struct pm_provenance *p, const char *path, struct pm_err *err)
{
    enum pm_status status;
    char *kind = NULL, *history = NULL, *command = NULL;
    unsigned long crc = 0;
    char line[512];
    PM_TRY(pm_h5_ancestry(path, &kind, &history, &command, err));
    PM_TRY(digest(path, &crc, err));
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    const char *role = kind != NULL                              ? kind
                       : dot != NULL && strcmp(dot, ".ini") == 0 ? "case"
                                                                 : "file";
    int length = snprintf(line, sizeof line, "%s %.400s crc32:%08lx", role, name, crc);
    PM_TRY(append(&p->inputs, line, (size_t)length, err));
    PM_TRY(merge(&p->history, history, err));
    PM_TRY(merge(&p->history, command, err));
done:
    pm_free(kind);
    pm_free(history);
    pm_free(command);
    return status;
}

enum pm_status pm_provenance_collect(struct pm_provenance *p, const struct pm_common *common,
                                     const char *const *extra, struct pm_err *err)
{
    enum pm_status status;
    *p = (struct pm_provenance){.inputs = NULL};
    PM_TRY(append(&p->inputs, "", 0, err));
    PM_TRY(append(&p->history, "", 0, err));
    for (int i = 0; i < common->noperands; i++) {
        struct stat s;
        if (stat(common->operands[i], &s) == 0 && S_ISREG(s.st_mode))
            PM_TRY(add_input(p, common->operands[i], err));
    }
    for (; extra != NULL && *extra != NULL; extra++)
        PM_TRY(add_input(p, *extra, err));
done:
    return status;
}

void pm_provenance_release(struct pm_provenance *p)
{
    pm_free(p->inputs);
    pm_free(p->history);
    *p = (struct pm_provenance){.inputs = NULL};
}
