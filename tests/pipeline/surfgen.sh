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
finish
