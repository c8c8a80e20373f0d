/* contract WORK.h5 ROW SENS.h5: the gradient of a sens file with --each against the sum of its
 * entries, dw/dU : dU + dw/dJ : dJ; prints the largest difference over the largest entry. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory.h"
#include "common/files/sens.h"
#include "common/files/work.h"

static enum pm_status contract(char **argv, struct pm_err *err)
{
    enum pm_status status;
    struct pm_work w = {.ng = 0};
    struct pm_sens s = {.N = 0};
    struct pm_h5 *f = NULL;
    double *dU = NULL, *dJ = NULL, worst = 0, size = 0;
    ptrdiff_t d[PM_MAX_RANK], row = strtol(argv[2], NULL, 10);
    PM_TRY(pm_work_load(argv[1], 0, &w, err));
    PM_TRY(pm_sens_load(argv[3], &s, err));
    PM_TRY(pm_h5_open(argv[3], "sens", &f, err));
    PM_TRY(pm_h5_get(f, "/each/dU", d, &dU, err));
    PM_TRY(pm_h5_get(f, "/each/dJ", d, &dJ, err));
    for (ptrdiff_t i = 0; i < 3 * s.N; i++) {
        double sum = 0;
        for (ptrdiff_t l = 0; l < 6; l++) {
            sum += w.dw_dU[6 * row + l] * dU[3 * s.N * l + i];
            for (ptrdiff_t r = 0; r < w.nc; r++)
                sum += w.dw_dJ[(6 * row + l) * w.nc + r] * dJ[3 * s.N * (w.nc * l + r) + i];
        }
        worst = fmax(worst, fabs(sum - s.gradient[i]));
        size = fmax(size, fabs(sum));
    }
    printf("%.2e\n", worst / size);
done:
    pm_h5_close(f);
    pm_free(dU);
    pm_free(dJ);
    pm_work_release(&w);
    pm_sens_release(&s);
    return status;
}

int main(int argc, char **argv)
{
    struct pm_err err = {.status = PM_OK};
    if (argc != 4) {
        fprintf(stderr, "usage: contract WORK.h5 ROW SENS.h5\n");
        return 2;
    }
    if (contract(argv, &err) == PM_OK)
        return 0;
    fprintf(stderr, "%s\n", err.text);
    return 1;
}
