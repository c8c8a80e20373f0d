/* Mid-side nodes on the true surfaces. */
#ifndef PM_MIDDLE_H
#define PM_MIDDLE_H

#include "common/files/surfaces.h"
#include "common/geometry/surface_map.h"
#include "tools/tetmesh/shell.h"

struct pm_middles {
    const struct pm_surfaces *s; /* borrowed */
    unsigned planes;             /* mirrors that cut the model */
    struct pm_map *map[PM_MAX_CHAMBERS + 1];
    struct pm_basis basis;
};

/* Two nodes of one surface. */
struct pm_edge_ends {
    const double *x[2]; /* (3) [mm] */
    const double *S[2]; /* (3) */
};

enum pm_status pm_middles_init(struct pm_middles *m, const struct pm_surfaces *s, unsigned planes,
                               struct pm_err *err);
void pm_middles_release(struct pm_middles *m);
/* The foot of the middle of an edge on surface k: parameter S (3) and x = r(S) (3) [mm]. Edges of a
 * rim or of a mirror plane have it there. */
enum pm_status pm_middle_find(struct pm_middles *m, ptrdiff_t k, const struct pm_edge_ends *e,
                              double S[3], double x[3], struct pm_err *err);
/* The foot of p (3) [mm] on surface k, from S (3, in and out): a local minimum of the distance,
 * along the rims and planes of the bits `rims` (remesh.h). Steps are at most a quarter of `chord`
 * mm. */
enum pm_status pm_middle_foot(struct pm_middles *m, ptrdiff_t k, unsigned rims, const double p[3],
                              double chord, double S[3], struct pm_err *err);
/* The shell with the middles of its edges as further nodes and its triangles cut in four: triangle
 * t becomes 4 t .. 4 t + 3. */
enum pm_status pm_shell_bend(struct pm_middles *m, const struct pm_shell *shell,
                             struct pm_shell *bent, struct pm_err *err);

#endif
