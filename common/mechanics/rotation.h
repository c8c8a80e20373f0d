/* Rotation of the rigid end-effector by exponential coordinates with all derivatives [model 3]. */
#ifndef PM_ROTATION_H
#define PM_ROTATION_H

struct pm_rotation {
    double R[9];             /* R(theta) */
    double Ri[3][9];         /* dR/dtheta_i */
    double Rij[3][3][9];     /* second derivatives */
    double Rijk[3][3][3][9]; /* third derivatives */
};

/* R = I + a K + b K^2, K = [theta]_x, analytic for every theta; third = 0 leaves Rijk unset. */
void pm_rotation_at(const double theta[3], int third, struct pm_rotation *r);

#endif
