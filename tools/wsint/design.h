/* The equilibria of one design: states, one point each, and paths. */
#ifndef WSINT_DESIGN_H
#define WSINT_DESIGN_H

#include "common/base/tool.h"
#include "tools/wsint/wsint.h"

struct wsint_design {
    struct pm_case pcase;
    ptrdiff_t nn;
    double *x;                  /* reference node positions of the first file (nn x 3) */
    struct wsint_point *points; /* (np) */
    ptrdiff_t np;
    char failure[512]; /* of a state or a point of a path, "" if all are equilibria */
};

/* Reads the operands. PM_INPUT unless they are of one case and mesh, and where one records a
 * failure; with record_failure that goes to d->failure. */
enum pm_status wsint_design_read(const struct pm_common *common, int record_failure,
                                 struct wsint_design *d, struct pm_err *err);
void wsint_design_release(struct wsint_design *d);

#endif
