#include "common/base/minimise.h"

#include <lbfgs.h>
#include <string.h>

#include "common/base/log.h"

struct problem {
    ptrdiff_t n;
    pm_minimise_value value;
    void *context;
    ptrdiff_t evaluations;
};

static lbfgsfloatval_t evaluate(void *instance, const lbfgsfloatval_t *z, lbfgsfloatval_t *g,
                                const int n, const lbfgsfloatval_t length)
{
    struct problem *p = instance;

    (void)length;
    p->evaluations++;
    for (ptrdiff_t i = p->n; i < n; i++) /* SSE builds of the library round n up */
        g[i] = 0;
    return p->value(p->context, z, g);
}

/* Interpolation cannot bracket where there is no value; halving survives that but may miss the
 * narrow range of a steep penalty. Each takes over where the other gives up, from the best point so
 * far. */
enum pm_status pm_minimise(ptrdiff_t n, double *z, pm_minimise_value value, void *context,
                           struct pm_err *err)
{
    static const int searches[] = {LBFGS_LINESEARCH_MORETHUENTE,
                                   LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE,
                                   LBFGS_LINESEARCH_MORETHUENTE};
    struct problem p = {.n = n, .value = value, .context = context};
    lbfgsfloatval_t *x = lbfgs_malloc((int)n), f = 0;
    lbfgs_parameter_t parameter;
    int end = -1;

    if (x == NULL)
        return pm_fail(err, PM_SYSTEM, "out of memory");
    memcpy(x, z, (size_t)n * sizeof *z);
    lbfgs_parameter_init(&parameter);
    parameter.m = 10;
    parameter.max_iterations = 50;
    parameter.epsilon = 1e-3;
    parameter.past = 5;
    parameter.delta = 3e-4;
    for (int k = 0; k < 3 && end < 0 && end != LBFGSERR_MAXIMUMITERATION; k++) {
        parameter.linesearch = searches[k];
        end = lbfgs((int)n, x, &f, evaluate, NULL, &p, &parameter);
        pm_log(2, "L-BFGS: code %d after %td evaluations, value %.4g", end, p.evaluations, f);
        if (end == LBFGSERR_OUTOFMEMORY)
            break;
    }
    memcpy(z, x, (size_t)n * sizeof *z);
    lbfgs_free(x);
    return end == LBFGSERR_OUTOFMEMORY ? pm_fail(err, PM_SYSTEM, "out of memory") : PM_OK;
}
