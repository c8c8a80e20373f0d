#include <string.h>

#include "common/base/memory.h"
#include "tools/tetmesh/flat.h"
#include "tools/tetmesh/shell.h"
#include "tools/tetmesh/walls.h"

static enum pm_status add_patch(struct pm_shell *s, const struct pm_patch *p, int32_t k,
                                int32_t type, struct pm_err *err)
{
    if (pm_shell_grow(s, p->nn, p->nt, err) != PM_OK)
        return PM_SYSTEM;
    for (ptrdiff_t a = 0; a < p->nn; a++)
        for (int j = 0; j < 2; j++)
            if (p->rim[a] & pm_rim_plane(type, j) && s->planes >> j & 1)
                p->x[3 * a + j] = 0;
    memcpy(s->x + 3 * s->nn, p->x, (size_t)(3 * p->nn) * sizeof *s->x);
    memcpy(s->S + 3 * s->nn, p->S, (size_t)(3 * p->nn) * sizeof *s->S);
    memcpy(s->size + s->nn, p->size, (size_t)p->nn * sizeof *s->size);
    for (ptrdiff_t a = 0; a < p->nn; a++)
        s->surface[s->nn + a] = k;
    for (ptrdiff_t i = 0; i < 3 * p->nt; i++)
        s->tri[3 * s->nt + i] = (int32_t)(s->nn + p->tri[i]);
    for (ptrdiff_t t = 0; t < p->nt; t++)
        s->tag[s->nt + t] = k;
    s->nn += p->nn;
    s->nt += p->nt;
    return PM_OK;
}

struct pm_remesh_opts pm_shell_edges(double size, double crest)
{
    return (struct pm_remesh_opts){
        .size = size, .size_min = size / 6, .crest = crest, .growth = 0.35, .sweeps = 8};
}

enum pm_status pm_shell_build(const struct pm_surfaces *s, const struct pm_mirrors *y,
                              const struct pm_shell_opts *opts, struct pm_shell *shell,
                              struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const double size = opts->size, timeout = opts->timeout;
    struct pm_wall_side side = {.walls = opts->walls};
    struct pm_remesh_opts o = pm_shell_edges(size, opts->crest);
    struct pm_patch patch = {0};
    *shell = (struct pm_shell){.planes = y->planes};
    o.bound = opts->walls != NULL ? pm_walls_bound : NULL;
    if (opts->walls != NULL && opts->walls->apart) /* what a sixth of the size left to meet */
        o.size_min /= 4;
    o.data = &side;
    for (ptrdiff_t k = 0; k < s->ns; k++) {
        int kept;
        const unsigned cut = pm_mirrors_cut(y, s, k, &kept);
        if (!kept)
            continue;
        for (int j = 0; j < 2; j++)
            o.mirror[j] = cut >> j & 1;
        side.chamber = k > 0;
        PM_TRY(pm_remesh(&s->s[k], (int)k, &o, &patch, err));
        PM_TRY(add_patch(shell, &patch, (int32_t)k, s->s[k].type, err));
        if (k == 0) {
            PM_TRY(pm_flat_cap(shell, &patch, 1, size, timeout, err));
            PM_TRY(pm_flat_cap(shell, &patch, 2, size, timeout, err));
        }
        pm_patch_release(&patch);
    }
done:
    pm_patch_release(&patch);
    if (status != PM_OK)
        pm_shell_release(shell);
    return status;
}
