/* The input deck of CalculiX (of Abaqus but for the rigid body) for the problem of a mesh [model 1
 * to 3]: node a is number a + 1, then follow the reference node and the rotation node of the
 * end-effector, whose displacement is the rotation vector. Units mm, kPa. Two load steps of time 1:
 * the load in increments, then held until the digits stand. */
#ifndef PM_MESHEXPORT_DECK_H
#define PM_MESHEXPORT_DECK_H

#include <stdio.h>

#include "common/files/mesh.h"

struct deck {
    const struct pm_mesh *mesh; /* borrowed, with at least one chamber */
    const double *pressure;     /* (nc) [p/mu] */
    long steps;
    const char *title; /* for a comment */
};

/* Where nodes belong: bits of deck_node_sets (nn). A clamped node is nothing else, a node of the
 * end-effector on no symmetry plane: its reference node is held there instead. */
enum { DECK_BASE = 1, DECK_TIP = 2, DECK_SYM = 4 /* x; y and z are the next two bits */ };
enum pm_status deck_node_sets(const struct pm_mesh *mesh, unsigned char **sets, struct pm_err *err);

/* PM_INPUT where the law has no card in CalculiX. */
enum pm_status deck_check(const struct pm_mesh *mesh, const char *path, struct pm_err *err);
/* Writes the deck; whether the stream took it is for the caller to ask. */
enum pm_status deck_write(const struct deck *d, FILE *out, struct pm_err *err);

#endif
