/* The volume mesh with the weights of its surface nodes. Kind `mesh`; states hold one. */
#ifndef PM_MESH_H
#define PM_MESH_H

#include "common/files/case.h"
#include "common/files/h5.h"

/* Tags of boundary faces: 0 lateral exterior, 1..n chambers, and the planes: */
enum {
    PM_FACE_EXTERIOR = 0,
    PM_FACE_BASE = -1,
    PM_FACE_TIP = -2,
    PM_FACE_SYM_X = -3,
    PM_FACE_SYM_Y = -4,
    PM_FACE_SYM_Z = -5
};

/* How a mesh came about. */
enum { PM_ORIGIN_GENERATED = 0, PM_ORIGIN_MORPHED = 1, PM_ORIGIN_IMPORTED = 2 };

struct pm_mesh {
    struct pm_case pcase;
    char failure[512]; /* "" or why there is no mesh (--record-failure): then nothing else is valid
                          but pcase */
    ptrdiff_t nn, ne, nf, nc; /* nodes, tetrahedra, boundary faces, chambers */
    ptrdiff_t npe, npf;       /* nodes of a tetrahedron and of a face: 10 and 6, or 4 and 3 for a
                                 linear mesh, which has no control points */
    double *x;                /* reference node positions                         (nn x 3)  [mm] */
    double *x_generated; /* as generated: the Laplace extension [model 5] is built on them (nn x 3)
                            [mm] */
    int32_t *tet; /* node ids, gmsh order: vertices, edges (01)(12)(20)(30)(23)(13) (ne x npe) */
    int32_t *tri; /* boundary faces, node order vertices, edges (01)(12)(20); normal out of the
                     solid (nf x npf) */
    int32_t *tri_tag;          /* PM_FACE_*                                         (nf) */
    double reference_point[3]; /* end-effector [mm] */
    /* Surface nodes, x_a = sum_m wval phi^m over the row of a (CSR over global control points; the
     * damping of mid-side nodes is included, so x is linear in phi). Empty rows: interior and cap
     * nodes, or imported. */
    int32_t *surface;    /* owning surface (0 exterior, 1..n) or -1          (nn) */
    double *S;           /* surface parameter, 0 where surface is -1          (nn x 3) */
    ptrdiff_t nw, N;     /* stored weights; control points (0 for imported)            */
    int64_t *wptr;       /* (nn + 1) */
    int32_t *wcol;       /* (nw) */
    double *wval;        /* (nw) */
    int64_t *tag;        /* node numbers of the imported file, NULL otherwise (nn) */
    double max_damping;  /* largest 1 - t of a mid-side node */
    double min_jacobian; /* smallest scaled Jacobian, Bernstein lower bound */
    double coarse; /* part of the area of the surfaces where edges were 1.5 times longer than wanted
                      when it was generated; 0 for imported */
    int64_t origin;   /* PM_ORIGIN_* */
    int64_t delaunay; /* 1: HXT failed, made by the slower Delaunay mesher */
};

enum pm_status pm_mesh_read(struct pm_h5 *f, struct pm_mesh *m, struct pm_err *err);
/* Loads a mesh (kinds "mesh state"). A recorded failure is PM_INPUT unless `allow_failure`. */
enum pm_status pm_mesh_load(const char *path, int allow_failure, struct pm_mesh *m,
                            struct pm_err *err);
enum pm_status pm_mesh_write(struct pm_h5 *f, const struct pm_mesh *m,
                             struct pm_err *err); /* with VTKHDF */
void pm_mesh_release(struct pm_mesh *m);

#endif
