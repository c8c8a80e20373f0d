#include "common/geometry/domain.h"

#include <math.h>

/* Beyond low or high along one axis. */
static double slab(double x, double low, double high, double *n)
{
    *n = low - x > x - high ? -1 : 1;
    return fmax(low - x, x - high);
}

double pm_domain_depth(const struct pm_case *c, int chamber, int axis, const double x[3],
                       double n[3])
{
    const double cap = chamber ? c->cap_min : 0, r = hypot(x[0], x[1]);

    n[0] = n[1] = n[2] = 0;
    if (axis == 2)
        return slab(x[2], cap, c->height - cap, &n[2]);
    if (chamber || c->domain == PM_DOMAIN_NONE)
        return -HUGE_VAL;
    if (c->domain == PM_DOMAIN_BOX)
        return slab(x[axis], -c->domain_half[axis], c->domain_half[axis], &n[axis]);
    if (axis == 1)
        return -HUGE_VAL;
    n[0] = r > 0 ? x[0] / r : 1;
    n[1] = r > 0 ? x[1] / r : 0;
    return r - c->domain_radius;
}
