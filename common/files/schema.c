#include "common/files/schema.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define D    PM_TYPE_DOUBLE
#define I32  PM_TYPE_INT32
#define I64  PM_TYPE_INT64
#define U8   PM_TYPE_UINT8
#define TEXT PM_TYPE_TEXT

/* clang-format off */
static const struct pm_item table[] = {
    {"surface mesh state path work sens step skin workspace", "/case/text", TEXT, "", "1", "the design case, pneumorph-case(5)", 1},
    {"mesh state work step", "/failure", TEXT, "", "1", "why there is no result; then only the case and the load are certain", 0},

    {"surface step", "/surface%d/type", I64, "", "1", "0 B-spline tube, 1 sphere map", 1},
    {"surface step", "/surface%d/phi", D, "n%d 3", "mm", "control points", 1},
    {"surface step", "/surface%d/free", U8, "n%d 3", "1", "1 where the coordinate is a design variable", 1},
    {"surface step", "/surface%d/Phi", D, "n%d 3", "1", "reference control points on the parameter shape", 1},
    {"surface step", "/surface%d/d0", D, "n%d", "1", "support radii, chord metric (B-spline: 0)", 1},
    {"surface step", "/surface%d/nu", I64, "", "1", "B-spline: control points around (sphere map: 0)", 1},
    {"surface step", "/surface%d/nv", I64, "", "1", "B-spline: control points along (sphere map: 0)", 1},
    {"surface step", "/surface%d/spacing", D, "2", "mm", "B-spline: wanted mean edge around and along (0: the numbers stay; sphere map: 0)", 1},
    {"surface step", "/surface%d/tri", I32, "nt%d 3", "1", "triangles of control points, outward", 1},
    {"surface step", "/symmetry/perm", I32, "nops N", "1", "control point i goes to perm under each operation", 1},
    {"surface", "/fit/mean", D, "ns", "mm", "mean distance of the wanted surface from the fitted one", 0},
    {"surface", "/fit/max", D, "ns", "mm", "largest such distance", 0},
    {"surface", "/reconstruction/kept", I64, "", "1", "1: surfremesh left the surfaces unchanged", 0},
    {"surface", "/reconstruction/reason", TEXT, "", "1", "why a result was refused, or empty", 0},
    {"surface", "/reconstruction/spacing_before", D, "ns", "1", "variation of the spacing (exterior: longest over mean)", 0},
    {"surface", "/reconstruction/spacing_after", D, "ns", "1", "the same afterwards", 0},
    {"surface", "/reconstruction/distance_mean", D, "ns", "mm", "mean distance of the new surface from the old one", 0},
    {"surface", "/reconstruction/distance_max", D, "ns", "mm", "largest such distance", 0},
    {"surface", "/reconstruction/volume_ratio", D, "ns", "1", "new over old enclosed volume", 0},
    {"surface", "/reconstruction/curvature", D, "ns", "1", "largest curvature over the larger of what it was and its limit", 0},
    {"surface mesh state path step", "/tip/reference_point", D, "3", "mm", "reference point of the end-effector", 1},

    {"mesh state path", "/mesh/x", D, "nn 3", "mm", "reference node positions", 1},
    {"mesh state path", "/mesh/x_generated", D, "nn 3", "mm", "node positions as generated, before morphing", 1},
    {"mesh state path", "/mesh/tet", I32, "ne npe", "1", "nodes of the tetrahedra, edges (01)(12)(20)(30)(23)(13) where npe = 10", 1},
    {"mesh state path", "/mesh/tri", I32, "nf npf", "1", "nodes of the boundary faces, outward, edges (01)(12)(20) where npf = 6", 1},
    {"mesh state path", "/mesh/tri_tag", I32, "nf", "1", "0 exterior, 1.. chambers, -1 base, -2 tip, -3 -4 -5 symmetry planes x y z", 1},
    {"mesh state path", "/mesh/chambers", I64, "", "1", "number of chambers", 1},
    {"mesh state path", "/mesh/control_points", I64, "", "1", "number of control points N, 0 for an imported mesh", 1},
    {"mesh state path", "/mesh/surface", I32, "nn", "1", "surface of the node, -1 for none", 1},
    {"mesh state path", "/mesh/S", D, "nn 3", "1", "surface parameter of the node", 1},
    {"mesh state path", "/mesh/weight_ptr", I64, "nn+1", "1", "first weight of each node", 1},
    {"mesh state path", "/mesh/weight_col", I32, "nw", "1", "control point of the weight", 1},
    {"mesh state path", "/mesh/weight_val", D, "nw", "1", "weight: x = sum weight * phi", 1},
    {"mesh state path", "/mesh/max_damping", D, "", "1", "largest damping of a mid-side node", 1},
    {"mesh state path", "/mesh/min_jacobian", D, "", "1", "smallest scaled Jacobian, lower bound", 1},
    {"mesh state path", "/mesh/coarse", D, "", "1", "part of the surfaces where edges were 1.5 times longer than wanted when it was generated", 0},
    {"mesh state path", "/mesh/origin", I64, "", "1", "0 generated, 1 morphed from a previous mesh, 2 imported", 1},
    {"mesh state path", "/mesh/delaunay", I64, "", "1", "1: HXT failed, made by the Delaunay mesher", 1},
    {"mesh state path", "/mesh/tag", I64, "nn", "1", "node numbers of the imported file", 0},

    {"mesh state path skin workspace", "/VTKHDF/NumberOfPoints", I64, "1", "1", "VTK: points", 1},
    {"mesh state path skin workspace", "/VTKHDF/NumberOfCells", I64, "1", "1", "VTK: cells", 1},
    {"mesh state path skin workspace", "/VTKHDF/NumberOfConnectivityIds", I64, "1", "1", "VTK: entries of Connectivity", 1},
    {"mesh state path skin workspace", "/VTKHDF/Connectivity", I64, "nv", "1", "VTK: nodes of the cells in VTK order", 1},
    {"mesh state path skin workspace", "/VTKHDF/Offsets", I64, "ne+1", "1", "VTK: first node of each cell", 1},
    {"mesh state path skin workspace", "/VTKHDF/Types", U8, "ne", "1", "VTK: 24, the quadratic tetrahedron, 10, the linear one, 5, the triangle, or 3, the line", 1},

    {"skin", "/skin/x", D, "nn 3", "mm", "node positions", 1},
    {"skin", "/skin/tri", I32, "ne 3", "1", "nodes of the triangles, outward", 1},
    {"skin", "/skin/tag", I32, "ne", "1", "0 exterior, 1.. chambers, -1 base, -2 tip, -10 mould, -11 core print", 1},
    {"skin", "/skin/surface", I32, "nn", "1", "surface of the node: 0 exterior and its caps, 1.. chambers, -1 none", 1},
    {"skin", "/skin/curvature", D, "nn", "1/mm", "root of the sum of squares of the principal curvatures", 0},
    {"skin", "/skin/wall", D, "nn", "mm", "distance to the nearest other surface", 0},

    {"state sens", "/load/form", I64, "", "1", "Gauss set: 0 boundary form, 1 volume form", 1},
    {"state sens", "/load/index", I64, "", "1", "point of the Gauss set, -1 for free pressures", 1},
    {"state", "/load/pressure", D, "nc", "p/mu", "chamber pressures", 1},
    {"state", "/node/displacement", D, "nn 3", "mm", "nodal displacement", 1},
    {"state", "/node/bubble", D, "nbubble 3", "mm", "amplitudes of the bubbles of element tet15", 0},
    {"state", "/tip/U", D, "6", "mm, rad", "end-effector translation and rotation vector", 1},
    {"state", "/tip/J", D, "6 nc", "mm, rad", "dU/d(p/mu)", 1},
    {"state", "/chamber/volume", D, "nc", "mm3", "deformed chamber volumes, of the meshed part", 1},
    {"state", "/chamber/volume0", D, "nc", "mm3", "reference chamber volumes, of the meshed part", 1},
    {"state", "/base/reaction", D, "6", "N, N mm", "force and moment of the clamp about the reference point", 1},
    {"state path", "/solve/element", TEXT, "", "1", "element", 1},
    {"state", "/solve/energy", D, "", "mJ", "strain energy of the meshed part", 1},
    {"state", "/solve/residual", D, "", "1", "largest residual over largest pressure load", 1},
    {"state", "/solve/min_det_F", D, "", "1", "smallest det F at a quadrature point", 1},
    {"state", "/solve/load_steps", I64, "", "1", "load steps", 1},
    {"state", "/solve/newton_steps", I64, "", "1", "Newton steps", 1},
    {"state", "/solve/factorisations", I64, "", "1", "factorisations", 1},
    {"state", "/solve/backoffs", I64, "", "1", "load steps taken back", 1},
    {"state", "/solve/unknowns", I64, "", "1", "unknowns", 1},
    {"state", "/solve/solves", I64, "", "1", "solves with a factor, all right-hand sides at once", 1},
    {"state", "/solve/factor_entries", D, "", "1", "entries of the factor", 1},
    {"state", "/solve/factor_flops", D, "", "1", "operations of one factorisation", 1},
    {"state", "/solve/limit", D, "", "1", "limit pressures over those wanted, 0: not sought or none", 1},
    {"state", "/solve/stable", I64, "", "1", "1: tangent positive definite at the solution", 1},
    {"state", "/solve/warm", I64, "", "1", "1: started from a guess", 1},
    {"state", "/contact/intersections", I64, "", "1", "pairs of boundary faces that pierce each other in the deformed body, or a symmetry plane", 1},
    {"state", "/contact/gap", D, "", "mm", "least distance of boundaries that face each other through air, 0 where they pierce, -1 where beyond 1/20 of the body", 1},
    {"state", "/contact/closeness", D, "", "1", "closeness G of boundaries that face each other within gap_min", 1},
    {"state", "/contact/at", D, "3", "mm", "where, in the deformed body", 1},
    {"state", "/contact/surface", I32, "2", "1", "the two boundaries there, as in /mesh/tri_tag", 1},

    {"path", "/path/pressure", D, "np nc", "p/mu", "chamber pressures, in the order in which they were solved", 1},
    {"path", "/path/reached", I64, "np", "1", "1: equilibrium, 0: none was found; then the other entries are 0", 1},
    {"path", "/path/reason", TEXT, "", "1", "one line a point: why it was not reached", 1},
    {"path", "/path/U", D, "np 6", "mm, rad", "end-effector translation and rotation vector", 1},
    {"path", "/path/J", D, "np 6 nc", "mm, rad", "dU/d(p/mu)", 1},
    {"path", "/path/volume", D, "np nc", "mm3", "deformed chamber volumes, of the meshed part", 1},
    {"path", "/path/energy", D, "np", "mJ", "strain energy of the meshed part", 1},
    {"path", "/path/residual", D, "np", "1", "largest residual over largest pressure load", 1},
    {"path", "/path/min_det_F", D, "np", "1", "smallest det F at a quadrature point", 1},
    {"path", "/path/factorisations", I64, "np", "1", "factorisations", 1},
    {"path", "/path/intersections", I64, "np", "1", "pairs of boundary faces that pierce each other", 1},
    {"path", "/path/gap", D, "np", "mm", "least distance across air, 0 where faces pierce, -1 where wide", 1},
    {"path", "/path/closeness", D, "np", "1", "closeness G of boundaries that face each other within gap_min", 1},
    {"path", "/path/displacement", D, "np nn 3", "mm", "nodal displacement", 1},

    {"path", "/inverse/dofs", I64, "nd", "1", "of invkin: components of the pose that are asked for, 1..6", 0},
    {"path", "/inverse/limits", D, "2", "p/mu", "least and largest pressure", 0},
    {"path", "/inverse/length", D, "", "mm", "what a radian weighs", 0},
    {"path", "/inverse/tolerance", D, "", "mm, degrees", "distance within which a target is reached", 0},
    {"path", "/inverse/target", D, "np nd", "mm, rad", "components of the pose asked for", 0},
    {"path", "/inverse/error", D, "np 2", "mm, rad", "distance from the target in position and in the rotation vector", 0},
    {"path", "/inverse/verdict", I64, "np", "1", "0 reached, 1 nearest pose, a pressure at a bound, 2 nearest pose, 3 no equilibrium on the way, 4 unfinished", 0},
    {"path", "/inverse/bound", I64, "np nc", "1", "pressure at its lower bound -1, upper 1, between them 0", 0},
    {"path", "/inverse/iterations", I64, "np", "1", "steps in pressure taken", 0},
    {"path", "/inverse/equilibria", I64, "np", "1", "finite element solutions", 0},

    {"work workspace", "/measure/value", D, "", "see /measure/unit", "workspace measure", 1},
    {"work workspace", "/measure/name", TEXT, "", "1", "2T 3T 2R 3R 1R2T 3R3T manifold", 1},
    {"work workspace", "/measure/unit", TEXT, "", "1", "unit of the value", 1},
    {"work", "/measure/form", I64, "", "1", "0 boundary form, 1 volume form", 1},
    {"work workspace", "/measure/orientation", D, "", "1", "sign sigma, frozen at the first design", 1},
    {"work", "/measure/value_other", D, "", "see /measure/unit", "measure by the other form, 0 if not computed", 1},
    {"work", "/measure/objective", D, "", "see /measure/unit", "what is optimised: the measure, less where a point gives way more than amplification_max or comes closer to itself than gap_min", 1},
    {"work", "/measure/amplification", D, "", "1", "largest |dU/dp| of a point over the geometric mean of all", 1},
    {"work", "/measure/closeness", D, "", "1", "closeness G summed over all points of the full set", 1},
    {"work", "/measure/quadrature_error", D, "", "1", "relative difference of the forms, -1 if not known", 1},
    {"work workspace", "/measure/min_det", D, "", "1", "smallest signed det J over the points", 1},
    {"work workspace", "/measure/max_det", D, "", "1", "largest signed det J over the points", 1},
    {"work workspace", "/measure/sign_changes", I64, "", "1", "points where det J changes sign", 1},
    {"work workspace", "/measure/branch_jumps", I64, "", "1", "neighbours with rotation vectors on different branches", 1},
    {"work", "/measure/max_rotation", D, "", "rad", "largest |rotation vector| over the points", 1},
    {"work", "/measure/max_tilt", D, "", "rad", "largest angle between pointing direction and +z over the points", 1},
    {"work", "/point/load", I64, "ng", "1", "index in the Gauss set", 1},
    {"work", "/point/pressure", D, "ng nc", "p/mu", "chamber pressures", 1},
    {"work", "/point/U", D, "ng 6", "mm, rad", "end-effector", 1},
    {"work", "/point/J", D, "ng 6 nc", "mm, rad", "dU/d(p/mu)", 1},
    {"work", "/point/w", D, "ng", "see /measure/unit", "contribution to the value", 1},
    {"work", "/point/dw_dU", D, "ng 6", "1", "derivative of the contribution", 1},
    {"work", "/point/dw_dJ", D, "ng 6 nc", "1", "derivative of the contribution", 1},
    {"work", "/point/intersections", I64, "ng", "1", "pairs of boundary faces that pierce each other", 1},
    {"work", "/point/gap", D, "ng", "mm", "least distance across air, 0 where faces pierce, -1 where wide", 1},
    {"work", "/point/closeness", D, "ng", "1", "closeness G of boundaries that face each other within gap_min", 1},
    {"work", "/point/dw_dG", D, "ng", "see /measure/unit", "derivative of the objective by it", 1},

    {"workspace", "/workspace/interval", D, "", "p/mu", "between samples", 1},
    {"workspace", "/workspace/value_polygon", D, "", "see /measure/unit", "measure of the polygon or polyhedron of the samples", 0},
    {"workspace", "/workspace/value_coarse", D, "", "see /measure/unit", "measure at twice the interval, from every other sample", 0},
    {"workspace", "/workspace/interior", I64, "", "1", "2R: turns of the path about the direction at the centre of the box, else 0", 1},
    {"workspace", "/workspace/intersections", I64, "", "1", "samples where the body penetrates itself", 1},
    {"workspace", "/workspace/tilt", D, "3", "rad", "largest, median and smallest angle of pointing over the samples", 1},
    {"workspace", "/workspace/rotation", D, "3", "rad", "largest |U4|, |U5|, |U6| over the samples", 1},
    {"workspace", "/workspace/twist", D, "", "rad", "largest turn about the axis of the end-effector", 1},
    {"workspace", "/workspace/x", D, "nn 3", "mm, rad, 1", "2T, 3T: position; 2R: direction; others: the dofs", 1},
    {"workspace", "/workspace/U", D, "nn 6", "mm, rad", "end-effector", 1},
    {"workspace", "/workspace/angle", D, "nn", "rad", "angle between pointing direction and +z", 1},
    {"workspace", "/workspace/pressure", D, "nn nc", "p/mu", "chamber pressures", 1},
    {"workspace", "/workspace/cell", I32, "ne npe", "1", "samples of the segments or outward triangles", 1},

    {"sens", "/gradient/shape_form", I64, "", "1", "0 domain form, 1 boundary form of the shape derivative", 1},
    {"sens", "/gradient/phi", D, "N 3", "1", "derivative of the contribution by the control points", 0},
    {"sens", "/close/value", D, "nclose", "1", "closeness G of the regions where the state is close to itself", 0},
    {"sens", "/close/gradient", D, "nclose N 3", "1/mm", "its derivative by the control points", 0},
    {"sens", "/gradient/identity_translation", D, "", "1", "relative defect of the nodal gradient (domain form)", 0},
    {"sens", "/gradient/identity_scaling", D, "", "1", "relative defect of the nodal gradient (domain form)", 0},
    {"sens", "/gradient/identity_rotation", D, "", "1", "relative defect of the nodal gradient (domain form)", 0},
    {"sens", "/chamber/compliance", D, "nc nc", "mm3", "dV/d(p/mu) of the deformed chamber volumes", 0},
    {"sens", "/each/dU", D, "6 N 3", "1", "derivative of the pose by the control points", 0},
    {"sens", "/each/dJ", D, "6 nc N 3", "1", "derivative of dU/d(p/mu)", 0},
    {"sens", "/each/dV", D, "nc N 3", "mm2", "derivative of the deformed chamber volumes", 0},
    {"sens", "/each/dC", D, "nc nc N 3", "mm2", "derivative of the compliance dV/d(p/mu)", 0},
    {"sens", "/nodal/dU", D, "6 nn 3", "1", "derivative of the pose by the reference positions of the nodes, in mesh order", 0},
    {"sens", "/nodal/dJ", D, "6 nc nn 3", "1", "derivative of dU/d(p/mu)", 0},
    {"sens", "/nodal/dV", D, "nc nn 3", "mm2", "derivative of the deformed chamber volumes", 0},
    {"sens", "/nodal/dC", D, "nc nc nn 3", "mm2", "derivative of the compliance dV/d(p/mu)", 0},

    {"step", "/accepted/surface%d/type", I64, "", "1", "last accepted design: 0 B-spline tube, 1 sphere map", 1},
    {"step", "/accepted/surface%d/phi", D, "an%d 3", "mm", "control points", 1},
    {"step", "/accepted/surface%d/free", U8, "an%d 3", "1", "1 where the coordinate is a design variable", 1},
    {"step", "/accepted/surface%d/Phi", D, "an%d 3", "1", "reference control points on the parameter shape", 1},
    {"step", "/accepted/surface%d/d0", D, "an%d", "1", "support radii, chord metric (B-spline: 0)", 1},
    {"step", "/accepted/surface%d/nu", I64, "", "1", "B-spline: control points around (sphere map: 0)", 1},
    {"step", "/accepted/surface%d/nv", I64, "", "1", "B-spline: control points along (sphere map: 0)", 1},
    {"step", "/accepted/surface%d/spacing", D, "2", "mm", "as /surface%d/spacing", 1},
    {"step", "/accepted/surface%d/tri", I32, "ant%d 3", "1", "triangles of control points, outward", 1},
    {"step", "/accepted/symmetry/perm", I32, "nops aN", "1", "control point i goes to perm under each operation", 1},
    {"step", "/accepted/value", D, "", "see work", "measure of the accepted design", 1},
    {"step", "/accepted/gradient", D, "aN 3", "1", "derivative of the objective but for that by closeness, projected on symmetric free vectors", 1},
    {"step", "/close/weight", D, "nclose", "see work", "fall of the objective with the closeness G of each close region of the states of the accepted design", 0},
    {"step", "/close/value", D, "nclose", "1", "closeness G of these regions", 0},
    {"step", "/close/gradient", D, "nclose aN 3", "1/mm", "its derivative, projected on symmetric free vectors", 0},
    {"step", "/pair/step", D, "npair aN 3", "mm", "last steps between accepted designs of these control points, oldest first", 0},
    {"step", "/pair/gradient", D, "npair aN 3", "1", "change of the gradient over them", 0},
    {"step", "/accepted/penalty", D, "2", "1", "curvature and wall penalties without weights", 1},
    {"step", "/accepted/worst", D, "2", "1", "largest relative violation of curvature and wall", 1},
    {"step", "/step/verdict", TEXT, "", "1", "continue, converged or stalled", 1},
    {"step", "/step/weight", D, "2", "see work", "weights of the curvature and wall penalties", 1},
    {"step", "/step/renew", I64, "", "1", "1: the proposal is the accepted design, to be reconstructed and meshed anew", 1},
    {"step", "/step/radius", D, "", "mm", "trust radius of the proposal", 1},
    {"step", "/step/gain", D, "", "see work", "predicted gain of the measure", 1},
    {"step", "/step/penalty", D, "2", "1", "curvature and wall penalties of the proposal", 1},
    {"step", "/step/worst", D, "2", "1", "largest relative violations of the proposal", 1},
    {"step", "/step/rms_step", D, "", "mm", "rms surface displacement of the proposal", 1},
    {"step", "/step/max_step", D, "", "mm", "largest control point displacement of the proposal", 1},
    {"step", "/trial/iteration", I64, "nh", "1", "history of judged trials, 0 is the first design", 1},
    {"step", "/trial/accepted", I64, "nh", "1", "1 accepted, 0 rejected", 1},
    {"step", "/trial/renewed", I64, "nh", "1", "1: the accepted design on a new mesh, 2: and with new control points; 0: a trial", 1},
    {"step", "/trial/jump", D, "nh", "1", "relative change of the objective by the new mesh, 0 for a trial", 1},
    {"step", "/trial/measure", D, "nh", "see work", "measure, 0 where the design failed", 1},
    {"step", "/trial/amplification", D, "nh", "1", "largest |dU/dp| of a point over the geometric mean of all", 1},
    {"step", "/trial/gap", D, "nh", "mm", "least distance across air of all states, 0 where one pierces itself, -1 where wide", 1},
    {"step", "/trial/merit", D, "nh", "see work", "objective minus penalties", 1},
    {"step", "/trial/predicted", D, "nh", "see work", "predicted gain of merit", 1},
    {"step", "/trial/ratio", D, "nh", "1", "actual over predicted gain", 1},
    {"step", "/trial/radius", D, "nh", "mm", "trust radius", 1},
    {"step", "/trial/worst_curvature", D, "nh", "1", "largest relative excess of curvature", 1},
    {"step", "/trial/worst_wall", D, "nh", "1", "largest relative lack of wall thickness", 1},
    {"step", "/trial/rms_step", D, "nh", "mm", "rms surface displacement", 1},
    {"step", "/trial/reason", TEXT, "", "1", "reasons of rejections, one line per trial", 1},
};
/* clang-format on */

const struct pm_item *pm_schema_items(ptrdiff_t *n)
{
    *n = (ptrdiff_t)(sizeof table / sizeof table[0]);
    return table;
}

int pm_schema_word_in(const char *word, const char *list)
{
    size_t length = strlen(word);
    for (const char *p = list; *p != '\0'; p += strcspn(p, " ")) {
        p += strspn(p, " ");
        if (length > 0 && strcspn(p, " ") == length && strncmp(p, word, length) == 0)
            return 1;
    }
    return 0;
}

/* Matches a path against a name with at most one %d. */
static int matches(const char *pattern, const char *name, int *index)
{
    *index = 0;
    const char *hole = strstr(pattern, "%d");
    if (hole == NULL)
        return strcmp(pattern, name) == 0;
    size_t head = (size_t)(hole - pattern);
    if (strncmp(pattern, name, head) != 0)
        return 0;
    size_t digits = strspn(name + head, "0123456789");
    if (digits == 0 || digits > 6 || strcmp(hole + 2, name + head + digits) != 0)
        return 0;
    *index = (int)strtol(name + head, NULL, 10);
    return 1;
}

const struct pm_item *pm_schema_find(const char *kind, const char *name, int *index)
{
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        if (pm_schema_word_in(kind, table[i].kinds) && matches(table[i].name, name, index))
            return &table[i];
    return NULL;
}

int pm_schema_sizes(const struct pm_item *item, int index, int max, struct pm_size *size)
{
    int rank = 0;
    for (const char *p = item->shape; *p != '\0' && rank < max; p += strspn(p, " ")) {
        size_t length = strcspn(p, " ");
        size_t symbol = strcspn(p, " +");
        struct pm_size *s = &size[rank++];
        *s = (struct pm_size){.add = 0};
        if (strspn(p, "0123456789") == length) {
            s->add = strtol(p, NULL, 10);
        } else if (symbol > 2 && strncmp(p + symbol - 2, "%d", 2) == 0) {
            snprintf(s->symbol, sizeof s->symbol, "%.*s%d", (int)symbol - 2, p, index);
        } else {
            snprintf(s->symbol, sizeof s->symbol, "%.*s", (int)symbol, p);
        }
        if (p[symbol] == '+')
            s->add = strtol(p + symbol + 1, NULL, 10);
        p += length;
    }
    return rank;
}

int pm_schema_agree(struct pm_symbols *symbols, const struct pm_size *size, ptrdiff_t found,
                    ptrdiff_t *expected)
{
    *expected = size->add;
    if (size->symbol[0] == '\0')
        return found == *expected;
    for (int i = 0; i < symbols->n; i++) {
        if (strcmp(symbols->symbol[i].name, size->symbol) == 0) {
            *expected += symbols->symbol[i].value;
            return found == *expected;
        }
    }
    if (found < size->add || symbols->n == PM_MAX_SYMBOLS)
        return 0;
    memcpy(symbols->symbol[symbols->n].name, size->symbol, sizeof size->symbol);
    symbols->symbol[symbols->n++].value = found - size->add;
    return 1;
}

const char *pm_schema_type_name(enum pm_type type)
{
    static const char *const names[] = {"double", "int32", "int64", "uint8", "text"};
    return names[type];
}
