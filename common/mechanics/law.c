#include "common/mechanics/law.h"

#include <string.h>

enum pm_status pm_law_set(struct pm_law *law, const char *name, ptrdiff_t n, const double *c,
                          double kappa, struct pm_err *err)
{
    static const struct {
        const char *name;
        enum pm_law_kind kind;
        int least, most; /* parameters */
    } known[] = {{"neo-hookean", PM_LAW_NEO_HOOKEAN, 1, 1},
                 {"mooney-rivlin", PM_LAW_MOONEY_RIVLIN, 2, 2},
                 {"yeoh", PM_LAW_YEOH, 1, 3},
                 {"ogden", PM_LAW_OGDEN, 2, PM_LAW_MAX}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(name, known[k].name) == 0) {
            if (n < known[k].least || n > known[k].most ||
                (known[k].kind == PM_LAW_OGDEN && n % 2 != 0))
                return pm_fail(err, PM_INPUT, "material law '%s': found %td parameters", name, n);
            *law = (struct pm_law){.kind = known[k].kind, .n = n, .kappa = kappa};
            for (ptrdiff_t i = 0; i < n; i++)
                law->c[i] = c[i];
            law->mu = law->kind == PM_LAW_NEO_HOOKEAN ? c[0] : 2 * c[0];
            if (law->kind == PM_LAW_MOONEY_RIVLIN)
                law->mu += 2 * c[1];
            if (law->kind == PM_LAW_OGDEN)
                law->mu = 0.0;
            for (ptrdiff_t i = 0; i < n && law->kind == PM_LAW_OGDEN; i += 2)
                law->mu += 0.5 * c[i] * c[i + 1];
            if (!(law->mu > 0) || !(kappa > 0))
                return pm_fail(err, PM_INPUT,
                               "material: found mu = %g, kappa = %g MPa, expected both > 0",
                               law->mu, kappa);
            return PM_OK;
        }
    return pm_fail(err, PM_INPUT,
                   "unknown material law '%s', expected neo-hookean, mooney-rivlin, yeoh or ogden",
                   name);
}
