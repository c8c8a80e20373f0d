#!/bin/bash
# The bellows tube of data/bodies with one element through the wall: elongation against 4.138 mm (+- 0.002), an
# axisymmetric model of CalculiX (2039 elements CAX8R, the same energy), and the change of the chamber's volume against
# tet15 on a fine mesh (`make accuracy`). gmsh's meshes differ a little from run to run.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

# mesh NAME OPTION..: a quarter of the body.
mesh() {
    local name=$1
    shift
    gmsh -3 -nt 1 -v 2 "$@" data/bodies/bellows.geo -o "$work/$name.msh" &&
        "$BIN/tetmesh" --import "$work/$name.msh" --mu 1 --kappa 100 -o "$work/$name.h5"
}

# number ITEM PLACE FILE: the PLACE-th number of a dataset.
number() {
    h5dump -A 0 -y -w 0 -d "$1" "$3" | awk -v n="$2" '/ DATA \{/ { on = 1; next } on { gsub(/,/, " "); $0 = $0; print $n; exit }'
}

# solve NAME ELEMENT: relative errors of elongation and volume change to the table.
solve() {
    local state=$work/state.h5
    "$BIN/fesolve" --element "$2" --pressure 0.12 "$work/$1.h5" -o "$state" || return
    awk -v e="$1-$2" -v u="$(number /tip/U 3 "$state")" -v v="$(number /chamber/volume 1 "$state")" \
        -v v0="$(number /chamber/volume0 1 "$state")" 'BEGIN { print e, u / 4.138 - 1, (v - v0) / 897.2 - 1 }' >>"$work/table"
}

# within NAME LOW HIGH: the error of elongation and that of the volume.
within() {
    awk -v e="$1" -v low="$2" -v high="$3" '$1 == e { good = $2 > low && $2 < high && $3 > low && $3 < high } END { exit !good }' "$work/table"
}

check "mesh" mesh curved -setnumber size 2.5
check "mesh with straight edges" mesh straight -setnumber size 2.5 -setnumber straight 1
check "tet10-blend" solve curved tet10-blend
check "from zero in at most 8 factorisations" test "$(number /solve/factorisations 1 "$work/state.h5")" -le 8
check "tet10" solve curved tet10
check "tet10, straight edges" solve straight tet10
sed 's/^/# /' "$work/table"
# seen: -0.3 %, -0.7 %; the rest for the other meshes that gmsh may make
check "tet10-blend: 2 %" within curved-tet10-blend -0.02 0.02
# seen: -4.9 %, -3.6 % and -12 %, -8 %
check "tet10 is off by 2 to 8 %" within curved-tet10 -0.08 -0.02
check "tet10 with straight edges by more than 6 %" within straight-tet10 -0.2 -0.06
finish
