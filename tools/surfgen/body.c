#include "tools/surfgen/body.h"

#include <math.h>

#include "common/geometry/tube.h"

static const double TWO_PI = 6.283185307179586476925;

void pm_body_point(const struct pm_outline *o, const double S[3], double x[3])
{
    pm_outline_point(o, atan2(S[1], S[0]) / TWO_PI, S[2], x);
}

enum pm_status pm_body_grid(const struct pm_case *c, struct pm_surface *s, struct pm_err *err)
{
    return pm_tube_seed(c->around, c->rows, s, err);
}

enum pm_status pm_body_seed(const struct pm_case *c, const struct pm_outline *o,
                            struct pm_surface *s, struct pm_err *err)
{
    enum pm_status status = pm_body_grid(c, s, err);

    for (ptrdiff_t i = 0; status == PM_OK && i < s->n; i++)
        pm_outline_point(o, (double)(i % s->nu) / (double)s->nu, s->Phi[3 * i + 2], &s->phi[3 * i]);
    return status;
}
