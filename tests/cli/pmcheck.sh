#!/bin/bash
# pmcheck: valid files of all kinds with what made them, damaged ones with what is wrong.
. tests/lib.sh

for kind in surface mesh state work sens step; do
    check "sample $kind" "$LIB/sample" "$kind" "$work/$kind.h5"
    expect 0 "$kind" "$BIN/pmcheck" "$work/$kind.h5"
    check "$kind: says so" grep -q "^$work/$kind.h5: valid, $kind by " "$work/out"
done
check "surfaces" "$BIN/surfgen" -q tests/data/tiny.ini -o "$work/s.h5"
check "skin" "$BIN/surfexport" -q --tolerance 1 --size 8 "$work/s.h5" -o "$work/skin.h5"
expect 0 "skin" "$BIN/pmcheck" --history "$work/skin.h5"
check "by what" grep -qxF "$work/skin.h5: valid, skin by surfexport $(cat VERSION)" "$work/out"
check "command" grep -qx "  command: surfexport --tolerance 1 --size 8 -o skin.h5 s.h5" "$work/out"
check "input" grep -qx "  input: surface s.h5 crc32:[0-9a-f]*" "$work/out"
check "history" grep -qx "  history: surfgen -o s.h5 tiny.ini" "$work/out"
expect 0 "without history" "$BIN/pmcheck" "$work/skin.h5"
check "there is none" sh -c "! grep -q history '$work/out'"

# bad NAME PATTERN: of bad.h5.
bad() {
    refused 3 "$1" "$2" "$BIN/pmcheck" "$work/bad.h5"
    check "$1: in the list too" grep -q "^$work/bad.h5: not valid: cannot use" "$work/out"
}
# damage KIND MANGLE..: bad.h5 is a damaged file of the kind.
damage() {
    cp "$work/$1.h5" "$work/bad.h5"
    check "damage" "$LIB/mangle" "$2" "$work/bad.h5" "${@:3}"
}
damage skin set /skin/tri 0 100000 && bad "node that is not there" "item '/skin/tri' is 100000 at entry 0"
damage skin set /skin/wall 3 nan && bad "no number" "item '/skin/wall' holds nan at entry 3"
damage skin drop /skin/x && bad "item missing" "item '/skin/x' is missing"
damage skin shorten /skin/tag && bad "too short" "item '/skin/tag' has [0-9]* along axis 0, expected"
damage mesh narrow /mesh/tet && bad "another type" "item '/mesh/tet' has another type, expected int32"
damage surface set /surface1/tri 0 -1 && bad "record" "item '/surface1/tri'"
damage state attribute kind other && bad "unknown kind" "it is of kind 'other', expected"
damage work attribute format_version 2.0 && bad "version" "format version 2.0"
echo text >"$work/bad.h5" && bad "no HDF5 file" "cannot use '$work/bad.h5'"
refused 3 "two of three" "^pmcheck: 2 of 3 files are not valid, the first: cannot use '$work/bad.h5'" \
    "$BIN/pmcheck" "$work/bad.h5" "$work/mesh.h5" "$work/bad.h5"
check "the good one is looked at" grep -q "^$work/mesh.h5: valid" "$work/out"
refused 2 "output" "expected no -o" "$BIN/pmcheck" "$work/mesh.h5" -o "$work/output/x.h5"
refused 3 "no file" "cannot open '$work/none.h5'" "$BIN/pmcheck" "$work/none.h5"
finish
