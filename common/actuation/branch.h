/* Branches of the rotation vector: theta and theta (1 - 2 pi/|theta|) are one rotation. */
#ifndef PM_BRANCH_H
#define PM_BRANCH_H

/* 1 if the rotation b has another rotation vector that is nearer to a than b itself: between two
 * neighbours the vector left its branch. */
int pm_branch_jump(const double a[3], const double b[3]);
/* The angle of the pointing direction R(theta) e_z to +e_z [rad]. */
double pm_branch_tilt(const double theta[3]);
/* The turn about the end-effector's axis: R = (bend) (twist about e_z), in (-pi, pi] [rad]. */
double pm_branch_twist(const double theta[3]);

#endif
