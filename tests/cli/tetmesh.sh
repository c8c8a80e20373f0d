#!/bin/bash
# tetmesh: what a mesh promises, morphing, determinism, refusals of surfaces.
# shellcheck disable=SC2016,SC2317 # awk and sed programs; functions that check calls
. tests/lib.sh

out=$work/output
tetmesh=$BIN/tetmesh
check "a small robot" "$BIN/surfgen" tests/data/tiny.ini -o "$work/s.h5"

# Volumes of chambers: 6 % at three edges around a chamber (seen 5.2 %), 0.5 % at the finer mesh.
# meshes
expect 0 "mesh" "$tetmesh" "$work/s.h5" -o "$work/m.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/m.h5" "$work/s.h5" 0.06
expect 0 "finer mesh" "$tetmesh" "$work/s.h5" --size 3 -o "$work/fine.h5" -v
check "it keeps its promises" "$LIB/check_mesh" "$work/fine.h5" "$work/s.h5" 0.005
check "-v tells nodes, tetrahedra, unknowns" grep -Eq '[0-9]+ nodes, [0-9]+ tetrahedra, [0-9]+ unknowns' "$work/err"
expect 0 "finer crests" "$tetmesh" "$work/s.h5" --crest 0.8 -o "$work/crest.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/crest.h5" "$work/s.h5" 0.06
check "more tetrahedra" test "$(h5dump -H -d /mesh/tet "$work/crest.h5" | sed -n 's/.*SIMPLE { ( \([0-9]*\),.*/\1/p')" -gt \
    "$(h5dump -H -d /mesh/tet "$work/m.h5" | sed -n 's/.*SIMPLE { ( \([0-9]*\),.*/\1/p')"
refused 2 "no crest" "option --crest: found 0, expected a number > 0" "$tetmesh" "$work/s.h5" --crest 0 -o "$out/x.h5"
cp "$work/m.h5" "$work/first.h5"
expect 0 "again" "$tetmesh" "$work/s.h5" -o "$work/m.h5"
check "equal input, equal bytes" cmp "$work/m.h5" "$work/first.h5"

# morphing
expect 0 "morph" "$tetmesh" "$work/s.h5" --previous "$work/m.h5" -o "$work/p.h5" -v
check "says so" grep -q "previous mesh morphed" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/s.h5" 0.06
sed 's/radius = 6/radius = 6.1/' tests/data/tiny.ini >"$work/t.ini"
check "larger chambers" "$BIN/surfgen" "$work/t.ini" -o "$work/t.h5"
expect 0 "larger chambers, previous mesh" "$tetmesh" "$work/t.h5" --previous "$work/m.h5" -o "$work/p.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/t.h5" 0.1
"$LIB/random_shape" 3 2.3 "$work/s.h5" "$work/r.h5" >"$work/seen"
expect 0 "a motion too large for the record" "$tetmesh" "$work/r.h5" --previous "$work/fine.h5" --keep-mesh -o "$work/p.h5" -v
check "goes on from the present state" grep -q "morphed from its present state.*, 0 mid-side nodes damped" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/r.h5" 0.06
expect 0 "that is its record" "$tetmesh" "$work/r.h5" --previous "$work/p.h5" --keep-mesh -o "$work/q.h5" -v
check "nothing moves" "$LIB/check_mesh" "$work/q.h5" "$work/r.h5" 0.06
check "and nothing else is tried" test "$(grep -c morphed "$work/err")" -eq 1
check "an element as flat as curving may leave them" "$LIB/flat_element" "$work/m.h5" "$work/flat.h5"
expect 0 "such a mesh is not born worn" "$tetmesh" "$work/s.h5" --previous "$work/flat.h5" --keep-mesh -o "$work/p.h5" -v
check "it follows as generated" grep -q "previous mesh morphed: .*, mean ratio 0.0[67]" "$work/err"
refused 4 "edges too long for what is wanted" "worn mesh: .* of its surfaces edges are above 1.5 times" \
    "$tetmesh" "$work/s.h5" --size 3 --previous "$work/m.h5" --keep-mesh -o "$out/x.h5"
sed 's/rows = 14/rows = 16/' tests/data/tiny.ini >"$work/u.ini"
check "another exterior" "$BIN/surfgen" "$work/u.ini" -o "$work/u.h5"
expect 0 "other control points" "$tetmesh" "$work/u.h5" --previous "$work/m.h5" --keep-mesh -o "$work/p.h5" -v
check "says so" grep -Eq "other control points: nodes up to 0\.[0-9]+ mm off, 0 mid-side nodes damped" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/u.h5" 0.06
check "the elements are the same" cmp <(h5dump -d /mesh/tet "$work/m.h5" | tail -n +2) <(h5dump -d /mesh/tet "$work/p.h5" | tail -n +2)
sed 's/radius = 6/radius = 4/' "$work/u.ini" >"$work/v.ini"
check "another form" "$BIN/surfgen" "$work/v.ini" -o "$work/v.h5"
expect 0 "control points far off" "$tetmesh" "$work/v.h5" --previous "$work/m.h5" -o "$work/p.h5"
check "says so" grep -Eq "another parametrisation and lies up to [0-9.]+ mm off, expected [0-9.]+: meshing anew" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/v.h5" 0.06

# surfaces that cannot be meshed: without symmetry, one chamber moves
{ sed 's/^group = .*/group = none/' tests/data/tiny.ini; sed -n '/chamber1/,/^$/p' tests/data/tiny.ini | sed 's/chamber1/chamber2/; s/= 9, 0/= -9, 0/'; } >"$work/two.ini"
check "without symmetry" "$BIN/surfgen" "$work/two.ini" -o "$work/two.h5"
"$LIB/bad_surface" outside "$work/two.h5" "$work/outside.h5"
"$LIB/bad_surface" pierce "$work/two.h5" "$work/pierce.h5"
"$LIB/bad_surface" overlap "$work/two.h5" "$work/overlap.h5"
"$LIB/bad_surface" nested "$work/two.h5" "$work/nested.h5"
"$LIB/bad_surface" turned "$work/two.h5" "$work/turned.h5"
refused 3 "chamber outside the body" "chamber 1 is outside the body, at \(" "$tetmesh" "$work/outside.h5" -o "$out/x.h5"
refused 3 "chamber through the wall" "chamber 1 is partly outside the body: it cuts exterior at \(" \
    "$tetmesh" "$work/pierce.h5" -o "$out/x.h5"
refused 3 "chambers that overlap" "chamber 2 cuts chamber 1 at \(" "$tetmesh" "$work/overlap.h5" -o "$out/x.h5"
# what flat faces of 8 mm would not show, or show where it is not
for kind in graze near thin pinched; do "$LIB/bad_surface" $kind "$work/two.h5" "$work/$kind.h5"; done
refused 3 "chambers that graze" "chamber 2 cuts chamber 1 at \(-2.2" "$tetmesh" "$work/graze.h5" -o "$out/x.h5"
refused 3 "chambers that nearly touch" "chamber [12] comes within 0.0[0-9]* mm of chamber [12] at \(-2.1.*expected 0.0167 mm or more" \
    "$tetmesh" "$work/near.h5" -o "$out/x.h5"
expect 0 "a wall of a tenth of a millimetre" "$tetmesh" "$work/thin.h5" -o "$work/thin-mesh.h5" -v
check "says that edges are shorter" grep -q "comes within.*: shorter edges there" "$work/err"
check "it keeps its promises" "$LIB/check_mesh" "$work/thin-mesh.h5" "$work/thin.h5" 0.06
# at the rims of its grooves edges as long as 1.8 radii meet base and tip
sed 's/^size = .*/size = 6\ncrest = 1.8/' data/cases/3A0R3T.ini >"$work/groove.ini"
"$BIN/surfgen" -q "$work/groove.ini" -o "$work/groove.h5"
expect 0 "a groove that coarse crests do not resolve" "$tetmesh" "$work/groove.h5" -o "$work/groove-mesh.h5" -v
check "says that crests are finer" grep -q "edges of 1.44 times the radii of crests" "$work/err"
refused 3 "a chamber that cuts itself" "chamber 1 cuts itself at \(" "$tetmesh" --size 12 "$work/pinched.h5" -o "$out/x.h5"
refused 3 "chamber in a chamber" "chamber 2 is inside chamber 1, at \(" "$tetmesh" "$work/nested.h5" -o "$out/x.h5"
"$LIB/bad_surface" pierce "$work/s.h5" "$work/alone.h5"
refused 3 "chamber without its image" "control points are up to 6 mm off their images" "$tetmesh" "$work/alone.h5" -o "$out/x.h5"
"$LIB/bad_surface" both "$work/s.h5" "$work/both.h5"
refused 3 "chamber that meets its image" "chamber 1 meets its image at the mirror plane x = 0: it is at \(" "$tetmesh" "$work/both.h5" -o "$out/x.h5"
refused 3 "surface inside out" "surface 1: .*folded in the parameter" "$tetmesh" "$work/turned.h5" -o "$out/x.h5"
refused 3 "size far too small" "surface 0: edges of 0.001 mm need about" "$tetmesh" "$work/s.h5" --size 0.001 -o "$out/x.h5"
refused 4 "a mesher that does not end" "did not end within 1e-05 s" "$tetmesh" "$work/s.h5" --timeout 1e-5 -o "$out/x.h5"
expect 0 "recorded failure" "$tetmesh" "$work/outside.h5" --record-failure -o "$work/f.h5"
refused 3 "a reader refuses it" "records a failure: tetmesh: chamber 1 is outside the body" \
    "$BIN/fesolve" "$work/f.h5" --load 0 -o "$out/x.h5"
expect 0 "mesh after a recorded failure" "$tetmesh" "$work/s.h5" --previous "$work/f.h5" -o "$work/p.h5"
check "it keeps its promises" "$LIB/check_mesh" "$work/p.h5" "$work/s.h5" 0.06
refused 3 "a broken file is not recorded" "cannot open|cannot use" \
    "$tetmesh" "$work/none.h5" --record-failure -o "$out/x.h5"

# options
refused 2 "size 0" "option --size: found 0" "$tetmesh" "$work/s.h5" --size 0 -o "$out/x.h5"
refused 2 "no such symmetry" "option --symmetry: found 'some', expected auto or none" "$tetmesh" "$work/s.h5" --symmetry some -o "$out/x.h5"
refused 2 "surfaces and an import" "either SURF.h5 or --import" "$tetmesh" "$work/s.h5" --import a.msh -o "$out/x.h5"
refused 2 "material without an import" "need --import" "$tetmesh" "$work/s.h5" --mu 1 -o "$out/x.h5"
refused 2 "size of an import" "do not go with --import" "$tetmesh" --import a.msh --mu 1 --size 2 -o "$out/x.h5"
refused 2 "half a reference" "option --reference: found '1,2', expected X,Y,Z" \
    "$tetmesh" --import a.msh --mu 1 --reference 1,2 -o "$out/x.h5"

finish
