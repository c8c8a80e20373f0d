#!/bin/bash
# The Jacobian of the end-effector against differences of equilibria, at rotations up to beyond half a turn; a pleated
# finger that curls (half of it), on a mesh that is the same from run to run.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

# Central differences with h = 1e-5: seen 2e-9 to 2.7e-8, half of it h^2 U'''/6, the rest residuals of 1e-10 (at h = 1e-4
# 3e-6 at the largest rotation, at 3e-4 with two widths extrapolated 1e-9). 1e-6 is what we ask for.
h=1e-5
tolerance=1e-6

numbers() {
    h5dump -m %.17g -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}

# body PITCHES
body() {
    "$LIB/beam" finger half "$1" "$work/$1.msh" && "$BIN/tetmesh" -q --import "$work/$1.msh" --mu 1 --kappa 100 -o "$work/$1.h5"
}

# walk PITCHES ELEMENT PRESSURE..: three equilibria at each pressure, one after the other along one path.
walk() {
    for p in "${@:3}"; do
        awk -v p="$p" -v h="$h" 'BEGIN { for (k = -1; k <= 1; k++) printf "%.17g\n", p + k * h }'
    done >"$work/path.txt"
    "$BIN/fesolve" --element "$2" --tolerance 1e-10 --path "$work/path.txt" "$work/$1.h5" -o "$work/path.h5" &&
        awk -v p="$(numbers /path/pressure "$work/path.h5")" -v u="$(numbers /path/U "$work/path.h5")" \
            -v j="$(numbers /path/J "$work/path.h5")" 'BEGIN {
            n = split(p, P); split(u, U); split(j, J)
            for (k = 1; k < n; k += 3) {
                split("", square); split("", error)
                for (i = 1; i <= 6; i++) {
                    d = (U[6 * (k + 1) + i] - U[6 * (k - 1) + i]) / (P[k + 2] - P[k])
                    square[i > 3] += J[6 * k + i]^2; error[i > 3] += (d - J[6 * k + i])^2
                }
                print P[k + 1], U[6 * k + 5], sqrt(error[0] / square[0]), sqrt(error[1] / square[1])
            } }' >"$work/table"
}

# at ROTATION WITHIN: a line of the table has this rotation about y, and its errors are small.
at() {
    awk -v want="$1" -v within="$2" -v t="$tolerance" '
        { d = $2 - want; if (d < within && d > -within) { n++; good += $3 < t && $4 < t } } END { exit !(n > 0 && good == n) }' "$work/table"
}

# nowhere FILE: no faces pierce.
nowhere() {
    [ -z "$(numbers /path/intersections "$1" | tr -d ' 0')" ]
}

check "a finger of 20 pitches" body 20
# The rotation vector passes pi, within the third triple, and goes on to 3.5 rad instead of jumping to the short way round.
check "it curls to 3.5 rad" walk 20 tet10-blend 0.028 0.085 0.1219 0.131
sed 's/^/# p, rotation, errors of J: /' "$work/table"
check "J at 0.5 rad" at -0.5 0.01
check "J at 2 rad" at -1.92 0.01
check "J at pi" at -3.14 0.01
check "J at 3.5 rad" at -3.5 0.01
check "nothing touches" nowhere "$work/path.h5"

check "a finger of 6 pitches" body 6
for element in tet10 tet10-mean tet15; do
    check "$element curls" walk 6 "$element" 0.13
    sed "s/^/# $element: /" "$work/table"
    check "$element: J about 0.9 rad" at -0.9 0.3
done
# Linear tetrahedra lock; their mid-side nodes are put between the vertices.
check "tet4 bends a little" walk 20 tet4 0.2
sed 's/^/# tet4: /' "$work/table"
check "tet4: J about 0.2 rad" at -0.25 0.2
check "tet4: nothing touches" nowhere "$work/path.h5"
finish
