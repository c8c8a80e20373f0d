// A bellows tube between two plates, held at one end, with a rigid free end: a quarter of it, or with
// the chamber off the axis, so that it bends, a half. Lengths in mm.
//   gmsh -3 -setnumber size 1.25 bellows.geo -o bellows.msh
//   tetmesh --import bellows.msh --mu 1 --kappa 100 -o bellows.h5
//   fesolve --pressure 0.12 bellows.h5 -o state.h5
SetFactory("OpenCASCADE");
DefineConstant[
    size = 1.25     // longest edges
    crest = 1.2     // longest edges over the radius of curvature
    order = 2       // of the tetrahedra
    shift = 0       // of the chamber's axis along x; other than 0: a half model
    straight = 0    // 1: mid-side nodes in the middle of chords instead of on the surface
    wall = 2.5, radius = 10, depth = 2.5, pitch = 15, pitches = 2, plate = 2.5, fillet = 1.25];

// Middle of the wall: r = radius - depth cos(2 pi z / pitch); its faces are half a wall away along the normal.
n = 16 * pitches;
length = pitch * pitches;
neck = radius - depth;
For i In {0 : n}
    z = length * i / n;
    slope = depth * 2 * Pi / pitch * Sin(2 * Pi * z / pitch);
    r = radius - depth * Cos(2 * Pi * z / pitch);
    s = wall / 2 / Sqrt(1 + slope^2);
    Point(100 + i) = {r + s, 0, z - s * slope};
    Point(1000 + i) = {shift + r - s, 0, z + s * slope};
EndFor

// Meridian of the solid and of the chamber.
Point(1) = {0, 0, -fillet - plate};
Point(2) = {neck + wall / 2, 0, -fillet - plate};
Point(3) = {neck + wall / 2, 0, length + fillet + plate};
Point(4) = {0, 0, length + fillet + plate};
Line(1) = {1, 2};
Line(2) = {2, 100};
Spline(3) = {100 : 100 + n};
Line(4) = {100 + n, 3};
Line(5) = {3, 4};
Line(6) = {4, 1};
Curve Loop(1) = {1 : 6};
Plane Surface(1) = {1};
inner = shift + neck - wall / 2;
Point(11) = {shift, 0, -fillet};
Point(12) = {inner - fillet, 0, -fillet};
Point(13) = {inner - fillet, 0, 0};
Point(14) = {inner - fillet, 0, length};
Point(15) = {inner - fillet, 0, length + fillet};
Point(16) = {shift, 0, length + fillet};
Line(11) = {11, 12};
Circle(12) = {12, 13, 1000};
Spline(13) = {1000 : 1000 + n};
Circle(14) = {1000 + n, 14, 15};
Line(15) = {15, 16};
Line(16) = {16, 11};
Curve Loop(2) = {11 : 16};
Plane Surface(2) = {2};
angle = shift == 0 ? Pi / 2 : Pi;
solid[] = Extrude{ {0, 0, 1}, {0, 0, 0}, angle } { Surface{1}; };
chamber[] = Extrude{ {0, 0, 1}, {shift, 0, 0}, angle } { Surface{2}; };
BooleanDifference(100) = { Volume{solid[1]}; Delete; }{ Volume{chamber[1]}; Delete; };
Recursive Delete { Surface{1, 2}; }

// The groups that tetmesh knows, found by their place.
e = 1e-4;
R = 2 * (radius + depth + wall);
top = length + fillet + plate;
widest = Fabs(shift) + radius + depth - wall / 2;
Physical Volume("body") = {100};
Physical Surface("base") = Surface In BoundingBox{-R, -R, -fillet - plate - e, R, R, -fillet - plate + e};
Physical Surface("tip") = Surface In BoundingBox{-R, -R, top - e, R, R, top + e};
Physical Surface("chamber1") = Surface In BoundingBox{-widest - e, -e, -fillet - e, widest + e, widest + e, length + fillet + e};
Physical Surface("symmetry-y") = Surface In BoundingBox{-R, -e, -R, R, e, R + length};
If (shift == 0)
    Physical Surface("symmetry-x") = Surface In BoundingBox{-e, -R, -R, e, R, R + length};
EndIf

// Edges of at most `crest` radii of curvature; quadratic, with the mid-side nodes on the surface.
Mesh.MeshSizeMax = size;
Mesh.MeshSizeFromCurvature = 2 * Pi / crest;
Mesh.Algorithm3D = 10;
Mesh.Optimize = 1;
Mesh.ElementOrder = order;
Mesh.SecondOrderLinear = straight;
Mesh.HighOrderOptimize = straight ? 0 : 1; // mends curved tetrahedra that are inside out
Mesh.MshFileVersion = 4.1;
