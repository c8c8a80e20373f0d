#!/bin/bash
# fesolve --guess of another mesh, shape and element leads to the same equilibrium as the undeformed state does; one
# that is no good is said and counted.
. tests/lib.sh

check "surfgen" "$BIN/surfgen" tests/data/tiny.ini -o "$work/surf.h5"
sed 's/^amplitude = 1$/amplitude = 1.2/' tests/data/tiny.ini >"$work/other.ini"
check "surfgen, other shape" "$BIN/surfgen" "$work/other.ini" -o "$work/other.h5"
check "mesh" "$BIN/tetmesh" -q --size 8 "$work/surf.h5" -o "$work/coarse.h5"
check "finer mesh" "$BIN/tetmesh" -q --size 6 "$work/surf.h5" -o "$work/fine.h5"
check "mesh of the other shape" "$BIN/tetmesh" -q --size 7 "$work/other.h5" -o "$work/shape.h5"
check "guess" "$BIN/fesolve" --pressure 0.12,0 "$work/coarse.h5" -o "$work/guess.h5"
check "guess further on" "$BIN/fesolve" --pressure 0.2,0 "$work/coarse.h5" -o "$work/far.h5"
guess=$work/guess.h5

# numbers DATASET FILE
numbers() {
    h5dump -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}
# same NAME MESH PRESSURES ARGUMENTS..: from the guess and from zero
same() {
    local name=$1 mesh=$2 pressure=$3
    shift 3
    check "$name: from zero" "$BIN/fesolve" --pressure "$pressure" "$mesh" "$@" -o "$work/zero.h5"
    expect 0 "$name: from the guess" "$BIN/fesolve" --pressure "$pressure" --guess "$guess" "$mesh" "$@" -o "$work/warm.h5"
    check "$name: no warning" test ! -s "$work/err"
    check "$name: the guess served" test "$(numbers /solve/warm "$work/warm.h5" | tr -d ' ')" = 1
    # both solved to a residual of 1e-8 of the load
    check "$name: the same pose" awk -v a="$(numbers /tip/U "$work/zero.h5")" -v b="$(numbers /tip/U "$work/warm.h5")" \
        'BEGIN { n = split(a, x); split(b, y); if (n != 6) exit 1; for (i = 1; i <= 6; i++) { d = x[i] - y[i]; if (d * d > 1e-12) exit 1 } }'
}
same "finer mesh" "$work/fine.h5" 0.12,0
same "finer mesh, other load" "$work/fine.h5" 0.06,0.12
same "other shape" "$work/shape.h5" 0.12,0
same "other element" "$work/fine.h5" 0.12,0 --element tet15
# its stresses are so wrong that the tangent there is indefinite
guess=$work/far.h5
same "other shape, stiffer in volume" "$work/shape.h5" 0.2,0 --kappa 300
check "one correction is counted" test "$(numbers /solve/backoffs "$work/warm.h5" | tr -d ' ')" = 1

"$LIB/mangle" set "$work/guess.h5" /node/displacement 300 40
expect 0 "a spoilt guess" "$BIN/fesolve" --pressure 0.12,0 --guess "$work/guess.h5" "$work/fine.h5" -o "$work/warm.h5"
check "it says so" grep -q "the guess does not lead to an equilibrium: starting from the undeformed state" "$work/err"
check "and counts it" test "$(numbers /solve/backoffs "$work/warm.h5" | tr -d ' ')" -gt 0
check "not warm" test "$(numbers /solve/warm "$work/warm.h5" | tr -d ' ')" = 0
finish
