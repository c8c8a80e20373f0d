/* Meridian of a shape of revolution about z, symmetric in z, with its conformal parameter on the
 * sphere. */
#ifndef PM_PROFILE_H
#define PM_PROFILE_H

#include "common/files/case.h"

/* A polyline from the lower pole to the upper one, fine enough (about 0.02 mm) to stand for the
 * curve. */
struct pm_profile {
    ptrdiff_t n;
    double *r;   /* distance from the axis, 0 at both poles (n) [mm] */
    double *z;   /* height over the centre                  (n) [mm] */
    double *s;   /* arc length from the lower pole          (n) [mm] */
    double *psi; /* integral ds/r from the middle, infinite at the poles (n) [1] */
};

enum pm_status pm_profile_new(const struct pm_chamber *c, struct pm_profile *p, struct pm_err *err);
void pm_profile_release(struct pm_profile *p);
/* The point at arc length s; psi is infinite at the poles. */
void pm_profile_at_arc(const struct pm_profile *p, double s, double *r, double *z, double *psi);
/* The point over S = (sech psi cos t, sech psi sin t, tanh psi), relative to the centre: the
 * conformal map. */
void pm_profile_point(const struct pm_profile *p, const double S[3], double x[3]);
/* Half of the length along z. */
double pm_profile_half(const struct pm_chamber *c);
/* Radius at height z over the centre without the end caps: what the envelope of the body follows.
 */
double pm_profile_outer(const struct pm_chamber *c, double z);

#endif
