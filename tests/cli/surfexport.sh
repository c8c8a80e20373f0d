#!/bin/bash
# surfexport: every product and format of a small robot, judged by ADMesh and gmsh; equal bytes; what it refuses.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh
. tests/admesh.sh

out=$work/output
export=$BIN/surfexport
check "surfaces" "$BIN/surfgen" -q tests/data/tiny.ini -o "$work/s.h5"

volume() {
    admesh "$1" | sed -n 's/.*Volume *: *//p'
}
for part in body:3 exterior:1 chambers:2 chamber1:1 chamber2:1 mould1:1 mould2:1 core1:1 core2:1 plate:1; do
    name=${part%:*}
    check "$name" "$export" -q --what "$name" "$work/s.h5" -o "$work/$name.stl"
    check "$name: closed and oriented, ${part#*:} part(s)" sound "$work/$name.stl" "${part#*:}"
done
check "the body is the exterior without the chambers" awk -v a="$(volume "$work/body.stl")" \
    -v b="$(volume "$work/exterior.stl")" -v c="$(volume "$work/chambers.stl")" \
    'BEGIN { exit !(a > 0 && c > 0 && (a - b + c)^2 < (1e-5 * b)^2) }' # single precision
check "the print adds to the chamber" awk -v a="$(volume "$work/chamber1.stl")" -v b="$(volume "$work/core1.stl")" \
    'BEGIN { exit !(b > a + 3.14 * 4 * 8) }' # at least what is beyond the base
check "moulds across x" "$export" -q --pull x --what mould1 "$work/s.h5" -o "$work/x.stl"
check "moulds across x: closed" sound "$work/x.stl" 1
check "core without a print" "$export" -q --print-diameter 0 --what core1 "$work/s.h5" -o "$work/bare.stl"
check "is the chamber" cmp <(tail -c +81 "$work/bare.stl") <(tail -c +81 "$work/chamber1.stl")

# ---- formats ----
expect 0 "text" "$export" -v --ascii "$work/s.h5" -o "$work/text.stl"
check "-v says walls" grep -q '^surfexport: wall: least 2\.[0-9]* mm at (' "$work/err"
check "-v says the product" grep -q '^surfexport: body: [0-9]* nodes, [0-9]* triangles, area .* volume ' "$work/err"
check "text: closed and oriented" sound "$work/text.stl" 3
check "text and binary have the same triangles" test \
    "$(grep -c '^facet normal' "$work/text.stl")" -eq "$((($(stat -c %s "$work/body.stl") - 84) / 50))"
mkdir "$work/again"
check "once more" "$export" -q "$work/s.h5" -o "$work/again/body.stl"
check "equal bytes" cmp "$work/body.stl" "$work/again/body.stl"
check "OBJ" "$export" -q "$work/s.h5" -o "$work/body.obj"
check "OBJ: groups" test "$(sed -n 's/^g //p' "$work/body.obj" | tr '\n' ' ')" = "exterior base tip chamber1 chamber2 "
check "VTKHDF" "$export" -q "$work/s.h5" -o "$work/body.vtkhdf"
h5ls -r "$work/body.vtkhdf" >"$work/ls"
check "VTKHDF: wall" grep -q '^/VTKHDF/PointData/wall *Soft Link {/skin/wall}' "$work/ls"
check "VTKHDF: curvature" grep -q '^/VTKHDF/PointData/curvature *Soft Link' "$work/ls"
check "VTKHDF: tag" grep -q '^/VTKHDF/CellData/tag *Soft Link {/skin/tag}' "$work/ls"
check "VTKHDF: triangles" sh -c "h5dump -d /VTKHDF/Types -s 0 -c 1 '$work/body.vtkhdf' | grep -q '(0): 5\$'"
check "VTKHDF of a mould" "$export" -q --what mould1 "$work/s.h5" -o "$work/mould.h5"
check "has no wall" sh -c "! h5ls -r '$work/mould.h5' | grep -q /skin/wall"

# An optimised design bends more between its control points than at them.
expect 0 "an optimised design" "$export" -vv data/designs/2A0R2T.h5 -o "$work/folds.stl"
check "triangles are split where its folds ask for it" grep -q '^surfexport: surface 1: [0-9]* triangles and [1-9][0-9]* by splits, 0.0[0-9]* mm off' "$work/err"
check "closed and oriented" sound "$work/folds.stl" 3

# gmsh fills the body, tetmesh takes it back with its groups.
check "gmsh file" "$export" -q --size 8 --tolerance 0.5 "$work/s.h5" -o "$work/skin.msh"
check "gmsh meshes it" fill_body "$work/skin.msh" "$work/body.msh"
expect 0 "tetmesh takes it" "$BIN/tetmesh" -v --import "$work/body.msh" --mu 1 --promote -o "$work/mesh.h5"
check "with two chambers" grep -q '(0): 2$' <(h5dump -d /mesh/chambers "$work/mesh.h5")

# ---- refusals ----
refused 2 "part that is none" "option --what: found 'chamber3', expected body, .* from 1 to 2" \
    "$export" --what chamber3 "$work/s.h5" -o "$out/x.stl"
refused 2 "part with more behind it" "option --what: found 'mould12'" "$export" --what mould12 "$work/s.h5" -o "$out/x.stl"
refused 2 "suffix" "option -o: found '$out/x.ply', expected a name that ends in .stl" "$export" "$work/s.h5" -o "$out/x.ply"
refused 2 "no suffix" "option -o: found" "$export" "$work/s.h5" -o "$out/x"
refused 2 "text that is no STL" "option --ascii: expected an output that ends in .stl" \
    "$export" --ascii "$work/s.h5" -o "$out/x.obj"
refused 2 "pull" "option --pull: found 'z', expected x or y" "$export" --pull z "$work/s.h5" -o "$out/x.stl"
refused 2 "tolerance" "option --tolerance: found 0, expected a number > 0" \
    "$export" --tolerance 0 "$work/s.h5" -o "$out/x.stl"
refused 2 "clearance" "option --clearance: found 2, expected at most a fifth" \
    "$export" --clearance 2 "$work/s.h5" -o "$out/x.stl"
refused 2 "plate without prints" "needs prints, found --print-diameter 0" \
    "$export" --what plate --print-diameter 0 "$work/s.h5" -o "$out/x.stl"
refused 3 "too fine" "surface 0: edges of 0.001 mm need about" "$export" --size 0.001 "$work/s.h5" -o "$out/x.stl"
refused 3 "no accepted design" "of kind 'surface', expected 'step'" "$export" --accepted "$work/s.h5" -o "$out/x.stl"
refused 3 "print that is too large" "no section is as large as the print" \
    "$export" --what core1 --print-diameter 30 "$work/s.h5" -o "$out/x.stl"
for suffix in stl obj msh h5; do
    refused 1 "disk full, $suffix" "cannot write '$out/x.$suffix'" \
        bash -c "ulimit -f 8; exec '$export' '$work/s.h5' -o '$out/x.$suffix'"
    refused 1 "no folder, $suffix" "cannot write '$work/none/x.$suffix'" "$export" "$work/s.h5" -o "$work/none/x.$suffix"
done
finish
