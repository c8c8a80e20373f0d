#ifndef PM_SURFREMESH_H
#define PM_SURFREMESH_H

#include "common/base/tool.h"
#include "common/files/surfaces.h"

enum surfremesh_method {
    SURFREMESH_REMESH,    /* isotropic remeshing; a new parametrisation where anisotropy asks */
    SURFREMESH_CONFORMAL, /* the same, always with a new parametrisation */
    SURFREMESH_PAPER,     /* Algorithm 1 of the paper */
};

struct surfremesh_opts {
    double spacing;  /* of the control points of chambers [mm]; 0: as the case says, and only where
                        needed */
    long points;     /* control points per chamber instead; 0: by spacing */
    double alpha;    /* of the fit */
    long iterations; /* of the fit; 0: 20, the paper's method 1 */
    enum surfremesh_method method;
    int or_keep; /* a refused result gives the input surfaces unchanged */
};

/* What happened; per surface (ns). */
struct surfremesh_report {
    char reason[256]; /* "" or why the surfaces are unchanged */
    int kept;         /* 1: surfaces unchanged */
    int refused;      /* 1: there was a result, and it was not acceptable */
    double *spacing_before,
        *spacing_after;   /* (ns) variation of the spacing; exterior: longest over mean */
    double *mean, *max;   /* (ns) distance of new and old surface, both ways [mm] */
    double *volume_ratio; /* (ns) new over old enclosed volume */
    double *bend; /* (ns) largest curvature, new over the larger of the old one and its limit */
};

enum pm_status surfremesh_run(struct surfremesh_opts *o, const struct pm_common *common,
                              struct pm_err *err);
/* New surfaces for old ones; *to is left empty where report->kept. */
enum pm_status pm_surfremesh(const struct pm_surfaces *from, const struct surfremesh_opts *o,
                             struct pm_surfaces *to, struct surfremesh_report *report,
                             struct pm_err *err);
enum pm_status surfremesh_report_init(struct surfremesh_report *r, ptrdiff_t ns,
                                      struct pm_err *err);
void surfremesh_report_release(struct surfremesh_report *r);

#endif
