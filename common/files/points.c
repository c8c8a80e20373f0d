#include "common/files/points.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory.h"

enum { LINE = 4096 };

/* Where a line comes from, for messages. */
struct place {
    const char *path, *what, *why;
    long number;
};

static enum pm_status read_line(const struct place *at, char *line, ptrdiff_t n, double *x,
                                int *found, struct pm_err *err)
{
    ptrdiff_t k = 0;
    char *save = NULL;
    if (strchr(line, '\n') == NULL && strlen(line) == LINE - 1)
        return pm_fail(err, PM_INPUT, "cannot use '%s': line %ld is longer than %d characters",
                       at->path, at->number, LINE - 2);
    line[strcspn(line, "#\r\n")] = '\0';
    for (char *word = strtok_r(line, ", \t", &save); word != NULL;
         word = strtok_r(NULL, ", \t", &save), k++) {
        char *end;
        const double v = strtod(word, &end);
        if (*end != '\0' || !isfinite(v))
            return pm_fail(err, PM_INPUT, "cannot use '%s': line %ld: found '%.40s', expected a %s",
                           at->path, at->number, word, at->what);
        if (k < n)
            x[k] = v;
    }
    *found = k > 0;
    if (k > 0 && k != n)
        return pm_fail(err, PM_INPUT, "cannot use '%s': line %ld has %td %ss, %s", at->path,
                       at->number, k, at->what, at->why);
    return PM_OK;
}

enum pm_status pm_points_read(const char *path, ptrdiff_t n, const char *what, const char *why,
                              double **x, ptrdiff_t *np, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct place at = {path, what, why, 1};
    ptrdiff_t capacity = 0;
    char *line = NULL;
    int found = 0;
    FILE *f = fopen(path, "r");
    *x = NULL;
    *np = 0;
    if (f == NULL)
        return pm_fail(err, PM_INPUT, "cannot open '%s': %s", path, strerror(errno));
    PM_TRY(PM_NEW(line, LINE, err));
    for (; fgets(line, LINE, f) != NULL; at.number++) {
        if (*np == capacity) {
            void *more = pm_realloc(*x, n * (2 * capacity + 64), sizeof **x, err);
            if (more == NULL)
                PM_TRY(PM_SYSTEM);
            *x = more;
            capacity = 2 * capacity + 64;
        }
        PM_TRY(read_line(&at, line, n, *x + n * *np, &found, err));
        *np += found;
    }
    if (ferror(f))
        PM_TRY(pm_fail(err, PM_SYSTEM, "cannot read '%s': %s", path, strerror(errno)));
    if (*np == 0)
        PM_TRY(pm_fail(err, PM_INPUT, "cannot use '%s': no points, expected one a line", path));
done:
    fclose(f);
    pm_free(line);
    return status;
}
