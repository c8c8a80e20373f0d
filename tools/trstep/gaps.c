#include "tools/trstep/gaps.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static ptrdiff_t unknowns(const struct pm_step *s)
{
    return 3 * s->accepted.offset[s->accepted.ns];
}

double gaps_at(const struct pm_step *s, const double *d, double factor, double *slope)
{
    const ptrdiff_t n = unknowns(s);
    double sum = 0;
    for (ptrdiff_t k = 0; k < s->nclose; k++) {
        const double *g = s->close_gradient + n * k, root = sqrt(s->close_value[k]);
        double change = 0;
        for (ptrdiff_t i = 0; i < n; i++)
            change += g[i] * d[i];
        const double now = fmax(root + change / (2 * root), 0);
        sum += s->close_weight[k] * (now * now - s->close_value[k]);
        for (ptrdiff_t i = 0; i < n && slope != NULL; i++)
            slope[i] += factor * s->close_weight[k] * now / root * g[i];
    }
    return sum;
}

enum pm_status gaps_add(struct pm_step *s, double weight, double value, const double *gradient,
                        struct pm_err *err)
{
    const ptrdiff_t n = unknowns(s), k = s->nclose;
    PM_GROW(s->close_weight, k + 1, err);
    PM_GROW(s->close_value, k + 1, err);
    PM_GROW(s->close_gradient, n * (k + 1), err);
    s->close_weight[k] = weight;
    s->close_value[k] = value;
    memcpy(s->close_gradient + n * k, gradient, (size_t)n * sizeof *gradient);
    s->nclose = k + 1;
    return PM_OK;
}

enum pm_status gaps_copy(const struct pm_step *from, struct pm_step *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t k = 0; k < from->nclose; k++)
        PM_TRY(gaps_add(to, from->close_weight[k], from->close_value[k],
                        from->close_gradient + unknowns(from) * k, err));
done:
    return status;
}
