#include "tools/wsint/design.h"

#include <stdio.h>
#include <string.h>

#include "common/base/memory.h"
#include "common/files/provenance.h"
#include "common/files/record.h"
#include "common/files/state.h"
#include "common/files/sweep.h"

void wsint_design_release(struct wsint_design *d)
{
    pm_case_release(&d->pcase);
    pm_free(d->x);
    pm_free(d->points);
}

/* Everything after the first file must belong to the same case and the same mesh. */
static enum pm_status check_case(struct wsint_design *d, const char *path, const struct pm_case *c,
                                 struct pm_err *err)
{
    if (d->pcase.text == NULL)
        return pm_case_copy(c, &d->pcase, err);
    if (strcmp(d->pcase.text, c->text) != 0)
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': its case differs from that of the other states", path);
    return PM_OK;
}

static enum pm_status check_mesh(struct wsint_design *d, const char *path, struct pm_mesh *m,
                                 struct pm_err *err)
{
    if (m->nc != d->pcase.nchambers)
        return pm_fail(err, PM_INPUT, "cannot use '%s': it has %td chambers, expected %td", path,
                       m->nc, d->pcase.nchambers);
    if (d->x == NULL) {
        d->nn = m->nn;
        d->x = m->x;
        m->x = NULL;
    } else if (d->nn != m->nn || memcmp(d->x, m->x, (size_t)(3 * m->nn) * sizeof(double)) != 0) {
        return pm_fail(err, PM_INPUT,
                       "cannot use '%s': its mesh differs from that of the other states", path);
    }
    return PM_OK;
}

/* n further points; *q is the first. */
static enum pm_status grow(struct wsint_design *d, ptrdiff_t n, struct wsint_point **q,
                           struct pm_err *err)
{
    void *more = pm_realloc(d->points, d->np + n, sizeof *d->points, err);
    if (more == NULL)
        return PM_SYSTEM;
    d->points = more;
    *q = d->points + d->np;
    memset(*q, 0, (size_t)n * sizeof **q);
    d->np += n;
    return PM_OK;
}

static void take(struct wsint_point *q, const char *path, ptrdiff_t nc, const double *pressure,
                 const double *U, const double *J)
{
    q->path = path;
    memcpy(q->pressure, pressure, (size_t)nc * sizeof(double));
    memcpy(q->U, U, sizeof q->U);
    memcpy(q->J, J, (size_t)(6 * nc) * sizeof(double));
}

static enum pm_status read_state(struct wsint_design *d, const char *path, int record_failure,
                                 struct pm_err *err)
{
    enum pm_status status;
    struct pm_state s = {0};
    struct wsint_point *q;

    PM_TRY(pm_state_load(path, record_failure, &s, err));
    PM_TRY(check_case(d, path, &s.mesh.pcase, err));
    if (s.failure[0] != '\0') {
        if (d->failure[0] == '\0')
            memcpy(d->failure, s.failure, sizeof d->failure);
        goto done;
    }
    PM_TRY(check_mesh(d, path, &s.mesh, err));
    PM_TRY(grow(d, 1, &q, err));
    take(q, path, s.mesh.nc, s.pressure, s.U, s.J);
    q->intersections = s.contact.intersections;
    q->gap = s.contact.gap;
    q->closeness = s.contact.closeness;
done:
    pm_state_release(&s);
    return status;
}

static enum pm_status read_path(struct wsint_design *d, const char *path, int record_failure,
                                struct pm_err *err)
{
    enum pm_status status;
    struct pm_sweep s = {0};
    struct wsint_point *q;
    char why[sizeof d->failure];

    PM_TRY(pm_sweep_load(path, &s, err));
    PM_TRY(check_case(d, path, &s.mesh.pcase, err));
    PM_TRY(check_mesh(d, path, &s.mesh, err));
    const ptrdiff_t nc = s.mesh.nc;
    PM_TRY(grow(d, s.np, &q, err));
    for (ptrdiff_t i = 0; i < s.np; i++) {
        if (!s.reached[i]) {
            snprintf(why, sizeof why, "point %td of a path has no equilibrium", i + 1);
            if (!record_failure)
                PM_TRY(pm_record_fail(path, why, err));
            if (d->failure[0] == '\0')
                memcpy(d->failure, why, sizeof d->failure);
        }
        take(&q[i], path, nc, s.pressure + nc * i, s.U + 6 * i, s.J + 6 * nc * i);
        q[i].intersections = s.intersections[i];
        q[i].gap = s.gap[i];
        q[i].closeness = s.closeness[i];
    }
done:
    pm_sweep_release(&s);
    return status;
}

enum pm_status wsint_design_read(const struct pm_common *common, int record_failure,
                                 struct wsint_design *d, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (int i = 0; i < common->noperands && status == PM_OK; i++) {
        char *kind = NULL, *history = NULL, *command = NULL;
        const char *path = common->operands[i];
        status = pm_h5_ancestry(path, &kind, &history, &command, err);
        if (status == PM_OK)
            status = kind != NULL && strcmp(kind, "path") == 0
                         ? read_path(d, path, record_failure, err)
                         : read_state(d, path, record_failure, err);
        pm_free(kind);
        pm_free(history);
        pm_free(command);
    }
    return status;
}
