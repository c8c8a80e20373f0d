/* surface_drift FIRST.h5 NOW.h5 K: how far surface K has drifted from its first form. One line:
 * control points, volume ratio, mean and largest distance both ways [mm], variation of the edges
 * and of the distances to the nearest neighbour. */
#include <stdio.h>
#include <stdlib.h>

#include "common/files/surfaces.h"
#include "common/geometry/distance.h"
#include "tools/surfremesh/compare.h"
#include "tools/surfremesh/spacing.h"

int main(int argc, char **argv)
{
    enum pm_status status = PM_OK;
    struct pm_err err = {.status = PM_OK};
    struct pm_surfaces first = {.ns = 0}, now = {.ns = 0};
    struct compare_side a = {0}, b = {0};
    struct pm_spacing spacing;
    double mean, max;
    ptrdiff_t k;

    if (argc != 4)
        return PM_USAGE;
    k = strtol(argv[3], NULL, 10);
    PM_TRY(pm_surfaces_load(argv[1], &first, &err));
    PM_TRY(pm_surfaces_load(argv[2], &now, &err));
    if (k < 0 || k >= first.ns || k >= now.ns)
        PM_TRY(pm_fail(&err, PM_USAGE, "no surface %td", k));
    PM_TRY(compare_side_init(&a, &first.s[k], &err));
    PM_TRY(compare_side_init(&b, &now.s[k], &err));
    PM_TRY(compare_surfaces(&a, &b, NULL, &mean, &max, &err));
    PM_TRY(pm_spacing_of(&now.s[k], &spacing, &err));
    printf("%td\t%.5f\t%.4f\t%.4f\t%.3f\t%.3f\n", now.s[k].n,
           pm_samples_volume(&b.m, now.s[k].phi, 0) / pm_samples_volume(&a.m, first.s[k].phi, 0),
           mean, max, spacing.cv, spacing.near_cv);
done:
    if (status != PM_OK)
        fprintf(stderr, "%s\n", err.text);
    compare_side_release(&a);
    compare_side_release(&b);
    pm_surfaces_release(&first);
    pm_surfaces_release(&now);
    return status;
}
