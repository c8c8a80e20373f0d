/* A tree of bounding boxes: which of them meet a box, what is nearest to a point, which two items
 * that face each other are nearest. */
#ifndef PM_BOXES_H
#define PM_BOXES_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/status.h"

struct pm_boxes;

/* box (n x 6): lowest and highest corner; normal (n x 3): unit normals of the items, or NULL; both
 * are copied. n log n. */
enum pm_status pm_boxes_new(ptrdiff_t n, const double *box, const double *normal,
                            struct pm_boxes **boxes, struct pm_err *err);
void pm_boxes_free(struct pm_boxes *boxes);
/* The boxes that meet this one (touching counts), in a fixed but unsorted order: id has room for n;
 * returns their number. */
ptrdiff_t pm_boxes_meet(const struct pm_boxes *boxes, const double box[6], int32_t *id);

/* Looks at item id and returns the new best: the lesser of `best` and its distance [mm]. */
typedef double pm_boxes_visit(void *data, int32_t id, double best);
/* Visits the items whose boxes are nearer to x than the best distance so far, near ones first;
 * returns the best. */
double pm_boxes_nearest(const struct pm_boxes *boxes, const double x[3], double best,
                        pm_boxes_visit *visit, void *data);

/* Looks at items a and b and returns the lesser of `best` and their distance [mm]. */
typedef double pm_boxes_visit_pair(void *data, int32_t a, int32_t b, double best);
/* Visits the pairs of items, each once, whose boxes are nearer than the best distance so far (0:
 * those that meet) and that may face each other: with d from a point of a to one of b and the
 * normals n of a, m of b, d.n >= cosine |d| and -d.m >= cosine |d|. cosine -1: all. Returns the
 * best. */
double pm_boxes_pairs(const struct pm_boxes *boxes, double cosine, double best,
                      pm_boxes_visit_pair *visit, void *data);

#endif
