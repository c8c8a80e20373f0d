/* Closed surfaces from STL (text, binary) and OBJ files. */
#ifndef PM_TRIMESH_READ_H
#define PM_TRIMESH_READ_H

#include "common/geometry/trimesh.h"

/* The surface in the file: nodes with equal coordinates are one, triangles with two equal nodes are
 * dropped, triangles run counter-clockwise seen from outside (turned where all run the other way).
 * OBJ: the lines v and f, polygons cut into fans. PM_INPUT naming file and place: unreadable lines,
 * coordinates that are no finite numbers, not one closed surface of genus 0. */
enum pm_status pm_trimesh_read(const char *path, struct pm_trimesh *m, struct pm_err *err);

#endif
