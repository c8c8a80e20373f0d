/* Distances between points and surfaces, enclosed volume and area. */
#ifndef PM_DISTANCE_H
#define PM_DISTANCE_H

#include "common/geometry/samples.h"

/* Foot of p on the surface: Gauss-Newton from S (3, in and out); *r (3) is the foot. Returns
 * through *distance the final distance [mm]; it is a local minimum near the start. */
enum pm_status pm_distance_project(const struct pm_map *map, int32_t type, const double *phi,
                                   const double p[3], struct pm_basis *work, double S[3],
                                   double r[3], double *distance, struct pm_err *err);
/* The closest approach of two surfaces, refined from the closest pair of samples. */
struct pm_approach {
    int32_t a, b;      /* surfaces */
    double x[3], y[3]; /* points on a and b [mm] */
    double distance;   /* [mm]; INFINITY where nothing is closer than the cutoff */
};
/* near (ns x ns, of which a < b is used). */
enum pm_status pm_distance_nearest(const struct pm_surfaces *s, const struct pm_samples *samples,
                                   double cutoff, struct pm_approach *near, struct pm_err *err);
/* Area and enclosed volume (the tube is closed by its planar rims) of surface k from its samples.
 */
double pm_samples_area(const struct pm_samples *samples, const double *phi, ptrdiff_t k);
double pm_samples_volume(const struct pm_samples *samples, const double *phi, ptrdiff_t k);

#endif
