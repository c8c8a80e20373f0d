/* The workspace measure with its derivatives from the equilibria of one design at the Gauss points.
 */
#ifndef WSINT_H
#define WSINT_H

#include "common/actuation/loads.h"
#include "common/base/tool.h"
#include "common/files/state.h"
#include "common/files/work.h"

struct wsint_opts {
    const char *measure;   /* NULL: of the case */
    const char *form;      /* boundary, volume, NULL: of the case */
    const char *sign_from; /* work file that holds sigma, NULL: sign of this value */
    int record_failure;
    int points;      /* print the Gauss set of a case file, write nothing */
    int show;        /* print the result of a work or workspace file, write nothing */
    int dense;       /* the operands are samples of the boundary of the actuation box */
    int full;        /* symmetry drops no points */
    long per_axis;   /* Gauss points per axis, 0: of the case */
    double boundary; /* > 0: print the samples of a case file at this interval [p/mu] */
};

/* Reads the states and paths (operands), writes the work file or with o->dense the dense workspace;
 * or prints what o->points, o->boundary, o->show say.
 * PM_INPUT if they are not exactly the points of the Gauss set of the chosen form, each once, plus
 * all or none of the other form, of one design.
 */
enum pm_status wsint_run(const struct wsint_opts *opts, const struct pm_common *common,
                         struct pm_err *err);

/* Changes the case as the options say. */
enum pm_status wsint_apply(const struct wsint_opts *opts, struct pm_case *c, struct pm_err *err);
/* Lists for other programs (lists.c): the Gauss set, with a header; pressures for fesolve --path.
 */
enum pm_status wsint_print_points(const struct wsint_opts *opts, const struct pm_common *common,
                                  struct pm_err *err);
enum pm_status wsint_print_boundary(const struct wsint_opts *opts, const struct pm_common *common,
                                    struct pm_err *err);
struct wsint_design;
struct pm_workspace;
/* Writes the dense workspace of the samples of d; orientation 0: sigma = sign of the value. */
enum pm_status wsint_dense(const struct pm_common *common, const char *sign_from,
                           double orientation, struct wsint_design *d, struct pm_err *err);
void wsint_show_workspace(const struct pm_workspace *w);

/* End-effector results of one state, all that the measure needs. */
struct wsint_point {
    const char *path;                 /* borrowed */
    double pressure[PM_MAX_CHAMBERS]; /* [p/mu] */
    double U[6];                      /* [mm, rad] */
    double J[6 * PM_MAX_CHAMBERS];    /* (6 x n) per unit of p/mu */
    int64_t intersections;            /* of the deformed boundary with itself */
    double gap;                       /* [mm] */
    double closeness;                 /* G */
    int used;                         /* taken by a Gauss set */
};

/* The Gauss set of one form and the states at its points. */
struct wsint_set {
    enum pm_form form;
    ptrdiff_t ng;
    struct pm_load *loads; /* (ng) */
    ptrdiff_t *order;      /* index of the point at g (ng) */
};

/* Sorts the points (np) into the set of s->form by their pressures; ng = 0 if none is of that form.
 * PM_INPUT if some but not all are there or one is there twice. */
enum pm_status wsint_match(const struct pm_case *c, struct wsint_point *points, ptrdiff_t np,
                           struct wsint_set *s, struct pm_err *err);
void wsint_set_release(struct wsint_set *s);
/* T = sigma sum tau w with its derivatives; work->orientation 0: sigma = sign of the value. */
enum pm_status wsint_integrate(const struct pm_case *c, const struct wsint_point *points,
                               const struct wsint_set *s, struct pm_work *work, struct pm_err *err);

#endif
