/* Configurations of a model in states on disk. */
#ifndef PM_RESTORE_H
#define PM_RESTORE_H

#include "common/files/state.h"
#include "common/mechanics/model.h"

/* c = the configuration of the state, whose element and mesh the model has. */
enum pm_status pm_config_restore(const struct pm_model *m, const struct pm_state *s,
                                 struct pm_config *c, struct pm_err *err);
/* s->u, U, bubble = c; nodes of the mesh that the element does not have are put between their
 * neighbours. */
enum pm_status pm_config_store(const struct pm_model *m, const struct pm_config *c,
                               struct pm_state *s, struct pm_err *err);

#endif
