#include "tools/invkin/report.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"

static const double degrees = 57.295779513082323; /* in a radian */

static const char *const verdicts[] = {"reached", "at-bound", "nearest", "no-equilibrium",
                                       "unfinished"};

/* "p1=high,p3=low", or "-". */
static void list_bounds(const struct pm_inverse *v, ptrdiff_t i, char *text, size_t size)
{
    size_t n = 0;
    snprintf(text, size, "-");
    for (ptrdiff_t k = 0; k < v->nc; k++) {
        const int64_t bound = v->bound[v->nc * i + k];
        if (bound != 0 && n < size)
            n += (size_t)snprintf(text + n, size - n, "%sp%td=%s", n > 0 ? "," : "", k + 1,
                                  bound > 0 ? "high" : "low");
    }
}

void invkin_tell(const struct pm_sweep *s, const struct pm_inverse *v, ptrdiff_t i)
{
    char bounds[128];
    list_bounds(v, i, bounds, sizeof bounds);
    pm_log(1,
           "target %td: %s, off by %.4g mm and %.4g degrees, bounds %s; %lld steps, %lld "
           "equilibria, %lld factorisations",
           i + 1, verdicts[v->verdict[i]], v->error[2 * i], degrees * v->error[2 * i + 1], bounds,
           (long long)v->iterations[i], (long long)v->equilibria[i],
           (long long)s->factorisations[i]);
}

void invkin_summarise(const struct pm_sweep *s, const struct pm_inverse *v)
{
    ptrdiff_t reached = 0, touching = 0;
    long long equilibria = 0, factorisations = 0;
    for (ptrdiff_t i = 0; i < v->np; i++) {
        reached += v->verdict[i] == PM_REACHED;
        touching += s->intersections[i] > 0;
        equilibria += v->equilibria[i];
        factorisations += s->factorisations[i];
    }
    if (reached < v->np)
        pm_warn("%td of %td targets are not reached", v->np - reached, v->np);
    if (touching > 0)
        pm_warn("self-contact is not modelled: the body penetrates itself at %td of %td targets",
                touching, v->np);
    pm_log(1, "%td of %td targets reached, %lld equilibria, %lld factorisations", reached, v->np,
           equilibria, factorisations);
}

enum pm_status invkin_fail(const struct pm_sweep *s, const struct pm_inverse *v, struct pm_err *err)
{
    char bounds[128], pressures[160];
    size_t n = 0;
    list_bounds(v, 0, bounds, sizeof bounds);
    for (ptrdiff_t k = 0; k < v->nc && n < sizeof pressures; k++)
        n += (size_t)snprintf(pressures + n, sizeof pressures - n, "%s%.6g", k > 0 ? "," : "",
                              s->pressure[k]);
    const int length = (int)strcspn(s->reason, "\n");
    return pm_fail(err, PM_NUMERIC,
                   "the target is not reached (%s): found %.4g mm and %.4g degrees off at "
                   "pressures %s, bounds %s, expected at most %g%s%.*s",
                   verdicts[v->verdict[0]], v->error[0], degrees * v->error[1], pressures, bounds,
                   v->tolerance, length > 0 ? ": " : "", length < 150 ? length : 150, s->reason);
}

void invkin_table(const struct pm_sweep *s, const struct pm_inverse *v)
{
    char bounds[128];
    printf("target\tverdict");
    for (ptrdiff_t k = 0; k < v->nc; k++)
        printf("\tp%td", k + 1);
    for (ptrdiff_t k = 0; k < v->nd; k++)
        printf("\tU%lld", (long long)v->dofs[k]);
    puts("\tmm\tdegrees\tbounds\titerations\tequilibria\tfactorisations");
    for (ptrdiff_t i = 0; i < v->np; i++) {
        list_bounds(v, i, bounds, sizeof bounds);
        printf("%td\t%s", i + 1, verdicts[v->verdict[i]]);
        for (ptrdiff_t k = 0; k < v->nc; k++)
            printf("\t%.9g", s->pressure[v->nc * i + k]);
        for (ptrdiff_t k = 0; k < v->nd; k++)
            printf("\t%.9g", s->U[6 * i + v->dofs[k] - 1]);
        printf("\t%.3g\t%.3g\t%s\t%lld\t%lld\t%lld\n", v->error[2 * i],
               degrees * v->error[2 * i + 1], bounds, (long long)v->iterations[i],
               (long long)v->equilibria[i], (long long)s->factorisations[i]);
    }
}
