/* The first equilibrium of a mesh, from states on disk. */
#ifndef PM_START_H
#define PM_START_H

#include "common/mechanics/equilibrium.h"

/* Equilibrium at p (nc) [MPa] into c (undeformed on entry); the rest as pm_equilibrium. From the
 * one of the states at `paths` (ends with NULL; also of other loads, neighbouring shapes and
 * meshes) whose pressures are nearest to p; where there is none or it does not lead there, with a
 * warning, from the undeformed state. */
enum pm_status pm_start(struct pm_model *m, const double *p, const struct pm_solve_options *o,
                        const char *const *paths, struct pm_config *c, double *volume, double *f,
                        struct pm_solve_report *r, struct pm_err *err);

#endif
