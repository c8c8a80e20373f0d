/* A straight bar on a lattice, clamped at z = 0, rigid or free at the other end: -width/2 <= x, y
 * <= width/2, or half of it, y >= 0, on a symmetry plane. */
#ifndef BAR_H
#define BAR_H

#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/files/mesh.h"
#include "tests/lattice.h"

struct bar {
    double width, length; /* [mm] */
    int cells, layers;    /* over the width, an even number; along the bar */
    int half, free_end;
};

static inline int bar_solid(const void *data, const int cell[3])
{
    (void)data;
    (void)cell;
    return 1;
}

static inline int32_t bar_tag(const struct bar *b, const struct lattice_face *f)
{
    if (f->axis == 2 && f->side == 0)
        return PM_FACE_BASE;
    if (f->axis == 2 && !b->free_end)
        return PM_FACE_TIP;
    return f->axis == 1 && f->side == 0 && b->half ? PM_FACE_SYM_Y : PM_FACE_EXTERIOR;
}

static inline void bar_case(const struct bar *b, struct pm_mesh *m)
{
    m->npe = 10;
    m->npf = 6;
    m->reference_point[2] = b->length;
    m->origin = PM_ORIGIN_IMPORTED;
    snprintf(m->pcase.law, sizeof m->pcase.law, "neo-hookean");
    m->pcase.law_parameter[0] = 1.0;
    m->pcase.nlaw_parameter = 1;
    m->pcase.kappa = 100.0;
}

/* What model and warp read of a mesh; pm_mesh_release. */
static inline enum pm_status bar_mesh(const struct bar *b, struct pm_mesh *m, struct pm_err *err)
{
    enum pm_status status;
    const int ny = b->half ? b->cells / 2 : b->cells;
    const struct lattice l = {.n = {b->cells, ny, b->layers},
                              .mirror = {b->cells / 2, b->half ? 0 : ny / 2, 0},
                              .solid = bar_solid};
    const int cells = b->cells * ny * b->layers;
    bar_case(b, m);
    m->nn = (2 * l.n[0] + 1) * (2 * l.n[1] + 1) * (2 * l.n[2] + 1);
    PM_TRY(PM_NEW(m->x, 3 * m->nn, err));
    PM_TRY(PM_NEW(m->tet, 10 * 6 * cells, err));
    PM_TRY(PM_NEW(m->tri, 6 * 12 * cells, err));
    PM_TRY(PM_NEW(m->tri_tag, 12 * cells, err));
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        int fine[3];
        lattice_fine(&l, (int32_t)a, fine);
        m->x[3 * a] = b->width * (fine[0] - b->cells) / (2 * b->cells);
        m->x[3 * a + 1] = b->width * (fine[1] - (b->half ? 0 : ny)) / (2 * b->cells);
        m->x[3 * a + 2] = b->length * fine[2] / (2 * b->layers);
    }
    for (int at = 0; at < 6 * cells; at++) {
        const int c = at / 6, cell[3] = {c % l.n[0], c / l.n[0] % ny, c / l.n[0] / ny};
        struct lattice_face face[2];
        lattice_tet(&l, cell, at % 6, m->tet + 10 * m->ne++);
        const int n = lattice_faces(&l, cell, at % 6, face);
        for (int k = 0; k < n; k++, m->nf++) {
            memcpy(m->tri + 6 * m->nf, face[k].node, sizeof face[k].node);
            m->tri_tag[m->nf] = bar_tag(b, &face[k]);
        }
    }
done:
    return status;
}

#endif
