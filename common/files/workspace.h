/* The dense workspace: the measure from samples all over the boundary of the actuation box, and the
 * surface they make. Kind `workspace`, also a VTKHDF file. */
#ifndef PM_WORKSPACE_H
#define PM_WORKSPACE_H

#include "common/files/case.h"
#include "common/files/h5.h"

struct pm_workspace {
    struct pm_case pcase;
    char name[16], unit[16];
    double value;         /* by Simpson's rule */
    double orientation;   /* sigma */
    double value_polygon; /* of the polygon or polyhedron of the samples; NAN where it has none */
    double value_coarse;  /* by every other sample; NAN where the intervals do not come in fours */
    double interval;      /* [p/mu] */
    double min_det, max_det;
    int64_t sign_changes;      /* samples where sigma det J < 0 */
    int64_t branch_jumps;      /* neighbours whose rotation vectors lie on different branches */
    int64_t interior;          /* 2R: turns of the path about the direction at the centre, else 0 */
    int64_t intersections;     /* samples where the body penetrates itself */
    double tilt[3];            /* largest, median, smallest angle of pointing [rad] */
    double rotation[3];        /* largest |U_4|, |U_5|, |U_6| [rad] */
    double twist;              /* largest turn about the end-effector's axis [rad] */
    ptrdiff_t nn, nc, ne, npe; /* samples, chambers, cells, samples a cell */
    double *x;        /* selected DoFs, 2R: the direction             (nn x 3) [mm, rad, 1] */
    double *pressure; /* (nn x nc) [p/mu] */
    double *U;        /* (nn x 6) */
    double *angle;    /* of pointing                                  (nn) [rad] */
    int32_t *cell;    /* segments or triangles, outward               (ne x npe) */
};

enum pm_status pm_workspace_load(const char *path, struct pm_workspace *w, struct pm_err *err);
enum pm_status pm_workspace_write(struct pm_h5 *f, const struct pm_workspace *w,
                                  struct pm_err *err);
void pm_workspace_release(struct pm_workspace *w);

#endif
