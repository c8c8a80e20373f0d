#!/bin/bash
# An octant of a thick sphere, imported from gmsh files and inflated, against the radial solution for
# kappa = 100 mu, p/mu = 0.12 (benchmark by ODE to all digits printed): u at r = 1 and r = 2.
# shellcheck disable=SC2016,SC2317 # awk and sed programs; functions that check calls
. tests/lib.sh

want_a=0.037058085
want_b=0.009676706
sphere=$LIB/thick_sphere

# solve N M: $1 parts a side, $2 layers; the errors are appended to $work/table.
solve() {
    "$sphere" write "$1" "$2" quadratic "$work/s.msh" &&
        "$BIN/tetmesh" --import "$work/s.msh" --mu 1 --kappa 100 -o "$work/s.h5" &&
        "$BIN/fesolve" "$work/s.h5" --pressure 0.12 -o "$work/state.h5" &&
        "$sphere" read "$work/state.h5" |
        awk -v n="$1" -v m="$2" -v a="$want_a" -v b="$want_b" \
            '{ print n, m, $1, $2, ($1 - a) / a, ($2 - b) / b }' >>"$work/table"
}

for grid in "2 1" "3 2" "4 3" "6 4" "8 6"; do
    # shellcheck disable=SC2086
    check "octant of $grid parts" solve $grid
done
echo "# parts layers u_a u_b error_a error_b"
sed 's/^/# /' "$work/table"
# 0.5 % is the accuracy a design needs; seen: 0.16 % and 0.01 %
check "u_a and u_b within 0.5 % at 6 x 4" awk 'function abs(v) { return v < 0 ? -v : v }
    $1 == 6 { good = abs($5) < 5e-3 && abs($6) < 5e-3 } END { exit !good }' "$work/table"
check "errors fall with the mesh" awk 'function abs(v) { return v < 0 ? -v : v }
    NR > 1 && (abs($5) > a || abs($6) > b) { bad = 1 } { a = abs($5); b = abs($6) } END { exit bad }' "$work/table"
# quadratic elements with one blended dilatation: order 3 to 4 in the displacement, seen 3.1
check "order 2.5 or more between 3 x 2 and 6 x 4" awk 'function abs(v) { return v < 0 ? -v : v }
    $1 == 3 { a = abs($5) } $1 == 6 { b = abs($5) } END { exit !(a / b > 2 ^ 2.5) }' "$work/table"
finish
