/* Where a file comes from: the root attributes `inputs` and `history`. */
#ifndef PM_PROVENANCE_H
#define PM_PROVENANCE_H

#include "common/base/tool.h"

struct pm_provenance {
    char *inputs;  /* one line per input: role, name without folders, crc32 */
    char *history; /* command lines of all ancestors, oldest first, each distinct one once */
};

/* Inputs are the operands of `common` that exist as files, then `extra` (NULL terminated, may be
 * NULL). */
enum pm_status pm_provenance_collect(struct pm_provenance *p, const struct pm_common *common,
                                     const char *const *extra, struct pm_err *err);
void pm_provenance_release(struct pm_provenance *p);

/* kind, history and command of a pneumorph file in new memory (pm_free), NULL for other files
 * (h5.c). */
enum pm_status pm_h5_ancestry(const char *path, char **kind, char **history, char **command,
                              struct pm_err *err);

#endif
