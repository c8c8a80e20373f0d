#include "tools/trstep/near.h"

#include <math.h>
#include <string.h>

#include "common/base/memory.h"

static ptrdiff_t unknowns(const struct pm_step *s)
{
    return 3 * s->accepted.offset[s->accepted.ns];
}

double near_at(const struct pm_step *s, const double *d, double factor, double *slope)
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

/* One more state, without values. */
static enum pm_status grow(struct pm_step *s, struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t n = unknowns(s), most = s->nclose + 1;
    double *grown[3] = {NULL};
    double **const all[3] = {&s->close_weight, &s->close_value, &s->close_gradient};
    const ptrdiff_t size[3] = {1, 1, n};
    for (int k = 0; k < 3; k++) {
        PM_TRY(PM_NEW(grown[k], most * size[k], err));
        if (s->nclose > 0)
            memcpy(grown[k], *all[k], (size_t)(s->nclose * size[k]) * sizeof(double));
    }
    for (int k = 0; k < 3; k++) {
        double *old = *all[k];
        *all[k] = grown[k];
        grown[k] = old;
    }
    s->nclose = most;
done:
    for (int k = 0; k < 3; k++)
        pm_free(grown[k]);
    return status;
}

enum pm_status near_add(struct pm_step *s, double weight, double value, const double *gradient,
                        struct pm_err *err)
{
    enum pm_status status;
    const ptrdiff_t n = unknowns(s);
    PM_TRY(grow(s, err));
    s->close_weight[s->nclose - 1] = weight;
    s->close_value[s->nclose - 1] = value;
    memcpy(s->close_gradient + n * (s->nclose - 1), gradient, (size_t)n * sizeof *gradient);
done:
    return status;
}

enum pm_status near_copy(const struct pm_step *from, struct pm_step *to, struct pm_err *err)
{
    enum pm_status status = PM_OK;
    for (ptrdiff_t k = 0; k < from->nclose; k++)
        PM_TRY(near_add(to, from->close_weight[k], from->close_value[k],
                        from->close_gradient + unknowns(from) * k, err));
done:
    return status;
}
