/* One step of the optimisation: the proposed surfaces, what they came from, and the history. Kind
 * `step`; readable as surfaces (pm_surfaces_load): those are the proposed trial. */
#ifndef PM_STEP_H
#define PM_STEP_H

#include "common/files/surfaces.h"

/* One judged trial. */
struct pm_trial {
    int64_t iteration; /* 0 is the first design */
    int64_t accepted;  /* 1, 0 */
    int64_t renewed;   /* 1: no trial but the accepted design on a new mesh, 2: and with new control
                          points */
    double jump;       /* relative change of the objective by that, 0 for a trial */
    double measure;    /* T; 0 where the design failed (then the reason says why) */
    double amplification; /* largest of its points */
    double gap;   /* least across air of its states, 0 where one pierces itself, -1: wide [mm] */
    double merit; /* objective - rho_c C_c - rho_t C_t with the weights of its sub-problem */
    double predicted;                   /* predicted gain of merit over the last accepted design */
    double ratio;                       /* actual / predicted */
    double radius;                      /* trust radius of its sub-problem [mm] */
    double worst_curvature, worst_wall; /* largest relative violations, >= 0 */
    double rms_step;  /* rms surface displacement from the last accepted design [mm] */
    char reason[160]; /* of a rejection, "" */
};

struct pm_step {
    struct pm_surfaces trial;    /* proposed; pcase is the case of the run */
    struct pm_surfaces accepted; /* last accepted design (its pcase is a copy) */
    char verdict[16];     /* continue, converged, stalled; the latter propose the accepted design */
    double value;         /* objective of the accepted design */
    double *gradient;     /* its derivative by phi of the accepted design but for that by closeness,
                             projected on the symmetric free subspace (N x 3) */
    ptrdiff_t nclose;     /* regions where states of the accepted design are close to themselves */
    double *close_weight; /* a_g = -d objective / d G_g > 0     (nclose) */
    double *close_value;  /* G_g                                (nclose) */
    double *close_gradient; /* dG_g/dphi, projected alike         (nclose x N x 3) [1/mm] */
    ptrdiff_t npairs;  /* steps between accepted designs of these control points, oldest first */
    double *pair_step; /* (npairs x N x 3) [mm] */
    double *pair_gradient; /* change of the gradient over it (npairs x N x 3) */
    double penalty[2],
        worst[2];     /* sums of curvature and wall penalties without weights, largest violations */
    double weight[2]; /* rho_c, rho_t */
    int64_t renew;    /* 1: the proposal is the accepted design itself, to be reconstructed and
                         meshed anew */
    double radius;    /* of the proposal [mm] */
    double gain;      /* predicted gain of the objective of the proposal */
    double trial_penalty[2], trial_worst[2]; /* of the proposal */
    double rms_step, max_step;               /* of the proposal [mm] */
    ptrdiff_t ntrials;
    struct pm_trial *trials; /* (ntrials), oldest first */
};

enum pm_status pm_step_load(const char *path, struct pm_step *s, struct pm_err *err);
enum pm_status pm_step_write(struct pm_h5 *f, const struct pm_step *s, struct pm_err *err);
void pm_step_release(struct pm_step *s);

#endif
