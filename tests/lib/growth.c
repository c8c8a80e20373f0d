/* growth SURF.h5 SENS.h5: the rate of the gradient where all chambers, and where the exterior, grow
 * along their normals by 1 mm, tapered to 0 at both ends of the body; tab separated. */
#include <math.h>
#include <stdio.h>

#include "common/base/memory.h"
#include "common/files/sens.h"
#include "common/geometry/curvature.h"
#include "common/geometry/surface_map.h"

/* 0 at the ends of the body, 1 in its middle half, C^1. */
static double taper(double v)
{
    const double t = fmin(fmax(4 * fmin(v, 1 - v), 0), 1);
    return t * t * (3 - 2 * t);
}

static enum pm_status growth(char **argv, struct pm_err *err)
{
    enum pm_status status;
    struct pm_surfaces s = {.ns = 0};
    struct pm_sens g = {.N = 0};
    struct pm_map *map = NULL;
    struct pm_basis work = {0};
    double rate[2] = {0};
    PM_TRY(pm_surfaces_load(argv[1], &s, err));
    PM_TRY(pm_sens_load(argv[2], &g, err));
    for (ptrdiff_t k = 0; k < s.ns; k++) {
        const struct pm_surface *f = &s.s[k];
        PM_TRY(pm_map_new(f, &map, err));
        for (ptrdiff_t i = 0; i < f->n; i++) {
            double r[3], r_a[6];
            struct pm_curvature c;
            PM_TRY(pm_map_point(map, f->phi, f->Phi + 3 * i, &work, r, r_a, NULL, err));
            pm_curvature_at(r_a, NULL, &c);
            for (int j = 0; j < 3; j++)
                rate[k == 0] +=
                    taper(r[2] / s.pcase.height) * c.n[j] * g.gradient[3 * (s.offset[k] + i) + j];
        }
        pm_map_free(map);
        map = NULL;
    }
    printf("%.6g\t%.6g\n", rate[0], rate[1]);
done:
    pm_map_free(map);
    pm_basis_release(&work);
    pm_surfaces_release(&s);
    pm_sens_release(&g);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    if (argc != 3) {
        fprintf(stderr, "usage: growth SURF.h5 SENS.h5\n");
        return 2;
    }
    if (growth(argv, &err) == PM_OK)
        return 0;
    fprintf(stderr, "%s\n", err.text);
    return 1;
}
