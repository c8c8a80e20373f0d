#include "tools/meshexport/meshexport.h"

#include <stdio.h>
#include <string.h>

#include "common/base/atomic.h"
#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/files/state.h"
#include "tools/meshexport/compare.h"
#include "tools/meshexport/deck.h"

/* Leaves the vertices and what belongs to them. */
static enum pm_status drop_edge_nodes(struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    struct pm_mesh *m = &s->mesh;
    int32_t *to = NULL;
    ptrdiff_t nn = 0;
    PM_TRY(PM_NEW(to, m->nn, err));
    for (ptrdiff_t i = 0; i < 4 * m->ne; i++) {
        m->tet[i] = m->tet[m->npe * (i / 4) + i % 4];
        to[m->tet[i]] = 1;
    }
    for (ptrdiff_t i = 0; i < 3 * m->nf; i++)
        m->tri[i] = m->tri[m->npf * (i / 3) + i % 3];
    for (ptrdiff_t a = 0; a < m->nn; a++) {
        if (to[a] == 0)
            continue;
        memmove(m->x + 3 * nn, m->x + 3 * a, 3 * sizeof *m->x);
        memmove(s->u + 3 * nn, s->u + 3 * a, 3 * sizeof *s->u);
        to[a] = (int32_t)nn++;
    }
    for (ptrdiff_t i = 0; i < 4 * m->ne; i++)
        m->tet[i] = to[m->tet[i]];
    for (ptrdiff_t i = 0; i < 3 * m->nf; i++)
        m->tri[i] = to[m->tri[i]];
    m->nn = nn;
    m->npe = 4;
    m->npf = 3;
done:
    pm_free(to);
    return status;
}

/* A state whose element CalculiX has too: the plain ones. Its mesh is the one of the element. */
static enum pm_status load_state(const char *path, struct pm_state *s, struct pm_err *err)
{
    enum pm_status status;
    PM_TRY(pm_state_load(path, 0, s, err));
    if (strcmp(s->element, "tet10") != 0 && strcmp(s->element, "tet4") != 0)
        PM_TRY(pm_fail(err, PM_INPUT,
                       "cannot use '%s': element '%s', expected one that CalculiX has: 'tet10' or "
                       "'tet4'",
                       path, s->element));
    if (strcmp(s->element, "tet4") == 0 && s->mesh.npe == 10)
        PM_TRY(drop_edge_nodes(s, err));
done:
    return status;
}

static enum pm_status write_deck(void *data, FILE *out, struct pm_err *err)
{
    return deck_write(data, out, err);
}

static enum pm_status export_deck(const struct meshexport_opts *o, const struct pm_common *common,
                                  struct pm_err *err)
{
    enum pm_status status;
    const char *path = common->operands[0];
    struct pm_state s = {0};
    if (o->npressure == 0)
        PM_TRY(load_state(path, &s, err));
    else
        PM_TRY(pm_mesh_load(path, 0, &s.mesh, err));
    PM_TRY(deck_check(&s.mesh, path, err));
    if (o->npressure > 0 && o->npressure != s.mesh.nc)
        PM_TRY(pm_fail(err, PM_USAGE, "option --pressure: %d values for %td chambers", o->npressure,
                       s.mesh.nc));
    struct deck d = {.mesh = &s.mesh,
                     .pressure = o->npressure > 0 ? o->pressure : s.pressure,
                     .steps = o->steps,
                     .title = common->command};
    PM_TRY(pm_atomic_write(common->output, write_deck, &d, err));
    pm_log(1, "%td nodes, %td elements %s, %td chambers", s.mesh.nn, s.mesh.ne,
           s.mesh.npe == 10 ? "C3D10" : "C3D4", s.mesh.nc);
done:
    pm_state_release(&s);
    return status;
}

static enum pm_status compare(const char *results, const char *path, struct pm_err *err)
{
    enum pm_status status;
    struct pm_state s = {0};
    double *u = NULL;
    PM_TRY(load_state(path, &s, err));
    PM_TRY(PM_NEW(u, 3 * (s.mesh.nn + 2), err));
    PM_TRY(compare_read(results, s.mesh.nn + 2, u, err));
    PM_TRY(compare_print(&s, u, err));
done:
    pm_free(u);
    pm_state_release(&s);
    return status;
}

enum pm_status meshexport_run(const struct meshexport_opts *opts, const struct pm_common *common,
                              struct pm_err *err)
{
    if (opts->compare != NULL && (common->output != NULL || opts->npressure > 0))
        return pm_fail(err, PM_USAGE, "option --compare: expected no -o and no --pressure");
    if (opts->compare != NULL)
        return compare(opts->compare, common->operands[0], err);
    if (common->output == NULL)
        return pm_fail(err, PM_USAGE, "expected -o FILE or --compare JOB.dat");
    return export_deck(opts, common, err);
}
