/* tetmesh: surfaces -> volume mesh, or an imported mesh. */
#ifndef PM_TETMESH_H
#define PM_TETMESH_H

#include "common/base/tool.h"
#include "common/files/mesh.h"

struct tetmesh_opts {
    double size;          /* wanted edge length [mm], 0: of the case */
    double crest;         /* edges over the radius of curvature, 0: of the case */
    long layers;          /* elements through a wall, 0: any, -1: of the case */
    double timeout;       /* [s], 0: none */
    const char *previous; /* mesh to morph, or NULL */
    int record_failure;
    int keep_mesh; /* fail where the previous mesh cannot be morphed */
    int whole;     /* the whole body even where a part of it is a model */
    /* instead of surfaces: */
    const char *import;    /* gmsh file, or NULL */
    int promote;           /* raise 4-node tetrahedra to 10 nodes */
    const char *case_file; /* case of an imported mesh, or NULL: */
    struct pm_material material;
    double mu; /* neo-Hookean shear modulus instead of law or preset [MPa], 0: not given */
    int have_reference;
    double reference[3]; /* [mm] */
};

/* Refuses (PM_USAGE) options that do not go together. */
enum pm_status tetmesh_check(const struct tetmesh_opts *o, const struct pm_common *common,
                             struct pm_err *err);
enum pm_status tetmesh_run(const struct tetmesh_opts *o, const struct pm_common *common,
                           struct pm_err *err);

#endif
