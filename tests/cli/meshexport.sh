#!/bin/bash
# meshexport: decks of meshes and states, equal bytes, what it refuses. (CalculiX itself: tests/verify/calculix.sh.)
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

out=$work/output
export=$BIN/meshexport
check "surfaces" "$BIN/surfgen" -q tests/data/tiny.ini -o "$work/s.h5"
check "mesh" "$BIN/tetmesh" -q --size 12 "$work/s.h5" -o "$work/mesh.h5"
check "state, plain element" "$BIN/fesolve" --element tet10 --pressure 0.1,0.02 "$work/mesh.h5" -o "$work/plain.h5"
check "state, linear element" "$BIN/fesolve" --element tet4 --pressure 0.1,0.02 "$work/mesh.h5" -o "$work/linear.h5"
check "state, default element" "$BIN/fesolve" --pressure 0.1,0.02 "$work/mesh.h5" -o "$work/blend.h5"

expect 0 "deck of a state" "$export" -v "$work/plain.h5" -o "$work/a.inp"
check "-v says what" grep -q '[0-9]* nodes, [0-9]* elements C3D10, 2 chambers' "$work/err"
expect 0 "deck of its mesh at the same pressures" "$export" -p 0.1,0.02 "$work/mesh.h5" -o "$work/b.inp"
sed -i '2d' "$work/a.inp" "$work/b.inp" # the command line
check "is the same" cmp "$work/a.inp" "$work/b.inp"
check "pressures in kPa: p mu" sh -c "grep -q '^CHAMBER1,P,5.0000000000000e+01\$' '$work/a.inp' && grep -q '^CHAMBER2,P,1.0000000000000e+01\$' '$work/a.inp'"
expect 0 "deck of the linear element" "$export" "$work/linear.h5" -o "$work/c.inp"
check "is of C3D4" grep -q '^\*ELEMENT, TYPE=C3D4' "$work/c.inp"
expect 0 "increments" "$export" --steps 4 "$work/plain.h5" -o "$work/d.inp"
check "a quarter each" grep -q '^2.5000000000000e-01,1.,1.e-6,2.5000000000000e-01$' "$work/d.inp"

refused 2 "neither deck nor comparison" "expected -o FILE or --compare" "$export" "$work/plain.h5"
refused 2 "both" "option --compare: expected no -o" "$export" --compare x.dat "$work/plain.h5" -o "$out/x.inp"
refused 2 "steps" "option --steps: found 0, expected 1 to" "$export" --steps 0 "$work/plain.h5" -o "$out/x.inp"
refused 2 "pressures that are none" "option '--pressure': found 'a'" "$export" -p a "$work/mesh.h5" -o "$out/x.inp"
refused 2 "wrong number of pressures" "option --pressure: 3 values for 2 chambers" \
    "$export" -p 0.1,0,0 "$work/mesh.h5" -o "$out/x.inp"
refused 3 "mesh without pressures" "of kind 'mesh', expected 'state'" "$export" "$work/mesh.h5" -o "$out/x.inp"
refused 3 "element that CalculiX has not" "element 'tet10-blend', expected one that CalculiX has" \
    "$export" "$work/blend.h5" -o "$out/x.inp"
refused 1 "folder that does not exist" "cannot write '$work/none/x.inp'" "$export" "$work/plain.h5" -o "$work/none/x.inp"
refused 1 "disk full" "cannot write '$out/x.inp'" \
    bash -c "ulimit -f 8; exec '$export' '$work/plain.h5' -o '$out/x.inp'"
sed -e '/^law\|^mu\|^kappa/d' -e 's/^\[material\]/&\nlaw = ogden\nmu1 = 0.1\nalpha1 = 2\nmu2 = 0.1\nalpha2 = 3\nmu3 = 0.1\nalpha3 = 4\nmu4 = 0.1\nalpha4 = 5/' \
    tests/data/tiny.ini >"$work/four.ini"
check "four Ogden terms: surfaces" "$BIN/surfgen" -q "$work/four.ini" -o "$work/s.h5"
check "four Ogden terms: mesh" "$BIN/tetmesh" -q --size 12 "$work/s.h5" -o "$work/four.h5"
refused 3 "four Ogden terms" "law 'ogden' of 4 terms, CalculiX takes at most 3" \
    "$export" -p 0.1,0 "$work/four.h5" -o "$out/x.inp"

# Results that are none, or not those of the deck.
refused 3 "no results" "cannot open '$work/none.dat'" "$export" --compare "$work/none.dat" "$work/plain.h5"
echo " displacements (vx,vy,vz) for set NALL and time  0.1000000E+01" >"$work/half.dat"
refused 3 "results of half the way" "at time 1, expected 2" "$export" --compare "$work/half.dat" "$work/plain.h5"
echo " displacements (vx,vy,vz) for set NALL and time  0.2000000E+01" >"$work/other.dat"
echo "         1  1.000000E+00  0.000000E+00  0.000000E+00" >>"$work/other.dat"
refused 3 "results of another mesh" "no displacement of node 2, expected" "$export" --compare "$work/other.dat" "$work/plain.h5"

# Results made from the state: no difference.
results() {
    h5dump -A 0 -y -w 0 -d /node/displacement "$work/plain.h5" | awk '/ DATA {/ { on = 1; next } /}/ { on = 0 }
        on { gsub(/,/, ""); if (NF == 3) print ++n, $0; else for (i = 1; i <= NF; i += 3) print ++n, $i, $(i + 1), $(i + 2) }'
    h5dump -A 0 -y -w 0 -d /tip/U "$work/plain.h5" | awk -v n="$1" '/ DATA {/ { on = 1; next } /}/ { on = 0 }
        on { gsub(/,/, ""); print n + 1, $1, $2, $3; print n + 2, $4, $5, $6 }'
}
nodes=$(sed -n '/^\*NODE, /,/^\*ELEMENT/p' "$work/a.inp" | sed '1d;$d' | wc -l)
{
    echo " displacements (vx,vy,vz) for set NALL and time  0.2000000E+01"
    results $((nodes - 2))
} >"$work/same.dat"
expect 0 "comparison" "$export" --compare "$work/same.dat" "$work/plain.h5"
# h5dump prints six digits
check "no difference" awk -F '\t' 'NR > 1 && !($4 < 1e-5) { bad = 1; print } END { exit bad || NR < 13 }' "$work/out"
finish
