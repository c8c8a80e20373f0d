/* Configurations of a model in states on disk. */
#ifndef PM_RESTORE_H
#define PM_RESTORE_H

#include "common/files/state.h"
#include "common/mechanics/model.h"

/* c = the configuration of the state, whose element and mesh the model has. */
enum pm_status pm_config_restore(const struct pm_model *m, const struct pm_state *s,
                                 struct pm_config *c, struct pm_err *err);
/* u = displacement of the nodes of the mesh (nn x 3) [mm]; those that the element does not have
 * (mid-side nodes of tet4) are put between their neighbours. */
void pm_config_displacement(const struct pm_model *m, const struct pm_config *c, double *u);
/* s->u, U, bubble = c. */
enum pm_status pm_config_store(const struct pm_model *m, const struct pm_config *c,
                               struct pm_state *s, struct pm_err *err);

#endif
