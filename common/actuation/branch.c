#include "common/actuation/branch.h"

#include <math.h>

#include "common/mechanics/rotation.h"

static const double pi = 3.14159265358979323846;

int pm_branch_jump(const double a[3], const double b[3])
{
    const double length = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    double own = 0, less = 0, more = 0;

    if (length == 0)
        return 0;
    for (int i = 0; i < 3; i++) {
        const double turn = 2 * pi * b[i] / length;
        own += (b[i] - a[i]) * (b[i] - a[i]);
        less += (b[i] - turn - a[i]) * (b[i] - turn - a[i]);
        more += (b[i] + turn - a[i]) * (b[i] + turn - a[i]);
    }
    return fmin(less, more) < own;
}

double pm_branch_tilt(const double theta[3])
{
    struct pm_rotation rot;
    pm_rotation_at(theta, 0, &rot);
    return atan2(hypot(rot.R[2], rot.R[5]), rot.R[8]);
}

double pm_branch_twist(const double theta[3])
{
    const double eta = sqrt(theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2]);
    const double twist = eta > 0 ? 2 * atan2(theta[2] / eta * sin(eta / 2), cos(eta / 2)) : 0;
    return twist > pi ? twist - 2 * pi : twist <= -pi ? twist + 2 * pi : twist;
}
