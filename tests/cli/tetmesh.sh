#!/bin/bash
# tetmesh: what a mesh promises, morphing, determinism, refusals of surfaces and of gmsh files.
# shellcheck disable=SC2016,SC2317 # awk and sed programs; functions that check calls
. tests/lib.sh

out=$work/output
tetmesh=$BIN/tetmesh
sphere=$LIB/thick_sphere
check "a small robot" "$BIN/surfgen" tests/data/tiny.ini -o "$work/s.h5"

# Volumes of chambers: 3 % at three edges around a chamber (seen 1.8 %), 0.5 % at the finer mesh.
# meshes
expect 0 "mesh" "$tetmesh" "$work/s.h5" -o "$work/m.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/m.h5" "$work/s.h5" 0.03
expect 0 "finer mesh" "$tetmesh" "$work/s.h5" --size 4 -o "$work/fine.h5" -v
check "it keeps its promises" "$LIB/check_mesh" "$work/fine.h5" "$work/s.h5" 0.005
check "-v tells nodes, tetrahedra, unknowns" grep -Eq '[0-9]+ nodes, [0-9]+ tetrahedra, [0-9]+ unknowns' "$work/err"
cp "$work/m.h5" "$work/first.h5"
expect 0 "again" "$tetmesh" "$work/s.h5" -o "$work/m.h5"
check "equal input, equal bytes" cmp "$work/m.h5" "$work/first.h5"

# morphing
expect 0 "morph" "$tetmesh" "$work/s.h5" --previous "$work/m.h5" -o "$work/p.h5" -v
check "says so" grep -q "previous mesh morphed" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/s.h5" 0.03
sed 's/radius = 6/radius = 6.1/' tests/data/tiny.ini >"$work/t.ini"
check "larger chambers" "$BIN/surfgen" "$work/t.ini" -o "$work/t.h5"
expect 0 "larger chambers, previous mesh" "$tetmesh" "$work/t.h5" --previous "$work/m.h5" -o "$work/p.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/t.h5" 0.03
sed 's/rows = 14/rows = 16/' tests/data/tiny.ini >"$work/u.ini"
check "another exterior" "$BIN/surfgen" "$work/u.ini" -o "$work/u.h5"
expect 0 "another parametrisation" "$tetmesh" "$work/u.h5" --previous "$work/m.h5" -o "$work/p.h5"
check "says so" grep -q "another parametrisation: meshing anew" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/u.h5" 0.03

# surfaces that cannot be meshed
"$LIB/bad_surface" outside "$work/s.h5" "$work/outside.h5"
"$LIB/bad_surface" pierce "$work/s.h5" "$work/pierce.h5"
"$LIB/bad_surface" overlap "$work/s.h5" "$work/overlap.h5"
"$LIB/bad_surface" nested "$work/s.h5" "$work/nested.h5"
"$LIB/bad_surface" turned "$work/s.h5" "$work/turned.h5"
refused 3 "chamber outside the body" "chamber 1 is outside the body, at \(" "$tetmesh" "$work/outside.h5" -o "$out/x.h5"
refused 3 "chamber through the wall" "chamber 1 is partly outside the body: it cuts exterior at \(" \
    "$tetmesh" "$work/pierce.h5" -o "$out/x.h5"
refused 3 "chambers that overlap" "chamber 2 cuts chamber 1 at \(" "$tetmesh" "$work/overlap.h5" -o "$out/x.h5"
refused 3 "chamber in a chamber" "chamber 2 is inside chamber 1, at \(" "$tetmesh" "$work/nested.h5" -o "$out/x.h5"
refused 3 "surface inside out" "surface 1: .*folded in the parameter" "$tetmesh" "$work/turned.h5" -o "$out/x.h5"
refused 3 "size far too small" "surface 0: edges of 0.001 mm need about" "$tetmesh" "$work/s.h5" --size 0.001 -o "$out/x.h5"
refused 4 "a mesher that does not end" "did not end within 1e-05 s" "$tetmesh" "$work/s.h5" --timeout 1e-5 -o "$out/x.h5"
expect 0 "recorded failure" "$tetmesh" "$work/outside.h5" --record-failure -o "$work/f.h5"
refused 3 "a reader refuses it" "records a failure: tetmesh: chamber 1 is outside the body" \
    "$BIN/fesolve" "$work/f.h5" --load 0 -o "$out/x.h5"
expect 0 "mesh after a recorded failure" "$tetmesh" "$work/s.h5" --previous "$work/f.h5" -o "$work/p.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/s.h5" 0.03
refused 3 "a broken file is not recorded" "cannot open|cannot use" \
    "$tetmesh" "$work/none.h5" --record-failure -o "$out/x.h5"

# options
refused 2 "size 0" "option --size: found 0" "$tetmesh" "$work/s.h5" --size 0 -o "$out/x.h5"
refused 2 "surfaces and an import" "either SURF.h5 or --import" "$tetmesh" "$work/s.h5" --import a.msh -o "$out/x.h5"
refused 2 "material without an import" "need --import" "$tetmesh" "$work/s.h5" --mu 1 -o "$out/x.h5"
refused 2 "import without a material" "either --mu or --case" "$tetmesh" --import a.msh -o "$out/x.h5"
refused 2 "law with a case" "do not go with --case" "$tetmesh" --import a.msh --case a.ini --law yeoh -o "$out/x.h5"
refused 2 "size of an import" "do not go with --import" "$tetmesh" --import a.msh --mu 1 --size 2 -o "$out/x.h5"
refused 2 "half a reference" "option --reference: found '1,2', expected X,Y,Z" \
    "$tetmesh" --import a.msh --mu 1 --reference 1,2 -o "$out/x.h5"

# gmsh files
import() {
    "$tetmesh" --import "$1" --mu 1 "${@:2}"
}
for format in 2.2 2.2b 4.1; do
    "$sphere" write 3 2 $format "$work/$format.msh"
    expect 0 "format $format" import "$work/$format.msh" -o "$work/$format.h5" -v
    cp "$work/err" "$work/said-$format"
done
check "2.2: the mesh of so many parts" grep -q "140 nodes, 54 tetrahedra" "$work/said-2.2"
check "binary 2.2: the same mesh" cmp "$work/said-2.2" "$work/said-2.2b"
check "4.1: the same mesh" cmp "$work/said-2.2" "$work/said-4.1"
"$sphere" write 3 2 linear "$work/linear.msh"
expect 0 "linear tetrahedra" import "$work/linear.msh" -o "$work/linear.h5" -v
check "stay linear" grep -q "30 nodes, 54 tetrahedra" "$work/err"
expect 0 "linear tetrahedra, promoted" import "$work/linear.msh" --promote -o "$work/linear.h5" -v
check "have middle nodes" grep -q "140 nodes, 54 tetrahedra" "$work/err"
refused 2 "quadratic tetrahedra, promoted" "have 10 nodes already, expected 4" \
    import "$work/2.2.msh" --promote -o "$out/x.h5"

# damage NAME PATTERN SED: the file 2.2 edited.
damage() {
    sed -E "$3" "$work/2.2.msh" >"$work/bad.msh"
    refused 3 "$1" "cannot use '.*bad.msh': $2" import "$work/bad.msh" -o "$out/x.h5"
}
damage "no body" "there is no physical group 'body'" 's/"body"/"solid"/'
damage "nothing holds it" "nothing holds the body" 's/"symmetry-x"/"chamber2"/'
damage "open chamber" "group 'chamber1' is not closed at the edge" 's/^1 9 2 2 2 /1 9 2 3 3 /'
damage "chambers out of order" "there is a group 'chamber2' but no 'chamber1'" 's/"chamber1"/"chamber2"/'
damage "face in no group" "the boundary face of nodes .* is in no group" 's/^1 9 2 2 2 /1 9 2 9 9 /'
damage "group inside the body" "group 'exterior': the triangle of nodes .* is not on the boundary" \
    '0,/^[0-9]+ 9 2 3 3 /s/^([0-9]+ 9 2 3 3) [0-9]+/\1 1/'
damage "curved symmetry plane" "group 'symmetry-x' is not planar: node" \
    's/"symmetry-x"/"swap"/; s/"exterior"/"symmetry-x"/; s/"swap"/"exterior"/'
damage "not a number" "node 1 is at \(.*nan" '0,/^1 0 0 1$/s/^1 0 0 1$/1 nan 0 1/'
damage "coinciding nodes" "nodes 1 and 2 coincide" '/Nodes/,/EndNodes/s/^2 .*/2 0 0 1/'
damage "inverted tetrahedron" "the tetrahedron of nodes .* is inverted" \
    '0,/ 11 2 1 1 /s/( 11 2 1 1) ([0-9]+) ([0-9]+)/\1 \3 \2/'
damage "missing node" "it cannot be read: gmsh says" '0,/ 11 2 1 1 /s/( 11 2 1 1) [0-9]+/\1 99999/'
damage "not a mesh" "it does not begin with .MeshFormat" '1s/.*/Point(1) = {0, 0, 0};/'
damage "cut short" "it cannot be read|an element refers|there is no" '/EndNodes/,$d'
refused 3 "no such file" "cannot use '.*none.msh': No such file" import "$work/none.msh" -o "$out/x.h5"
finish
