#!/bin/bash
# fesolve --path: points in their order, equal to single loads; what cannot be reached; bad files; self-contact carried
# on from state to measure.
. tests/lib.sh

check "surfgen" "$BIN/surfgen" tests/data/tiny.ini -o "$work/surf.h5"
check "tetmesh" "$BIN/tetmesh" -q "$work/surf.h5" -o "$work/mesh.h5"
printf '# there and back\n0, 0\n0.06 0\t# half\n\n0.12 0.03\n0,0\n' >"$work/path.txt"
check "path" "$BIN/fesolve" --path "$work/path.txt" "$work/mesh.h5" -o "$work/path.h5"
check "one load" "$BIN/fesolve" --pressure 0.12,0.03 "$work/mesh.h5" -o "$work/state.h5"

# numbers DATASET FILE
numbers() {
    h5dump -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}
check "the points" test "$(numbers /path/pressure "$work/path.h5" | tr -s ' ')" = " 0 0 0.06 0 0.12 0.03 0 0 "
# both solved to a residual of 1e-8 of the load
check "pose as by one load" awk -v a="$(numbers /path/U "$work/path.h5")" -v b="$(numbers /tip/U "$work/state.h5")" \
    'BEGIN { n = split(a, x); split(b, y); if (n != 24) exit 1; for (i = 1; i <= 6; i++) { d = x[12 + i] - y[i]; if (d * d > 1e-12) exit 1 } }'
check "no pressure: no displacement, on the way back too" awk -v a="$(numbers /path/U "$work/path.h5")" \
    'BEGIN { split(a, x); for (i = 1; i <= 6; i++) if (x[i] != 0 || x[18 + i] != 0) exit 1 }'
check "again" "$BIN/fesolve" --path "$work/path.txt" "$work/mesh.h5" -o "$work/second.h5"
mv "$work/path.h5" "$work/first.h5"
check "again, the same name" "$BIN/fesolve" --path "$work/path.txt" "$work/mesh.h5" -o "$work/path.h5"
check "equal bytes" cmp "$work/first.h5" "$work/path.h5"
check "its first input but the mesh is the list" sh -c "h5dump -a /inputs '$work/path.h5' | grep -q 'file path.txt crc32'"

"$BIN/pmplot" path "$work/path.h5" >"$work/table"
check "table: four lines of 2 + 6 + 2 + 3 numbers" awk '!/^#/ { n++; if (NF != 13) exit 1 } END { exit n != 4 }' "$work/table"
check "picture" gnuplot -c pipelines/pictures/path.gp "$work/table" 2 "$work/path.png"
check "picture is there" test -s "$work/path.png"

# 5 mu is far beyond the limit of this body.
printf '0.06 0\n5 0\n0.12 0\n' >"$work/far.txt"
refused 4 "a point that cannot be reached" "point 2 of '.*far.txt'" \
    "$BIN/fesolve" --path "$work/far.txt" "$work/mesh.h5" -o "$work/output/x.h5"
check "recorded" "$BIN/fesolve" -q --record-failure --path "$work/far.txt" "$work/mesh.h5" -o "$work/far.h5"
check "and gone on" test "$(numbers /path/reached "$work/far.h5" | tr -s ' ')" = " 1 0 1 "
"$BIN/pmplot" path "$work/far.h5" >"$work/table"
check "table: a blank line for it" test "$(grep -c '^$' "$work/table")" -eq 1
bad() {
    printf '%b' "$2" >"$work/bad.txt"
    refused 3 "$1" "$3" "$BIN/fesolve" --path "$work/bad.txt" "$work/mesh.h5" -o "$work/output/x.h5"
}
bad "too few pressures" '0 0\n0.1\n' "bad.txt': line 2 has 1 pressures, the mesh has 2 chambers"
bad "too many" '0 0 0\n' "line 1 has 3 pressures"
bad "no number" '0 a\n' "line 1: found 'a'"
bad "not finite" '0 nan\n' "line 1: found 'nan'"
bad "no points" '# nothing\n\n' "no points"
refused 3 "no file" "cannot open '.*none.txt'" "$BIN/fesolve" --path "$work/none.txt" "$work/mesh.h5" -o "$work/output/x.h5"
refused 2 "a path and a load" "exactly one of" "$BIN/fesolve" --path "$work/path.txt" --load 0 "$work/mesh.h5" -o "$work/output/x.h5"

# Sucked flat: the chamber's walls come near each other; a damaged displacement makes faces pierce.
check "negative pressure" "$BIN/fesolve" --pressure=-0.2,0 "$work/mesh.h5" -o "$work/flat.h5"
check "a wide chamber has no gap" awk -v a="$(numbers /contact/gap "$work/state.h5")" 'BEGIN { exit !(a == -1) }'
check "nothing intersects" test "$(numbers /contact/intersections "$work/flat.h5" | tr -d ' ')" = 0
for g in 0 1 2 3; do
    check "load $g" "$BIN/fesolve" -q --load $g "$work/mesh.h5" -o "$work/s$g.h5"
done
check "damage" "$LIB/mangle" set "$work/s1.h5" /contact/intersections 0 7
expect 0 "wsint" "$BIN/wsint" "$work"/s?.h5 -o "$work/work.h5"
check "wsint warns" grep -q "penetrates itself in 1 of 4 states, with 7 pairs of faces in '.*s1.h5'" "$work/err"
check "and of nothing else" test "$(grep -c warning "$work/err")" -eq 1
check "wsint carries it on" test "$(numbers /point/intersections "$work/work.h5" | tr -s ' ')" = " 0 7 0 0 "
for i in 0 1 2 3; do
    check "dU/dp grows" "$LIB/mangle" set "$work/s3.h5" /tip/J "$i" 1e6
done
expect 0 "wsint" "$BIN/wsint" "$work"/s?.h5 -o "$work/work.h5"
check "warns of a loss of stability" grep -q "amplification [0-9.e+]*, above amplification_max = 1.5: close to a loss of stability 2 points" "$work/err"
finish
