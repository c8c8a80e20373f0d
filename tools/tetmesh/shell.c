#include "tools/tetmesh/shell.h"

#include <stdio.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"

void pm_shell_release(struct pm_shell *s)
{
    pm_free(s->x);
    pm_free(s->size);
    pm_free(s->S);
    pm_free(s->surface);
    pm_free(s->tri);
    pm_free(s->tag);
    *s = (struct pm_shell){0};
}

const char *pm_shell_name(int32_t tag, char name[32])
{
    if (tag > 0)
        snprintf(name, 32, "chamber %d", (int)tag);
    else
        snprintf(name, 32, "%s",
                 tag == PM_FACE_EXTERIOR ? "exterior"
                 : tag == PM_FACE_BASE   ? "base"
                                         : "tip");
    return name;
}

enum pm_status pm_shell_grow(struct pm_shell *s, ptrdiff_t nn, ptrdiff_t nt, struct pm_err *err)
{
    PM_GROW(s->x, 3 * (s->nn + nn), err);
    PM_GROW(s->size, s->nn + nn, err);
    PM_GROW(s->S, 3 * (s->nn + nn), err);
    PM_GROW(s->surface, s->nn + nn, err);
    PM_GROW(s->tri, 3 * (s->nt + nt), err);
    PM_GROW(s->tag, s->nt + nt, err);
    return PM_OK;
}
