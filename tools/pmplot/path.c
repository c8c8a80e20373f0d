#include <stdio.h>

#include "tools/pmplot/pmplot.h"

void pmplot_path(const struct pm_sweep *s)
{
    const ptrdiff_t nc = s->mesh.nc;
    puts("# p [p/mu], U [mm, rad], volumes [mm3], energy [mJ], gap [mm], intersections");
    for (ptrdiff_t i = 0; i < s->np; i++) {
        if (!s->reached[i]) {
            puts(""); /* ends the curve */
            continue;
        }
        for (ptrdiff_t r = 0; r < nc; r++)
            printf("%.9g ", s->pressure[nc * i + r]);
        for (int k = 0; k < 6; k++)
            printf("%.9g ", s->U[6 * i + k]);
        for (ptrdiff_t r = 0; r < nc; r++)
            printf("%.9g ", s->volume[nc * i + r]);
        printf("%.9g %.6g %lld\n", s->energy[i], s->gap[i], (long long)s->intersections[i]);
    }
}
