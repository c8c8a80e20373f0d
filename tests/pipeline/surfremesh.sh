#!/bin/bash
# Redistribution: nothing without need, on request within tolerances and repeatable, refusals.
. tests/lib.sh

case=tests/data/tiny.ini
mkdir "$work/a" "$work/b"
check "surfaces" "$BIN/surfgen" "$case" -o "$work/s.h5"
check "even surfaces stay" "$BIN/surfremesh" "$work/s.h5" -o "$work/kept.h5"
check "bit for bit" h5diff "$work/s.h5" "$work/kept.h5" /surface1 /surface1
check "a new spacing" "$BIN/surfremesh" "$work/s.h5" --spacing 3.2 -o "$work/a/r.h5"
check "again" "$BIN/surfremesh" "$work/s.h5" --spacing 3.2 -o "$work/b/r.h5"
check "equal input gives equal bytes" cmp "$work/a/r.h5" "$work/b/r.h5"
refused 4 "too few control points to hold the surface" 'mm off the old one|volume' \
    "$BIN/surfremesh" "$work/s.h5" --points 60 -o "$work/output/r.h5"
expect 0 "or keep" "$BIN/surfremesh" "$work/s.h5" --points 60 --or-keep -o "$work/kept.h5"
check "says so" grep -q "surfaces kept: " "$work/err"
check "unchanged" h5diff "$work/s.h5" "$work/kept.h5" /surface1 /surface1
refused 2 "a negative spacing" "option --spacing is '-1'" "$BIN/surfremesh" "$work/s.h5" --spacing -1 -o "$work/output/r.h5"
refused 2 "an unknown method" "option --method is 'best', expected remesh, conformal or paper" \
    "$BIN/surfremesh" "$work/s.h5" --method best -o "$work/output/r.h5"
finish
