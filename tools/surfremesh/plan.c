#include <math.h>

#include "common/base/log.h"
#include "common/base/memory.h"
#include "common/geometry/samples.h"
#include "common/geometry/symmetry.h"
#include "tools/surfremesh/exterior.h"
#include "tools/surfremesh/rebuild.h"
#include "tools/surfremesh/spacing.h"

static const double CV_MAX = 0.25, SPACING_OFF = 0.15, LONGEST_MAX = 2.5, UNEVEN_MAX = 2.0;
static const double MEDIAN_MAX = 1.5, MOST_MAX = 3;

/* Least sum of kernels over the middles of the triangles, where it is low. */
static enum pm_status cover(const struct pm_surface *s, double *least, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double *S = NULL, Z;

    *least = INFINITY;
    PM_TRY(PM_NEW(S, 3 * s->nt, err));
    PM_TRY(pm_map_new(s, &map, err));
    pm_samples_parameters(s, s->Phi, 1, S);
    for (ptrdiff_t t = 0; t < s->nt; t++) {
        PM_TRY(pm_map_coverage(map, &S[3 * t], &work, &Z, err));
        *least = fmin(*least, Z);
    }
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_free(S);
    return status;
}

static enum pm_status plan_chamber(struct rebuild *r, ptrdiff_t k, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surface *s = &r->from->s[k];
    struct pm_spacing now;
    double wanted = r->from->pcase.chamber[k - 1].spacing, least;
    int crooked;

    PM_TRY(pm_spacing_of(s, &now, err));
    PM_TRY(cover(s, &least, err));
    if (r->o->spacing > 0)
        wanted = r->o->spacing;
    if (r->o->points > 0)
        wanted = sqrt(now.area / (sqrt(0.75) * (double)r->o->points));
    crooked = now.median > MEDIAN_MAX || now.most > MOST_MAX;
    const int asked = r->o->spacing > 0 || r->o->points > 0;
    r->spacing[k] = asked ? wanted : fmin(wanted, now.mean);
    r->method[k] =
        r->o->method == SURFREMESH_REMESH && crooked ? SURFREMESH_CONFORMAL : r->o->method;
    r->report->spacing_before[k] = now.cv;
    r->redo[k] = asked || crooked || now.cv > CV_MAX || now.longest > LONGEST_MAX ||
                 now.mean / wanted - 1 > SPACING_OFF || least < 1;
    pm_log(2,
           "surface %td: spacing %.3f mm for %.3f, variation %.3f, of nearest neighbours %.3f, "
           "longest %.2f, anisotropy %.2f (95 %%: %.2f), cover %.2f",
           k, now.mean, wanted, now.cv, now.near_cv, now.longest, now.median, now.most, least);
done:
    return status;
}

enum pm_status rebuild_plan(struct rebuild *r, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    const struct pm_surfaces *s = r->from;
    double off;

    PM_TRY(pm_exterior_unevenness(&s->s[0], &r->report->spacing_before[0], err));
    PM_TRY(pm_exterior_counts(&s->s[0], &r->nu, &r->nv, &off, err));
    r->redo[0] = r->report->spacing_before[0] > UNEVEN_MAX || off > SPACING_OFF;
    for (ptrdiff_t k = 1; k < s->ns; k++)
        PM_TRY(plan_chamber(r, k, err));
    for (ptrdiff_t k = 1; k < s->ns; k++) { /* the first of an orbit decides */
        ptrdiff_t source = 1 + pm_symmetry_source(&s->pcase.symmetry, k - 1, &r->by[k]);
        r->source[k] = source;
        r->redo[k] = r->redo[source];
        r->method[k] = r->method[source];
        r->spacing[k] = r->spacing[source];
    }
done:
    return status;
}
