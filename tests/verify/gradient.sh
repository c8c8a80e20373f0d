#!/bin/bash
# The gradient of the measure by all control points against central differences of the whole computation (surface,
# morph, equilibrium, Jacobian, measure) on the tiny robot, for every element and both forms of the measure.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

check "surfaces" "$BIN/surfgen" tests/data/tiny.ini -o "$work/surf.h5"
check "mesh" "$BIN/tetmesh" "$work/surf.h5" -o "$work/mesh.h5"

# states ELEMENT FORM LAST [OPTIONS]: all points of a form.
states() {
    local g
    for ((g = 0; g <= $3; g++)); do
        "$BIN/fesolve" --element "$1" --form "$2" --load "$g" "${@:4}" "$work/mesh.h5" -o "$work/$1-$2-$g.h5" || return
    done
    "$BIN/wsint" --form "$2" "$work/$1-$2"-?.h5 -o "$work/$1-$2-work.h5"
}

# gradient ELEMENT FORM POINT [OPTIONS]: adjsens refuses (status 4) where the best of a sweep is off by more than 1e-6.
gradient() {
    "$BIN/adjsens" --check "${@:4}" "$work/$1-$2-$3.h5" "$work/$1-$2-work.h5" -o "$work/sens.h5"
}

check "states, boundary form" states tet10-blend boundary 3
check "states, volume form" states tet10-blend volume 2
check "states, plain tet10" states tet10 boundary 3
check "states, mean dilatation" states tet10-mean boundary 3
check "blended dilatation, boundary form" gradient tet10-blend boundary 2
check "blended dilatation, volume form" gradient tet10-blend volume 1
check "plain tet10" gradient tet10 boundary 3
check "mean dilatation" gradient tet10-mean boundary 1
check "states, law of Ogden" states tet10-blend boundary 3 --law ogden --parameters 0.4,1.3,0.01,5,-0.02,-2
check "law of Ogden" gradient tet10-blend boundary 2

# The largest error of a single control point is 2e-6 (differences of a small number).
check "control points of each surface one by one" gradient tet10-blend volume 1 --points 4

# variant NAME SCRIPT: the mesh of the tiny robot's case as sed changes it.
variant() {
    sed "$2" tests/data/tiny.ini >"$work/$1.ini"
    "$BIN/surfgen" "$work/$1.ini" -o "$work/$1.h5" && "$BIN/tetmesh" "$work/$1.h5" -o "$work/mesh.h5"
}

# The motion of nodes inside by elasticity; half a body, whose cut moves too, is the rule (tiny.ini).
check "elastic extension" variant elastic '/^size = /a extension = elasticity'
rm -f "$work"/tet10-blend-volume-*
check "states, elastic extension" states tet10-blend volume 2
check "gradient, elastic extension" gradient tet10-blend volume 1

# Chambers narrower than gap_min: their own walls face each other.
check "chambers narrower than gap_min" variant closing '/^wall_min = /i contact = reject\ngap_min = 11'
rm -f "$work"/tet10-blend-boundary-*
check "states that close" states tet10-blend boundary 5
check "gradient of closeness, a point" gradient tet10-blend boundary 2
check "gradient of closeness, a guard" gradient tet10-blend boundary 4

# entries FORM: U, J, V, C one by one make up the aggregated gradient.
entries() {
    "$BIN/adjsens" --each --form "$1" "$work/tet10-blend-volume-1.h5" "$work/tet10-blend-volume-work.h5" -o "$work/each.h5" &&
        "$LIB/contract" "$work/tet10-blend-volume-work.h5" 1 "$work/each.h5" | awk '{ print } { exit !($1 < 1e-10) }'
}
check "entries one by one, domain form" entries domain
check "entries one by one, boundary form" entries boundary
finish
