/* adjsens: shape derivatives at one load: of the measure, of pose and Jacobian one by one. */
#ifndef PM_ADJSENS_H
#define PM_ADJSENS_H

#include "common/base/tool.h"
#include "common/files/state.h"
#include "common/files/sens.h"
#include "common/files/work.h"
#include "common/mechanics/adjoint.h"
#include "common/mechanics/extension.h"
#include "common/mechanics/model.h"

struct adjsens_opts {
    enum pm_shape_form form;
    int each, nodal; /* all entries of U, J, V, C by control points, by nodes */
    int check;
    long seed;     /* of the random directions of --check */
    long points;   /* that many random control points of each surface one by one, too */
    double radius; /* largest control point displacement of the central differences [mm] */
};

/* A state solved again for its factor: everything the adjoint needs. */
struct adjsens_point {
    struct pm_state state;
    struct pm_work work; /* empty where no file was given */
    ptrdiff_t row;       /* of this load in it */
    struct pm_model *m;
    struct pm_config c;
    struct pm_extension *extension;
    double *p, *f, *Jq, *J; /* [MPa] (nc); (nn x 3); (nc x nq); (6 x nc) per unit of p/mu */
    double *near;           /* derivative of the objective by the closeness of the nodes (nn x 3) */
};

enum pm_status adjsens_run(const struct adjsens_opts *opts, const struct pm_common *common,
                           struct pm_err *err);

/* The adjoint's view of the point. */
struct pm_adjoint_at adjsens_at(const struct adjsens_point *pt);
/* D (nn x 3), replaced, to derivatives g (N x 3) by control points: through the extension in the
 * domain form, directly in the boundary form. */
enum pm_status adjsens_pull_back(struct adjsens_point *pt, enum pm_shape_form form, double *D,
                                 double *g, struct pm_err *err);
/* All entries that the options ask for, to out->each and out->nodal. */
enum pm_status adjsens_entries(const struct adjsens_opts *opts, struct adjsens_point *pt,
                               struct pm_sens *out, struct pm_err *err);

/* Prints, for random symmetric-free directions in the chambers, the exterior and both, and for
 * single control points, the derivative by the gradient g (N x 3) and by central differences of the
 * whole computation (surface, morph, solve, measure) over a sweep of step sizes, and the plateau;
 * PM_NUMERIC if the best of a sweep is off by more than 1e-5. */
enum pm_status adjsens_check(const struct adjsens_opts *opts, struct adjsens_point *pt,
                             const double *g, struct pm_err *err);

#endif
