#!/bin/bash
# tetmesh --import: formats and orders written by gmsh itself, what becomes of the groups, refusals.
# shellcheck disable=SC2016,SC2317 # awk and sed programs; functions that check calls
. tests/lib.sh

out=$work/output
sphere=$LIB/thick_sphere
import() {
    "$BIN/tetmesh" --import "$1" --mu 1 "${@:2}"
}
# number FILE DATASET: its values on one line
number() {
    h5dump -y -d "$2" "$1" | awk '/^ *}/ && on { exit } on { gsub(",", ""); $1 = $1; print } /DATA {/ { on = 1 }'
}

# All four formats of a block with a round chamber, whole and linear, half and quadratic.
check "gmsh writes a whole body of order 1" "$LIB/gmsh_body" 1 whole "$work/whole"
check "gmsh writes a half body of order 2" "$LIB/gmsh_body" 2 half "$work/half"
for body in whole half; do
    for format in 2.2 2.2b 4.1 4.1b; do
        expect 0 "$body: format $format" import "$work/$body-$format.msh" -o "$work/$body-$format.h5" -v
    done
    # ASCII files hold 16 digits
    for format in 2.2 4.1 4.1b; do
        check "$body: $format holds the mesh of 2.2b" \
            h5diff -p 1e-12 "$work/$body-2.2b.h5" "$work/$body-$format.h5" /mesh
    done
done
# shape FILE NAME WIDTH: the rows of the dataset have this width
shape() {
    h5dump -H -d "/mesh/$2" "$1" | grep -q "SIMPLE { ( [0-9]*, $3 )"
}
check "order 1 stays linear: tetrahedra" shape "$work/whole-2.2.h5" tet 4
check "and faces" shape "$work/whole-2.2.h5" tri 3
check "order 2 stays quadratic: tetrahedra" shape "$work/half-2.2.h5" tet 10
check "and faces" shape "$work/half-2.2.h5" tri 6
check "one chamber" test "$(number "$work/whole-2.2.h5" /mesh/chambers)" = 1
check "ParaView finds an unstructured grid" grep -q '"UnstructuredGrid"' <(h5dump -a /VTKHDF/Type "$work/whole-2.2.h5")
check "with a version" grep -q '(0): 1, 0' <(h5dump -a /VTKHDF/Version "$work/whole-2.2.h5")
check "its points" h5dump -H -d /VTKHDF/Points "$work/whole-2.2.h5"
check "linear cells" grep -q '(0): 10, 10' <(h5dump -d /VTKHDF/Types "$work/whole-2.2.h5")
check "or quadratic cells" grep -q '(0): 24, 24' <(h5dump -d /VTKHDF/Types "$work/half-2.2.h5")

# The tip is z = 12, x and y from -6 to 6.
near_centre() {
    number "$1" /tip/reference_point |
        awk 'function abs(v) { return v < 0 ? -v : v } { exit !(abs($1) + abs($2) + abs($3 - 12) < 1e-12) }'
}
check "reference point: centroid of the tip" near_centre "$work/whole-2.2b.h5"
check "of the whole body's tip where half is given" near_centre "$work/half-2.2b.h5"
expect 0 "--reference" import "$work/whole-2.2.msh" --reference 1,-2,3.5 -o "$work/ref.h5"
check "is taken" test "$(number "$work/ref.h5" /tip/reference_point)" = "1 -2 3.5"

expect 0 "--promote" import "$work/whole-2.2.msh" --promote -o "$work/promoted.h5"
check "gives 10 nodes" shape "$work/promoted.h5" tet 10
check "and faces of 6" shape "$work/promoted.h5" tri 6
refused 2 "--promote of order 2" "the tetrahedra of group 'body' have 10 nodes already" \
    import "$work/half-2.2.msh" --promote -o "$out/x.h5"
expect 0 "again" import "$work/whole-4.1b.msh" -o "$work/again.h5"
cp "$work/whole-4.1b.h5" "$work/first.h5"
expect 0 "the same output name" import "$work/whole-4.1b.msh" -o "$work/whole-4.1b.h5" -v
check "equal input, equal bytes" cmp "$work/whole-4.1b.h5" "$work/first.h5"

# What wants control points.
check "surfaces" "$BIN/surfgen" tests/data/tiny.ini -o "$work/s.h5"
refused 3 "an imported mesh to morph" "whole-2.2.h5': an imported mesh has no control points" \
    "$BIN/tetmesh" "$work/s.h5" --previous "$work/whole-2.2.h5" -o "$out/x.h5"
check "a state" "$LIB/sample" state "$work/linear.h5" linear
check "a work file" "$LIB/sample" work "$work/work.h5"
refused 3 "gradient by control points" "linear.h5': its mesh was imported and has no control points" \
    "$BIN/adjsens" "$work/linear.h5" "$work/work.h5" -o "$out/x.h5"
expect 0 "pmplot draws linear faces" "$BIN/pmplot" deformed "$work/linear.h5"
# four faces, of them one of a chamber: each four points, corners of the unit tetrahedron displaced
check "one facet each" test "$(grep -c '^[-0-9]' "$work/out")" -eq 16

# Refusals: files of the octant of a thick sphere, edited.
"$sphere" write 3 2 quadratic "$work/quadratic.msh"
"$sphere" write 3 2 linear "$work/linear.msh"
refuse() {
    refused 3 "$1" "cannot use '.*bad.msh': $2" import "$work/bad.msh" -o "$out/x.h5"
}
# damage NAME PATTERN SED [FILE]
damage() {
    sed -E "$3" "$work/${4:-linear}.msh" >"$work/bad.msh"
    refuse "$1" "$2"
}
# extend NODES ELEMENTS: the linear file with these lines more, separated by |
extend() {
    awk -v nodes="$1" -v elements="$2" '
        /^\$(End)?(Nodes|Elements)/ { n = split($0 ~ /Nodes/ ? nodes : elements, line, "|") }
        /^\$End(Nodes|Elements)/ { for (k = 1; k <= n; k++) print line[k] }
        { print }
        /^\$(Nodes|Elements)/ { getline; print $1 + n }
    ' "$work/linear.msh" >"$work/bad.msh"
}
damage "no body" "there is no physical group 'body'" 's/"body"/"solid"/'
damage "no base" "nothing holds the body: expected the group 'base'" 's/"symmetry-x"/"bottom"/'
damage "chambers out of order" "there is a group 'chamber2' but no 'chamber1'" 's/"chamber1"/"chamber2"/'
damage "too many chambers" "group 'chamber12': expected at most 8 chambers" 's/"chamber1"/"chamber12"/'
damage "face in no group" "the boundary face of nodes .* is in no group" '0,/ 2 2 2 2 /s/ 2 2 2 2 / 2 2 9 9 /'
damage "open chamber" "group 'chamber1' is not closed at the edge of nodes .* near" '0,/ 2 2 2 2 /s/ 2 2 2 2 / 2 2 3 3 /'
damage "chamber inside the body" "group 'chamber1': the triangle of nodes .* is not on the boundary" \
    '0,/ 2 2 2 2 /s/( 2 2 2 2) [0-9]+/\1 30/'
damage "base inside the body" "group 'base': the triangle of nodes .* is not on the boundary" \
    's/"symmetry-x"/"base"/; 0,/ 2 2 4 4 /s/( 2 2 4 4) [0-9]+/\1 30/'
damage "exterior inside the body" "group 'exterior': the triangle of nodes .* is not on the boundary" \
    '0,/ 2 2 3 3 /s/( 2 2 3 3) [0-9]+/\1 1/'
damage "one node off a symmetry plane" "group 'symmetry-x' is not planar: node [0-9]+ has x = " 's/^1 0 0 1$/1 0.01 0 1/'
damage "curved symmetry plane" "group 'symmetry-x' is not planar: node" \
    's/"symmetry-x"/"swap"/; s/"exterior"/"symmetry-x"/; s/"swap"/"exterior"/' quadratic
damage "not a number" "node 1 is at \(.*nan" 's/^1 0 0 1$/1 nan 0 1/'
damage "an infinite place" "node 1 is at \(0, inf, 1\)" 's/^1 0 0 1$/1 0 inf 1/'
damage "coinciding nodes" "nodes 1 and 2 coincide" '/Nodes/,/EndNodes/s/^2 .*/2 0 0 1/'
damage "inverted tetrahedron" "the tetrahedron of nodes .* is inverted" \
    '0,/ 4 2 1 1 /s/( 4 2 1 1) ([0-9]+) ([0-9]+)/\1 \3 \2/'
damage "inverted quadratic tetrahedron" "the tetrahedron of nodes .* is inverted" \
    '0,/ 11 2 1 1 /s/( 11 2 1 1) ([0-9]+) ([0-9]+)/\1 \3 \2/' quadratic
damage "tetrahedron without volume" "the tetrahedron of nodes .* is flat" \
    '0,/ 4 2 1 1 /s/( 4 2 1 1 [0-9]+ [0-9]+) ([0-9]+) [0-9]+/\1 \2 \2/'
damage "missing node" "it cannot be read: gmsh says" '0,/ 4 2 1 1 /s/( 4 2 1 1) [0-9]+/\1 99999/'
damage "not a mesh" "it does not begin with .MeshFormat" '1s/.*/Point(1) = {0, 0, 0};/'
damage "cut short" "it cannot be read|an element refers|there is no" '/EndNodes/,$d'
extend "31 5 0 0|32 6 0 0|33 5 1 0|34 5 0 1" "9999 4 2 1 1 31 32 33 34"
refuse "two parts" "the body is in parts: no faces join the tetrahedra at nodes [0-9]+ and 31"
extend "31 0.5 0.5 4|32 -0.5 0.5 4" "9999 4 2 1 1 21 22 32 31"
refuse "parts on a hinge" "the body is in parts: no faces join"
extend "" "9999 2 2 3 3 1 2 5"
refuse "a face in two groups" "group '.*': the triangle of nodes .* is in another group too"
extend "" "9999 $(awk '$2 == 4 && NF == 9 { $1 = ""; print; exit }' "$work/linear.msh")"
refuse "a tetrahedron twice" "the tetrahedra of nodes (.*) and \1 overlap"
awk '/^\$Nodes/ { print; getline; n = $1 + 1; print n; next }
    /^\$EndNodes/ { print n, x + 0.01, y + 0.01, z + 0.01 }
    $1 == 33 && NF == 4 { x = $2; y = $3; z = $4 } # in the first two tetrahedra
    $2 == 11 && $12 == 33 { $12 = n }
    { print }' "$work/quadratic.msh" >"$work/bad.msh"
refuse "an edge with two middles" "the edge of nodes [0-9]+ and [0-9]+ has two middle nodes"
refused 3 "no such file" "cannot use '.*none.msh': No such file" import "$work/none.msh" -o "$out/x.h5"
finish
