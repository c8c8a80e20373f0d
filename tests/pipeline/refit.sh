#!/bin/bash
# make refit on a small robot that gmsh has meshed: the fitted one has its pose; what is refused.
. tests/lib.sh

refit() {
    make -s B="$BUILD" DEPS=no refit MSH="$1" MU="$2" KAPPA=25 PRESSURE="$3" REFIT_SPACING=3 REFIT_RUN="$work/run"
}
check "surfaces" "$BIN/surfgen" -q tests/data/tiny.ini -o "$work/s.h5"
check "triangles" "$BIN/surfexport" -q --size 5 --tolerance 0.5 "$work/s.h5" -o "$work/skin.msh"
check "gmsh fills the body" fill_body "$work/skin.msh" "$work/body.msh"
gzip "$work/body.msh"
expect 0 "runs" refit "$work/body.msh.gz" 0.5 0.03,0
sed 's/^/# /' "$work/out"
# Surfaces within a tenth of the spacing; volumes of the chambers within 0.5 %, the pose within 4 %: measured 0.02, 0.2
# and 2 % with two elements through a wall, and 1.5 % on the given mesh, moved.
check "fits" awk -F '|' '/^. (body|chamber)/ { n++; bad += !($4 > 0 && $4 < 0.3) } END { exit n != 3 || bad }' "$work/out"
check "volumes" awk -F '|' '$2 ~ /^ (given|fitted) $/ { split($6, v, ","); if (!n++) { a = v[1]; b = v[2] } else bad += (v[1] / a - 1) ^ 2 + (v[2] / b - 1) ^ 2 > 0.005 ^ 2 }
    END { exit n != 2 || bad }' "$work/out"
check "poses" awk -F '[(%]' '/^fitted against/ { n++; bad += !($2 < 4 && $4 < 4) } END { exit n != 1 || bad }' "$work/out"
check "pose of the moved mesh" awk -F '[(%]' '/^given, moved .* against/ { n++; bad += !($2 > 0.1 && $2 < 2 && $4 < 2) } END { exit n != 1 || bad }' "$work/out"

REFIT_SIZE=0.02 expect 2 "surfaces that cannot be meshed" refit "$work/body.msh.gz" 0.5 0.03,0
check "says why" grep -q 'no mesh of the fitted surfaces: tetmesh: surface 0: edges of 0.02 mm need' "$work/err"
check "the other rows stand" test "$(grep -c '^| given' "$work/out")" -eq 2

expect 2 "no mesh" refit "$work/none.msh" 0.5 0.03
check "says so" grep -q "cannot read '.*none.msh', expected MSH=FILE.msh" "$work/err"
expect 2 "no pressure" refit "$work/body.msh.gz" 0.5 ''
check "says so" grep -q 'expected MU=MPA and PRESSURE=MPA' "$work/err"
expect 2 "pressures" refit "$work/body.msh.gz" 0.5 0.01,0.02,0.03
check "says so" grep -q 'found 3 pressures, expected 1 or 2' "$work/err"
"$LIB/gmsh_body" 1 half "$work/half"
expect 2 "a half" refit "$work/half-2.2.msh" 0.5 0.03
check "says so" grep -q 'found a symmetry plane, expected a whole body' "$work/err"
finish
