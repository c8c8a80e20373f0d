#include "common/mechanics/law.h"

#include <string.h>

#include "common/files/material.h"

enum pm_status pm_law_set(struct pm_law *law, const char *name, ptrdiff_t n, const double *c,
                          double kappa, struct pm_err *err)
{
    char names[128];
    ptrdiff_t count;
    const struct pm_material_law *known = pm_material_law(name);
    pm_material_law_names(names, sizeof names);
    if (known == NULL)
        return pm_fail(err, PM_INPUT, "unknown material law '%s', expected %s", name, names);
    if (!pm_material_takes(known, n))
        return pm_fail(err, PM_INPUT, "material law '%s': found %td parameters", name, n);
    *law = (struct pm_law){.kind = (enum pm_law_kind)(known - pm_material_laws(&count)),
                           .n = n,
                           .mu = pm_material_shear(known, n, c),
                           .kappa = kappa};
    memcpy(law->c, c, (size_t)n * sizeof *c);
    if (!(law->mu > 0) || !(kappa > 0))
        return pm_fail(err, PM_INPUT, "material: found mu = %g, kappa = %g MPa, expected both > 0",
                       law->mu, kappa);
    return PM_OK;
}
