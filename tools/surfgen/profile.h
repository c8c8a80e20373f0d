/* Meridian of a shape of revolution about z, symmetric in z, with its parameter on the sphere, and
 * the cross-section that takes the place of the circle. The parameter is conformal where the
 * section is a circle; a turned ellipse is carried by arc length, its pitch by z. */
#ifndef PM_PROFILE_H
#define PM_PROFILE_H

#include "tools/surfgen/pneunet.h"

enum { PM_SECTION_PARTS = 512, PM_NET_FINE = 100 };

/* A polyline from the lower pole to the upper one, fine enough (about 0.02 mm) to stand for the
 * curve. */
struct pm_profile {
    ptrdiff_t n;
    double *r;              /* distance from the axis, 0 at both poles (n) [mm] */
    double *z;              /* height over the centre                  (n) [mm] */
    struct pm_pneunet *net; /* takes the place of r and z; r is the circumference over 2 pi */
    double *s;              /* arc length from the lower pole          (n) [mm] */
    double *psi;            /* integral ds/r from the middle, infinite at the poles (n) [1] */
    int round;              /* the section is a circle */
    double mean;            /* circumference over 2 pi r [1] */
    double quarter[2 * (PM_SECTION_PARTS + 1)]; /* of the section of radius 1, by arc length */
    double angle, twist; /* of the section at the middle [rad], per length [rad/mm] */
};

enum pm_status pm_profile_new(const struct pm_chamber *c, struct pm_profile *p, struct pm_err *err);
void pm_profile_release(struct pm_profile *p);
/* The place at arc length s in the tables, as a broken index; psi is infinite at the poles. */
double pm_profile_at_arc(const struct pm_profile *p, double s, double *r, double *psi);
/* The point there and at the fraction u of the way around, relative to the centre. */
void pm_profile_around(const struct pm_profile *p, double at, double u, double x[3]);
/* The point over S = (sech psi cos t, sech psi sin t, tanh psi), relative to the centre. */
void pm_profile_point(const struct pm_profile *p, const double S[3], double x[3]);
/* Half of the length along z. */
double pm_profile_half(const struct pm_chamber *c);
/* Radius at height z over the centre without the end caps: what the envelope of the body follows.
 */
double pm_profile_outer(const struct pm_chamber *c, double z);

#endif
