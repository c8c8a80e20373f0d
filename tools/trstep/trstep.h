/* One step of the trust-region method: judge the trial, adapt, propose the next surfaces. */
#ifndef TRSTEP_H
#define TRSTEP_H

#include "common/base/tool.h"
#include "common/files/step.h"
#include "tools/trstep/trust.h"

struct trstep_opts {
    const char *previous; /* step file that proposed this trial, NULL at the first design */
    const char *history;  /* step file whose history is printed */
    const char *verdict;  /* step file whose verdict is printed */
    const char *next;     /* step file of which it is printed what it proposes */
    int judge;            /* print accept or reject only */
};

/* Operands SURF WORK SENS.. (the sens files of an accepted trial: every Gauss point once; none for
 * a rejected one). PM_NUMERIC if the first design itself failed. */
enum pm_status trstep_run(const struct trstep_opts *opts, const struct pm_common *common,
                          struct pm_err *err);

/* Proposes from step->accepted, value, gradient, weight, radius: fills trial, gain, penalties,
 * lengths, raises the weights, and halves the radius until the proposal holds the constraints.
 * verdict becomes stalled where no step holds them or gains merit; then, and where it is not
 * "continue" already, or the design is to be renewed, the trial is the accepted design. */
enum pm_status trstep_propose(struct pm_step *step, struct pm_err *err);

/* Prints the history, the verdict or the kind of proposal of a step file to stdout. */
enum pm_status trstep_print(const struct trstep_opts *opts, struct pm_err *err);

#endif
