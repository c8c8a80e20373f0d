#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/actuation/amplification.h"
#include "common/actuation/measure.h"
#include "common/base/memory.h"
#include "common/geometry/closeness.h"
#include "tools/wsint/wsint.h"

/* Pressures are written as computed by pm_load_set; the slack only forgives decimal input to
 * fesolve. */
static int same_pressure(const double *a, const double *b, ptrdiff_t n, double range)
{
    for (ptrdiff_t r = 0; r < n; r++)
        if (fabs(a[r] - b[r]) > 1e-9 * range)
            return 0;
    return 1;
}

static enum pm_status missing_point(const struct pm_case *c, enum pm_form form,
                                    const struct pm_load *l, ptrdiff_t g, struct pm_err *err)
{
    char text[PM_MAX_CHAMBERS * 16] = "";
    for (ptrdiff_t r = 0, at = 0; r < c->nchambers; r++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%s%.6g", r > 0 ? "," : "", l->p[r]);
    return pm_fail(err, PM_INPUT,
                   "no state at point %td of the %s form (p/mu = %s), expected every point once", g,
                   pm_form_name(form), text);
}

enum pm_status wsint_match(const struct pm_case *c, struct wsint_point *points, ptrdiff_t np,
                           struct wsint_set *s, struct pm_err *err)
{
    enum pm_status status;
    const double range = fmax(fabs(c->pmin), fabs(c->pmax));
    ptrdiff_t found = 0, guards = 0, missing = -1;

    PM_TRY(pm_load_set(c, s->form, &s->loads, &s->ng, err));
    PM_TRY(PM_NEW(s->order, s->ng, err));
    for (ptrdiff_t g = 0; g < s->ng; g++) {
        s->order[g] = -1;
        for (ptrdiff_t i = 0; i < np; i++) {
            if (!same_pressure(points[i].pressure, s->loads[g].p, c->nchambers, range))
                continue;
            if (s->order[g] >= 0)
                PM_TRY(pm_fail(err, PM_INPUT,
                               "'%s' and '%s' are states at the same point %td of the %s form",
                               points[s->order[g]].path, points[i].path, g, pm_form_name(s->form)));
            s->order[g] = i;
            points[i].used = 1;
            found += s->loads[g].weight != 0;
            guards += s->loads[g].weight == 0;
        }
        missing = s->order[g] < 0 && missing < 0 ? g : missing;
    }
    if (missing >= 0 && s->loads[missing].weight == 0 && guards == 0) { /* not of the measure */
        s->ng = missing;
        missing = -1;
    }
    if (found == 0)
        s->ng = 0;
    else if (missing >= 0)
        PM_TRY(missing_point(c, s->form, &s->loads[missing], missing, err));
done:
    return status;
}

void wsint_set_release(struct wsint_set *s)
{
    pm_free(s->loads);
    pm_free(s->order);
    *s = (struct wsint_set){0};
}

static enum pm_status allocate(struct pm_work *work, ptrdiff_t ng, ptrdiff_t nc, struct pm_err *err)
{
    enum pm_status status;
    work->ng = ng;
    work->nc = nc;
    PM_TRY(PM_NEW(work->load, ng, err));
    PM_TRY(PM_NEW(work->pressure, ng * nc, err));
    PM_TRY(PM_NEW(work->U, ng * 6, err));
    PM_TRY(PM_NEW(work->J, ng * 6 * nc, err));
    PM_TRY(PM_NEW(work->w, ng, err));
    PM_TRY(PM_NEW(work->dw_dU, ng * 6, err));
    PM_TRY(PM_NEW(work->dw_dJ, ng * 6 * nc, err));
    PM_TRY(PM_NEW(work->intersections, ng, err));
    PM_TRY(PM_NEW(work->gap, ng, err));
    PM_TRY(PM_NEW(work->closeness_at, ng, err));
    PM_TRY(PM_NEW(work->dw_dG, ng, err));
done:
    return status;
}

enum pm_status wsint_integrate(const struct pm_case *c, const struct wsint_point *points,
                               const struct wsint_set *s, struct pm_work *work, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t nc = c->nchambers;
    double *df_dJ = NULL;

    PM_TRY(allocate(work, s->ng, nc, err));
    work->form = s->form;
    work->value = work->closeness = 0;
    for (ptrdiff_t g = 0; g < s->ng; g++) {
        const struct wsint_point *q = &points[s->order[g]];
        work->load[g] = g;
        work->intersections[g] = q->intersections;
        work->gap[g] = q->gap;
        work->closeness_at[g] = q->closeness;
        work->closeness += s->loads[g].multiplicity * q->closeness;
        memcpy(work->pressure + g * nc, q->pressure, (size_t)nc * sizeof(double));
        memcpy(work->U + g * 6, q->U, sizeof q->U);
        memcpy(work->J + g * 6 * nc, q->J, (size_t)(6 * nc) * sizeof(double));
        if (s->loads[g].weight == 0)
            continue;
        PM_TRY(pm_measure_point(c, s->form, &s->loads[g], q->U, q->J, &work->w[g],
                                work->dw_dU + 6 * g, work->dw_dJ + g * 6 * nc, err));
        work->w[g] *= s->loads[g].weight;
        work->value += work->w[g];
    }
    if (work->orientation == 0)
        work->orientation = work->value < 0 ? -1 : 1;
    work->value *= work->orientation;
    PM_TRY(PM_NEW(df_dJ, 6 * nc * s->ng, err));
    const double f = pm_amplification(c, s->ng, work->J, &work->amplification, df_dJ),
                 h = pm_closeness_factor(work->closeness);
    work->objective = f * h * work->value;
    for (ptrdiff_t g = 0; g < s->ng; g++) {
        const double scale = f * h * work->orientation * s->loads[g].weight;
        work->w[g] *= work->orientation;
        for (ptrdiff_t i = 0; i < 6; i++)
            work->dw_dU[6 * g + i] *= scale;
        for (ptrdiff_t i = 6 * nc * g; i < 6 * nc * (g + 1); i++)
            work->dw_dJ[i] = scale * work->dw_dJ[i] + h * work->value * df_dJ[i];
        work->dw_dG[g] = pm_closeness_slope(s->loads[g].multiplicity) * work->objective;
    }
done:
    pm_free(df_dJ);
    return status;
}
