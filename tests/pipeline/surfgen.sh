#!/usr/bin/env bash
# Initial surfaces: the same bytes twice, refusals without an output file.
. tests/lib.sh

mkdir "$work/a" "$work/b"
check "surfgen makes the surfaces of the demo case" "$BIN/surfgen" data/cases/2A0R2T.ini -o "$work/a/s.h5"
check "and again" "$BIN/surfgen" data/cases/2A0R2T.ini -o "$work/b/s.h5"
check "equal input gives equal bytes" cmp "$work/a/s.h5" "$work/b/s.h5"
sed 's/^wall = .*/wall = 2.5/' data/cases/2A0R2T.ini >"$work/thin.ini"
refused 3 "a wall that comes out thinner than wall_min" 'wall between surfaces 0 and [12] is 2\.[0-4]' \
    "$BIN/surfgen" "$work/thin.ini" -o "$work/output/s.h5"
# Kept designs, CASE.h5 or CASE-more.h5, fit their cases and hold their walls, which an optimisation leaves up to 2 % short.
for design in data/designs/*.h5; do
    name=$(basename "$design" .h5)
    check "design $name" sh -c '"$1" -v --design "$2" "$3" -o "$4" 2>"$5"' sh \
        "$BIN/surfgen" "$design" "data/cases/${name%%-*}.ini" "$work/$name.h5" "$work/said"
    check "its least wall is at least 0.98 of wall_min" awk '/least wall/ { for (i = 1; i < NF; i++) if ($i == "wall") w = $(i + 1) } END { print w; exit !(w >= 0.98 * 2.5) }' "$work/said"
done
finish
