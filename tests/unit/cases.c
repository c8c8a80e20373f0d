/* All cases of data/cases: exact symmetry, surfaces where the case wants them, walls that are
 * whole.
 */
#include <glob.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/geometry/symmetry.h"
#include "tests/tap.h"
#include "tools/surfgen/surfgen.h"

/* Mean error: what a chamber may add to walls of 2.5 mm (2 %). Defect: rounding of 100 mm is
 * 1.4e-14. */
static void check_case(const char *path)
{
    struct pm_err err = {0};
    struct pm_case c = {0};
    struct pm_surfaces s = {0};
    struct pm_surfgen_report fit;
    double *phi = NULL;

    if (pm_case_load(path, &c, &err) != PM_OK || pm_surfgen(&c, &s, &fit, &err) != PM_OK ||
        PM_NEW(phi, 3 * s.offset[s.ns], &err) != PM_OK) {
        ok(0, "%s: %s", path, err.text);
    } else {
        pm_surfaces_gather(&s, phi);
        near_abs("symmetry defect [mm]", pm_symmetry_defect(&s, phi), 0, 1e-12);
        for (ptrdiff_t k = 0; k < s.ns; k++)
            ok(fit.mean[k] < 0.05, "%s: surface %td misses its shape by %.4f mm, at most %.3f",
               path, k, fit.mean[k], fit.max[k]);
        /* The edges of cells are the exception: the optimiser never has them. */
        int edges = c.chamber[0].shape == PM_SHAPE_PNEUNET;
        ok(fit.check.coverage >= 1 && (edges || fit.check.curvature <= c.curvature_max),
           "%s: cover %.2f, curvature %.3f /mm", path, fit.check.coverage, fit.check.curvature);
    }
    pm_free(phi);
    pm_surfaces_release(&s);
    pm_case_release(&c);
}

int main(void)
{
    glob_t found;

    if (glob("data/cases/*.ini", 0, NULL, &found) != 0)
        return tap_bail("no cases in data/cases");
    for (size_t i = 0; i < found.gl_pathc; i++)
        check_case(found.gl_pathv[i]);
    globfree(&found);
    return tap_done();
}
