/* Casting moulds: two halves, the cores of the chambers, the plate that holds them. */
#ifndef PM_SURFEXPORT_MOULD_H
#define PM_SURFEXPORT_MOULD_H

#include "tools/surfexport/skin.h"

struct mould_opts {
    int pull;         /* axis along which the halves part: 0 x, 1 y */
    double wall;      /* least thickness of the mould [mm] */
    double print;     /* diameter of a circle of the area of a core print, 0: none [mm] */
    double clearance; /* gap around pins, prints and halves [mm] */
    double snap;      /* nodes this near to a plane of section are moved into it [mm] */
};

/* Half `side` (+1, -1) of a block around the exterior, split in the plane pull = 0, open at the
 * base (there the rubber is poured in), with four pins (+1) or holes for them (-1). *undercut is
 * the share of the cavity's area that faces against the pull. PM_INPUT where the plane misses the
 * body. */
enum pm_status mould_half(const struct skin *robot, const struct mould_opts *o, int side,
                          struct skin *half, double *undercut, struct pm_err *err);
/* The corners of that block, both halves: `wall` around the body, from its base up. */
enum pm_status mould_block(const struct skin *robot, const struct mould_opts *o, double low[3],
                           double high[3], struct pm_err *err);
/* The plate on the base of both halves, `wall` thick, with a lip around them, a socket for the
 * print of every chamber and two openings within the rim of the body, to pour and to vent. PM_INPUT
 * where a chamber has no print or there is no room for the openings. */
enum pm_status mould_plate(const struct skin *robot, const struct mould_opts *o,
                           ptrdiff_t nchambers, struct skin *plate, struct pm_err *err);
/* The core of a chamber: its surface joined to a print, the prism below the section that has the
 * area of the wanted print, down through the base by `wall`. PM_INPUT where the chamber has no such
 * section of one piece near its lower end, or where the print would meet another surface. */
enum pm_status mould_core(const struct skin *robot, const struct mould_opts *o, int32_t chamber,
                          ptrdiff_t nchambers, struct skin *core, struct pm_err *err);

#endif
