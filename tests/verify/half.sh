#!/bin/bash
# Models that end at a mirror plane against whole bodies, from surfaces: the whole mesh is the half with its image, so that
# pose, Jacobian, measure and symmetric gradient agree to rounding; so do morphed ones, and guesses from one to the other.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

numbers() {
    h5dump -m %.17g -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}

# Residuals are 1e-10 of the pressure load; seen 2e-10 and less.
exact=1e-8

# compare ITEM FACTOR FIRST SECOND [TOLERANCE]: FACTOR times the numbers of the first are those of the second.
compare() {
    awk -v a="$(numbers "$1" "$work/$3.h5")" -v b="$(numbers "$1" "$work/$4.h5")" -v f="$2" -v t="${5:-$exact}" 'BEGIN {
        n = split(a, A); split(b, B)
        for (i = 1; i <= n; i++) {
            d = (f * A[i] - B[i])^2
            if (d > worst) worst = d
            if (B[i]^2 > most) most = B[i]^2
        }
        print "worst", sqrt(worst), "of", sqrt(most)
        exit !(n > 0 && most > 0 && worst <= (t * most^0.5)^2) }'
}

# gradient NAME: all points of work and sens files of the mesh NAME, and the step that they give.
gradient() {
    for k in 0 1 2 3; do
        "$BIN/fesolve" -q --tolerance 1e-10 --load "$k" "$work/$1.h5" -o "$work/$1-$k.h5" || return
    done
    "$BIN/wsint" -q "$work/$1"-?.h5 -o "$work/$1-work.h5" || return
    for k in 0 1 2 3; do
        "$BIN/adjsens" -v "$work/$1-$k.h5" "$work/$1-work.h5" -o "$work/$1-sens$k.h5" || return
    done
    "$BIN/trstep" -q "$work/s.h5" "$work/$1-work.h5" "$work/$1"-sens?.h5 -o "$work/$1-step.h5"
}

check "surfaces" "$BIN/surfgen" -q tests/data/tiny.ini -o "$work/s.h5"
check "half" "$BIN/tetmesh" "$work/s.h5" -o "$work/half.h5"
check "whole" "$BIN/tetmesh" --symmetry none "$work/s.h5" -o "$work/whole.h5"
for name in half whole; do
    check "$name keeps its promises" "$LIB/check_mesh" "$work/$name.h5" "$work/s.h5" 0.2
    check "$name: gradient" gradient "$name"
done
check "pose" compare /tip/U 1 half-1 whole-1
check "Jacobian" compare /tip/J 1 half-1 whole-1
check "volumes are those of the part" compare /chamber/volume 2 half-1 whole-1
check "energy too" compare /solve/energy 2 half-1 whole-1
check "measure" compare /measure/value 1 half-work whole-work
check "symmetric gradient" compare /accepted/gradient 1 half-step whole-step
# out-of-plane parts of the whole: rounding of a residual of 1e-10 (seen 1e-13 mm and 1e-9 mm)
check "the whole stays symmetric" awk -v u="$(numbers /tip/U "$work/whole-1.h5")" 'BEGIN {
    split(u, U); print U[2], U[4], U[6]; exit !(U[2]^2 < 1e-18 && U[4]^2 < 1e-20 && U[6]^2 < 1e-20) }'
check "gradient against differences" "$BIN/adjsens" --check "$work/half-0.h5" "$work/half-work.h5" -o "$work/check.h5"
for name in half whole; do
    option=$([ "$name" = half ] && echo auto || echo none)
    check "$name morphed" "$BIN/tetmesh" -q --symmetry "$option" --previous "$work/$name.h5" "$work/half-step.h5" -o "$work/$name-moved.h5"
    check "$name morphed keeps its promises" "$LIB/check_mesh" "$work/$name-moved.h5" "$work/half-step.h5" 0.2
done
check "half from the whole" "$BIN/fesolve" --guess "$work/whole-1.h5" --tolerance 1e-10 --load 1 "$work/half-moved.h5" -o "$work/half-next.h5"
check "whole from the half" "$BIN/fesolve" --guess "$work/half-1.h5" --tolerance 1e-10 --load 1 "$work/whole-moved.h5" -o "$work/whole-next.h5"
check "pose after morphing" compare /tip/U 1 half-next whole-next
for name in half whole; do
    check "$name: used the guess" test "$(numbers /solve/load_steps "$work/$name-next.h5")" -eq 0
done
expect 0 "a half for a whole" "$BIN/tetmesh" "$work/s.h5" --symmetry none --previous "$work/half.h5" -o "$work/p.h5"
check "is meshed anew, and says so" grep -q "of another part of the body: meshing anew" "$work/err"

# The picture of a half is that of the whole: as many facets, the same box.
box() {
    "$BIN/pmplot" deformed "$1" | awk 'NF == 6 && $1 != "#" { n++; for (i = 1; i <= 3; i++) { if ($i > hi[i]) hi[i] = $i; if ($i < lo[i]) lo[i] = $i } }
        END { print n; for (i = 1; i <= 3; i++) printf "%.3f %.3f\n", lo[i], hi[i] }'
}
check "picture" test "$(box "$work/half-1.h5")" = "$(box "$work/whole-1.h5")"

# A quarter of one chamber on the axis.
{ sed 's/^center = .*/center = 0, 0, 25/' tests/data/finger.ini; printf '\n[symmetry]\ngroup = mirror-x mirror-y\n'; } >"$work/one.ini"
check "quarter: surfaces" "$BIN/surfgen" -q "$work/one.ini" -o "$work/one.h5"
check "quarter" "$BIN/tetmesh" "$work/one.h5" -o "$work/quarter.h5"
check "quarter: whole" "$BIN/tetmesh" --symmetry none "$work/one.h5" -o "$work/four.h5"
for name in quarter four; do
    check "$name keeps its promises" "$LIB/check_mesh" "$work/$name.h5" "$work/one.h5" 0.2
    check "$name: solved" "$BIN/fesolve" --tolerance 1e-10 --pressure 0.1 "$work/$name.h5" -o "$work/$name-0.h5"
done
check "quarter: pose" compare /tip/U 1 quarter-0 four-0
check "quarter: volume" compare /chamber/volume 4 quarter-0 four-0

# Chambers at 0 and +-120 degrees: the mirror y keeps the first and exchanges the others, the model is the whole.
sed 's/mirror-x mirror-y/c3 mirror-y/; s/= 2T/= 3T/; s/wall_min = 2/wall_min = 1.9/' tests/data/tiny.ini >"$work/three.ini"
check "three: surfaces" "$BIN/surfgen" -q "$work/three.ini" -o "$work/three.h5"
check "three: mesh" "$BIN/tetmesh" "$work/three.h5" -o "$work/three-mesh.h5"
check "three keeps its promises" "$LIB/check_mesh" "$work/three-mesh.h5" "$work/three.h5" 0.2
check "three: solved" "$BIN/fesolve" --tolerance 1e-10 --pressure 0.1,0,0 "$work/three-mesh.h5" -o "$work/three-0.h5"
check "three: the first chamber bends in its plane" awk -v u="$(numbers /tip/U "$work/three-0.h5")" 'BEGIN {
    split(u, U); print U[2], U[4], U[6]; exit !(U[1]^2 > 0 && U[2]^2 < 1e-18 && U[4]^2 < 1e-20 && U[6]^2 < 1e-20) }'
finish
