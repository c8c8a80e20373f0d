/* How far surfaces are from those that they face, and the edge lengths that this asks for. */
#ifndef PM_WALLS_H
#define PM_WALLS_H

#include "tools/tetmesh/shell.h"

struct pm_boxes;

struct pm_walls {
    const struct pm_shell *bent; /* borrowed; best with middles on the true surface */
    struct pm_boxes *boxes;
    double *normal; /* of the triangles, out of the closed surface (nt x 3) */
    long layers;    /* elements wanted through a wall, 0: any */
    int apart;      /* 1: facets must not reach across walls or gaps */
    double reach;   /* distances beyond do not matter [mm] */
};

/* A surface of a shell. */
struct pm_wall_side {
    const struct pm_walls *walls;
    int chamber;
};

/* For edges of `size` mm at most. */
enum pm_status pm_walls_init(struct pm_walls *w, const struct pm_shell *bent, long layers,
                             int apart, double size, struct pm_err *err);
void pm_walls_release(struct pm_walls *w);
/* Distance [mm] from x to the nearest point of the shell or its images at the mirror planes that it
 * faces within 60 degrees of both normals, n out of x's side; solid = 1: through the solid, 0:
 * through air. `best` where there is none nearer. */
double pm_walls_facing(const struct pm_walls *w, const double x[3], const double n[3], int solid,
                       double best);
/* Bound of edge lengths for pm_remesh, data a struct pm_wall_side: a wall of d mm gets at least
 * `layers` edges across; `apart`: over a wall or gap of d mm edges rise at most d/4 above their
 * chord, h^2 k/8, and are at most 5 d long. */
double pm_walls_bound(const void *data, const double x[3], const double normal[3],
                      double curvature);

#endif
