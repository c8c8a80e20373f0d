/* dgemm: GFlop/s of dense products of order 2000 on one thread, median of five; what a
 * factorisation could reach at most. */
#include <cblas.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "common/base/memory.h"
#include "common/base/tool.h"

enum { N = 2000, RUNS = 5 };

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static enum pm_status run(void *data, const struct pm_common *common, struct pm_err *err)
{
    enum pm_status status;
    double *A = NULL, *C = NULL, rate[RUNS];
    (void)data;
    (void)common;
    PM_TRY(PM_NEW(A, N * N, err));
    PM_TRY(PM_NEW(C, N * N, err));
    for (int k = 0; k < N * N; k++)
        A[k] = k % 17 * 0.1;
    for (int k = 0; k < RUNS; k++) {
        clock_t start = clock();
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, N, N, N, 1.0, A, N, A, N, 0.0, C, N);
        rate[k] = 2e-9 * N * N * (double)N * CLOCKS_PER_SEC / (double)(clock() - start);
    }
    qsort(rate, RUNS, sizeof rate[0], compare);
    printf("%.1f\n", rate[RUNS / 2]);
done:
    pm_free(A);
    pm_free(C);
    return status;
}

static enum pm_status option(void *data, const char *name, const char *value, struct pm_err *err)
{
    (void)data;
    (void)value;
    return pm_fail(err, PM_USAGE, "option --%s", name);
}

int main(int argc, char **argv)
{
    static const struct pm_option none[] = {{0}};
    static const struct pm_tool tool = {.name = "dgemm",
                                        .operands = "",
                                        .summary = "rate of dense products",
                                        .options = none,
                                        .output_optional = 1,
                                        .option = option,
                                        .run = run};
    return pm_tool_main(&tool, argc, argv, NULL);
}
