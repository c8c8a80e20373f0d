/* adjsens: gradient of the measure at one Gauss point with respect to all control points. */
#ifndef PM_ADJSENS_H
#define PM_ADJSENS_H

#include "common/base/tool.h"
#include "common/files/state.h"
#include "common/files/work.h"
#include "common/mechanics/extension.h"
#include "common/mechanics/model.h"

struct adjsens_opts {
    int check;
    long seed;     /* of the random directions of --check */
    double radius; /* largest control point displacement of the central differences [mm] */
};

/* A state solved again for its factor: everything the adjoint needs. */
struct adjsens_point {
    struct pm_state state;
    struct pm_work work;
    ptrdiff_t row; /* of this load in the work file */
    struct pm_model *m;
    struct pm_config c;
    struct pm_extension *extension;
    double *p, *f, *Jq, *J; /* [MPa] (nc); (nn x 3); (nc x nq); (6 x nc) per unit of p/mu */
};

enum pm_status adjsens_run(const struct adjsens_opts *opts, const struct pm_common *common,
                           struct pm_err *err);

/* Prints, for random symmetric-free directions in the chambers, the exterior and both, the
 * derivative by the gradient g (N x 3) and by central differences of the whole computation
 * (surface, morph, solve, measure) over a sweep of step sizes; PM_NUMERIC if the best of a sweep is
 * off by more than 1e-5. */
enum pm_status adjsens_check(const struct adjsens_opts *opts, struct adjsens_point *pt,
                             const double *g, struct pm_err *err);

#endif
