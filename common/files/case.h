/* The design case: an INI text, parsed by libinih. Every file of a run carries the text of its case
 * in /case/text, so that no stage needs a file beyond its named inputs. Keys: pneumorph-case(5). */
#ifndef PM_CASE_H
#define PM_CASE_H

#include <stddef.h>

#include "common/base/status.h"
#include "common/files/material.h"

enum { PM_MAX_CHAMBERS = 8, PM_MAX_OPS = 12 };

/* FILE: from a closed triangle mesh that surfgen is given */
enum pm_shape {
    PM_SHAPE_SPHERE,
    PM_SHAPE_ELLIPSOID,
    PM_SHAPE_CAPSULE,
    PM_SHAPE_BELLOWS,
    PM_SHAPE_FILE,
    PM_SHAPE_PNEUNET
};
enum pm_body { PM_BODY_CYLINDER, PM_BODY_ENVELOPE, PM_BODY_FILE, PM_BODY_BOX };
enum pm_domain { PM_DOMAIN_NONE, PM_DOMAIN_CYLINDER, PM_DOMAIN_BOX };
/* How nodes inside follow those of the surfaces. */
enum pm_extension_kind { PM_EXTENSION_LAPLACE, PM_EXTENSION_ELASTICITY };
enum pm_form { PM_FORM_BOUNDARY = 0, PM_FORM_VOLUME = 1 };
enum pm_weight_kind { PM_WEIGHT_NONE, PM_WEIGHT_BOX, PM_WEIGHT_GAUSSIAN, PM_WEIGHT_HALF_SPACE };

/* Weight over the workspace: [workspace] weight and its parameters (actuation/weight.h). */
struct pm_weight {
    enum pm_weight_kind kind;
    int direction;    /* 0: of the position U_1..3 [mm], 1: of the pointing direction R e_z [1] */
    double center[3]; /* c: of box and gaussian, a point on the plane of the half-space */
    double size[3];   /* a: half-lengths of the box, standard deviations of the gaussian */
    double normal[3]; /* n: of the half-space, into it, unit length */
    double width;     /* of the transition of box and half-space */
};

/* [chamberN]: a shape of revolution about a line parallel to z through `center`, its cross-sections
 * made ellipses, turned and twisted: x = center + R(turn + twist z/length) (section[0] r cos t,
 * section[1] r sin t, z), R from the direction out of the z axis (+x where center lies on it). Or
 * FILE: `center` lies inside and tells chambers apart, all lengths but spacing are 0. */
struct pm_chamber {
    enum pm_shape shape;
    double center[3];  /* [mm] */
    double radius;     /* mean radius [mm] */
    double length;     /* along z, ends included [mm] */
    double amplitude;  /* of the bellows wave, crest to mean [mm] */
    double pitch;      /* of the bellows wave [mm] */
    double spacing;    /* wanted spacing of control points [mm] */
    double section[2]; /* half-axes over radius [1] */
    double turn;       /* of the first half-axis at the middle, in (-pi/2, pi/2] [rad] */
    double twist;      /* over the length, right-handed about z [rad] */
    /* pneunet: cells on a channel about `center`, flush with their inner sides */
    long cells;
    double thickness;    /* of a cell along z [mm] */
    double width, depth; /* of a cell across and out of the z axis [mm] */
    double channel;      /* side of the channel [mm] */
};

/* Angle of the first half-axis at height z over the centre, from +x [rad]. */
double pm_chamber_angle(const struct pm_chamber *c, double z);

/* Orthogonal operations x -> Q x + t that map the robot onto itself, identity first, with the
 * chamber permutation: chamber r goes to chamber chamber[r]. Chambers are 0-based. */
struct pm_symmetry {
    ptrdiff_t nops;
    double Q[PM_MAX_OPS][9];
    double t[PM_MAX_OPS][3];
    int chamber[PM_MAX_OPS][PM_MAX_CHAMBERS];
};

struct pm_case {
    char *text; /* the INI text itself, NUL terminated, owned */
    char name[64];
    /* [material] */
    char law[32]; /* neo-hookean, mooney-rivlin, yeoh, ogden */
    /* by law: neo-hookean {mu}, mooney-rivlin {c10, c01}, yeoh {c1, c2, c3}, ogden {mu1, alpha1,
     * mu2, alpha2, ..}: alpha [1], all others [MPa] */
    double law_parameter[PM_MAX_LAW_PARAMETERS];
    ptrdiff_t nlaw_parameter;
    double mu, kappa; /* small-strain shear modulus, bulk modulus [MPa] */
    /* [body] */
    enum pm_body body;
    double height;      /* H [mm] */
    double wall;        /* envelope: distance from the chambers along their normal [mm] */
    double web;         /* envelope: half-width of the web between the chambers [mm] */
    double body_radius; /* cylinder [mm] */
    double body_width, body_depth, body_rounding; /* box: along x, along y, corners [mm] */
    long around, rows; /* control points of the exterior B-spline around and along */
    /* chambers, images under the symmetry included */
    ptrdiff_t nchambers;
    struct pm_chamber chamber[PM_MAX_CHAMBERS];
    struct pm_symmetry symmetry;
    /* [actuation], ratios p/mu */
    double pmin, pmax;
    long points;  /* Gauss points per axis */
    int full_set; /* 1: symmetry drops no Gauss points */
    /* [workspace] */
    char measure[16]; /* 2T ... */
    enum pm_form form;
    int dofs[6]; /* 0-based rows of (U, J) that the measure uses */
    int ndofs;
    double lever; /* manifold over translations and rotations: arc of a rotation by 1 rad [mm] */
    int taylor;   /* 1: 3R by the field of the Taylor series, 0: by the exact one */
    struct pm_weight weight;
    /* [mesh] */
    double mesh_size;  /* wanted edge length [mm] */
    double mesh_crest; /* edges of the mesh are at most this times the radius of curvature [1] */
    long mesh_layers;  /* edges through a wall, at least */
    enum pm_extension_kind extension;
    /* [constraints] */
    double wall_min;          /* d_min [mm] */
    double void_min;          /* least width of grooves and cavities [mm] */
    double curvature_max;     /* C_max [1/mm] */
    int contact_rejects;      /* trials whose states pierce themselves */
    double gap_min;           /* air that states are kept open to [mm], 0: as they come */
    double amplification_max; /* of dU/dp at one point over the mean, 0: none [1] */
    double cap_min;           /* chambers stay this far from the planes z = 0 and z = H [mm] */
    enum pm_domain domain;    /* where the body stays, between the planes z = 0 and z = H */
    double domain_radius;     /* cylinder about z [mm] */
    double domain_half[2];    /* box: half-widths in x and y [mm] */
    /* [optimisation] */
    double radius,
        radius_max;    /* trust radius at the start and its cap: rms surface displacement [mm] */
    long secants;      /* accepted steps that the curvature of the model is made of, 0: linear */
    long remesh_every; /* reconstruction at every n-th iteration, 0: never */
    long max_iterations;
    double tolerance; /* relative change of the measure over five iterations */
};

enum pm_status pm_case_parse(const char *text, const char *name, struct pm_case *c,
                             struct pm_err *err);
enum pm_status pm_case_load(const char *path, struct pm_case *c, struct pm_err *err);
/* Warns of what is allowed but seldom meant: an Ogden term with mu alpha < 0. */
void pm_case_warn(const struct pm_case *c, const char *name);
enum pm_status pm_case_copy(const struct pm_case *from, struct pm_case *to, struct pm_err *err);
/* Another material: its lines take the place of the [material] section in c->text, and c is what
 * this text says. Where m names none, the law stays and its kappa is taken. c is kept on failure.
 */
enum pm_status pm_case_set_material(struct pm_case *c, const struct pm_material *m,
                                    struct pm_err *err);
void pm_case_release(struct pm_case *c);

#endif
