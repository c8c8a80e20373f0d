#!/bin/bash
# Output files: whole or absent, equal bytes for equal input, provenance, VTKHDF.
. tests/lib.sh

large=data/cases/2A0R2T.ini
case=$work/small.ini
cat >"$case" <<'END'
[case]
name = small
[material]
mu = 0.5
[body]
height = 40
wall = 3
around = 24
rows = 16
[chamber1]
shape = capsule
center = 11, 0, 20
radius = 8
length = 30
spacing = 4
[symmetry]
group = mirror-x mirror-y
[workspace]
measure = 2T
END
check "surfgen writes" "$BIN/surfgen" "$case" -o "$work/a.h5"
mkdir "$work/b"
cp "$case" "$work/b/"
check "surfgen writes again, from and to elsewhere, loudly" \
    "$BIN/surfgen" -v --output="$work/b/a.h5" "$work/b/small.ini"
check "with -q" "$BIN/surfgen" -q -o "$work/b/a2.h5" "$case"
# The command line is part of the file: equal ones give equal bytes, also a second later.
sleep 1.1
mkdir "$work/c"
check "surfgen once more" "$BIN/surfgen" -q "$work/b/small.ini" -vv -o "$work/c/a.h5"
check "equal bytes" cmp "$work/a.h5" "$work/c/a.h5"

# attribute NAME FILE: the text of a root attribute.
attribute() {
    h5dump -a "/$1" "$2" | sed -n 's/^ *(0): "\(.*\)"$/\1/p'
}
check "attribute command" test "$(attribute command "$work/a.h5")" = "surfgen -o a.h5 small.ini"
check "attribute kind" test "$(attribute kind "$work/a.h5")" = surface
check "attribute tool_version" test "$(attribute tool_version "$work/a.h5")" = "$(cat VERSION)"
crc=$(gzip -c "$case" | tail -c 8 | od -A n -t x4 -N 4 | tr -d ' ')
check "attribute inputs: role, name, digest" \
    test "$(attribute inputs "$work/a.h5")" = "case small.ini crc32:$crc"
expect 1 "no path of this machine in the file" grep -qa "$work" "$work/b/a.h5"

# Whole or absent.
refused 1 "folder that does not exist" "cannot write '$work/none/x.h5': No such file" \
    "$BIN/surfgen" "$case" -o "$work/none/x.h5"
for blocks in 1 8 32 64; do
    refused 1 "disk full after $blocks kB" "cannot write '.*': item" \
        bash -c "ulimit -f $blocks; exec '$BIN/surfgen' '$case' -o '$work/output/x.h5'"
done
mkdir "$work/killed"
cp "$work/a.h5" "$work/killed/x.h5"
for signal in INT TERM HUP; do
    timeout -s "$signal" 0.3 "$BIN/surfgen" -q "$large" -o "$work/killed/x.h5"
    check "killed by $signal: the old file stays" cmp -s "$work/killed/x.h5" "$work/a.h5"
    check "killed by $signal: nothing else is left" test "$(ls -A "$work/killed")" = x.h5
done

# What ParaView needs of a mesh and a state.
for kind in mesh state; do
    check "sample $kind" "$LIB/sample" "$kind" "$work/$kind.h5"
    h5dump -A "$work/$kind.h5" >"$work/$kind.txt"
    h5ls -r "$work/$kind.h5" >"$work/$kind.ls"
    check "$kind: grid type" grep -q '"UnstructuredGrid"' "$work/$kind.txt"
    check "$kind: points are ours" grep -q '^/VTKHDF/Points *Soft Link {/mesh/x}' "$work/$kind.ls"
    check "$kind: cells" grep -q '^/VTKHDF/Types *Dataset {1}' "$work/$kind.ls"
    check "$kind: offsets" grep -q '^/VTKHDF/Offsets *Dataset {2}' "$work/$kind.ls"
    check "$kind: node numbers are 64 bit" sh -c "h5dump -H -d /VTKHDF/Connectivity '$work/$kind.h5' | grep -q H5T_STD_I64LE"
    check "$kind: cell types are 8 bit" sh -c "h5dump -H -d /VTKHDF/Types '$work/$kind.h5' | grep -q H5T_STD_U8LE"
done
check "state: displacement" grep -q '^/VTKHDF/PointData/displacement *Soft Link {/node/displacement}' "$work/state.ls"
finish
