#!/bin/bash
# invkin on a slender pair of chambers that bends far: random reachable targets are reached, what is beyond reach is said
# to be, with its nearest pose, pressures stay within their bounds.
. tests/lib.sh
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1

"$LIB/beam" pair half 4 "$work/b.msh"
check "mesh" "$BIN/tetmesh" -q --import "$work/b.msh" --mu 1 --kappa 100 -o "$work/mesh.h5"
# Ten random points of the box 0..0.15 and their poses.
awk 'BEGIN { s = 7; for (i = 0; i < 20; i++) { s = (s * 16807) % 2147483647; printf "%.9f%s", 0.15 * s / 2147483647, i % 2 ? "\n" : " " } }' >"$work/p.txt"
check "poses" "$BIN/fesolve" --path "$work/p.txt" "$work/mesh.h5" -o "$work/path.h5"
"$BIN/pmplot" path "$work/path.h5" | awk '!/^#/ { print $3, $5 > "'"$work"'/xz"; if (n++ < 5) print $5, $7 > "'"$work"'/za" }'

# reach NAME DOFS TARGETS COUNT
reach() {
    expect 0 "$1" "$BIN/invkin" --table --bounds 0,0.15 --dofs "$2" --targets "$3" "$work/mesh.h5" -o "$work/inv.h5"
    sed 's/^/# /' "$work/out"
    check "$1: all reached within 0.01 mm and 0.01 degrees" \
        awk -F '\t' 'NR > 1 { n++; if ($2 != "reached" || $7 > 0.01 || $8 > 0.01) bad = 1 } END { exit bad || n != "'"$4"'" }' "$work/out"
    check "$1: within the bounds" awk -F '\t' 'NR > 1 { for (k = 3; k <= 4; k++) if ($k < 0 || $k > 0.15) exit 1 }' "$work/out"
    check "$1: median of at most 4 equilibria" \
        sh -c "awk -F '\t' 'NR > 1 { print \$11 }' '$work/out' | sort -n | awk '{ n[NR] = \$1 } END { exit !(n[int((NR + 1) / 2)] <= 4) }'"
    sed 1d "$work/out" >"$work/rows"
}
reach "positions" 1,3 "$work/xz" 10
# 0.01 mm at a slope of some 30 mm per p/mu
check "the pressures are found" sh -c "paste '$work/p.txt' '$work/rows' | awk '{ for (k = 1; k <= 2; k++) { d = \$(k) - \$(k + 4); if (d * d > 4e-6) exit 1 } }'"
reach "position and angle" 3,5 "$work/za" 5

printf -- '-40 0\n0 20\n' >"$work/far.txt"
expect 0 "beyond reach" "$BIN/invkin" --table --bounds 0,0.15 --dofs 1,3 --targets "$work/far.txt" "$work/mesh.h5" -o "$work/far.h5"
check "it warns" grep -q "2 of 2 targets are not reached" "$work/err"
check "at the bounds" test "$(awk -F '\t' 'NR > 1 { print $2, $9 }' "$work/out" | tr '\n' ' ')" = "at-bound p1=high,p2=low at-bound p1=high,p2=high "
expect 0 "three components for two chambers" "$BIN/invkin" --table --bounds 0,0.15 --dofs 1,3,5 --target=-1.343,0.935,-0.12 \
    --record-failure "$work/mesh.h5" -o "$work/three.h5"
check "nearest, between the bounds" test "$(awk -F '\t' 'NR > 1 { print $2, $10 }' "$work/out")" = "nearest -"
expect 0 "one component for two chambers" "$BIN/invkin" --table --bounds 0,0.15 --dofs 1 --target=-3 "$work/mesh.h5" -o "$work/one.h5"
check "reached" grep -q "^1.reached" "$work/out"
finish
