#include <stdio.h>
#include <string.h>

#include "tools/pmplot/pmplot.h"

void pmplot_boundary(const struct pm_workspace *w)
{
    const double degree = 180 / 3.14159265358979323846;
    const struct pm_case *c = &w->pcase;
    static const int corner[4] = {0, 1, 2, 2};
    const int flat = strcmp(w->name, "2T") == 0;

    printf("# %s: three coordinates, angle of pointing [degrees]\n", w->name);
    for (ptrdiff_t e = 0; e < w->ne; e++)
        for (int k = 0; k < (w->npe == 3 ? 4 : 2); k++) {
            const ptrdiff_t a = w->cell[w->npe * e + corner[k]];
            const double *x = w->x + 3 * a;
            printf("%.6g %.6g %.6g %.4f\n%s", flat ? x[c->dofs[0]] : x[0],
                   flat ? x[c->dofs[1]] : x[1], flat ? 0.0 : x[2], degree * w->angle[a],
                   k == 1   ? "\n"
                   : k == 3 ? "\n\n"
                            : "");
        }
}
