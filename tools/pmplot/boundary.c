#include <stdio.h>
#include <string.h>

#include "common/actuation/measure.h"
#include "tools/pmplot/pmplot.h"

/* Names and units of the coordinates: `wsint --measure` took the usual DoFs of that measure. */
static void print_head(const struct pm_workspace *w, const int dofs[3])
{
    if (strcmp(w->name, "2R") == 0) {
        printf("# 2R: n_x, n_y, n_z, ");
    } else {
        printf("# %s: ", w->name);
        for (int i = 0; i < w->npe; i++)
            printf("U%d [%s], ", dofs[i] + 1, dofs[i] < 3 ? "mm" : "rad");
        if (w->npe == 2)
            printf("0, ");
    }
    printf("pointing angle [degrees]\n");
}

void pmplot_boundary(const struct pm_workspace *w)
{
    const double degree = 180 / 3.14159265358979323846;
    struct pm_case c = w->pcase; /* its arrays are borrowed */
    struct pm_err none = {.status = PM_OK};
    static const int corner[4] = {0, 1, 2, 2};
    const int flat = strcmp(w->name, "2T") == 0;

    if (strcmp(c.measure, w->name) != 0)
        (void)pm_measure_select(&c, w->name, &none);
    print_head(w, c.dofs);
    for (ptrdiff_t e = 0; e < w->ne; e++)
        for (int k = 0; k < (w->npe == 3 ? 4 : 2); k++) {
            const ptrdiff_t a = w->cell[w->npe * e + corner[k]];
            const double *x = w->x + 3 * a;
            printf("%.6g %.6g %.6g %.4f\n%s", flat ? x[c.dofs[0]] : x[0],
                   flat ? x[c.dofs[1]] : x[1], flat ? 0.0 : x[2], degree * w->angle[a],
                   k == 1   ? "\n"
                   : k == 3 ? "\n\n"
                            : "");
        }
}
