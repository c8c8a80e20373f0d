#!/bin/bash
# Random shapes (pipelines/shapes.mk): every one is meshed with elements that keep their promises, or refused. About ten
# minutes of two cores; SHAPES=N takes the first N.
. tests/lib.sh

expect 0 "${SHAPES:=200} random shapes" make -s -j2 B="$BUILD" DEPS=no shapes-results SHAPES="$SHAPES" SHAPES_RUN="$work/shapes"
sed 's/^/# /' "$work/out" >&2 # prove shows it
check "none without surfaces" test "$(grep -c 'no surfaces' "$work/shapes/shapes.tsv")" -eq 0
finish
