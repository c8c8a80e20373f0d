#!/bin/bash
# invkin: what it refuses, equal bytes, guesses.
. tests/lib.sh

check "surfgen" "$BIN/surfgen" tests/data/tiny.ini -o "$work/surf.h5"
check "tetmesh" "$BIN/tetmesh" -q "$work/surf.h5" -o "$work/mesh.h5"
ask() {
    "$BIN/invkin" "$@" "$work/mesh.h5" -o "$work/output/x.h5"
}
refused 2 "no target" "exactly one of --target and --targets" ask
refused 2 "too few components" "option --target: found 1 components, expected 2" ask --target 0.1
refused 2 "more than six" "option '?--target" ask --target 1,2,3,4,5,6,7
refused 2 "dofs out of order" "option --dofs: found '3,1', expected ascending numbers" ask --dofs 3,1 --target 0,0
refused 2 "no such dof" "option --dofs: found '7'" ask --dofs 7 --target 0
refused 2 "bounds" "option --bounds: found '0.1,0', expected LOW,HIGH" ask --bounds 0.1,0 --target 0,0
refused 2 "tolerance" "option --tolerance: found 0, expected more than 0" ask --tolerance 0 --target 0,0
refused 2 "most" "option --most: found 0, expected 1 to 10000" ask --most 0 --target 0,0
refused 2 "element" "nonsense" ask --element nonsense --target 0,0
refused 3 "no list" "cannot open '.*none.txt'" ask --targets "$work/none.txt"
printf '0 0.1\n0 0.1 0.2\n' >"$work/bad.txt"
refused 3 "bad list" "bad.txt': line 2 has 3 components, expected 2" ask --targets "$work/bad.txt"
refused 4 "out of reach" "the target is not reached \(at-bound\): found 4[0-9.]* mm and 0 degrees off at pressures 0.12,0.12, bounds p1=high,p2=high" \
    ask --target 0,50
expect 0 "recorded" "$BIN/invkin" --record-failure --target 0,50 "$work/mesh.h5" -o "$work/far.h5"
check "it warns" grep -q "1 of 1 targets are not reached" "$work/err"
sed '/^\[workspace\]/,/^form/d' tests/data/tiny.ini >"$work/plain.ini"
check "a case without workspace" sh -c "'$BIN/surfgen' '$work/plain.ini' -o '$work/plain-surf.h5' && '$BIN/tetmesh' -q '$work/plain-surf.h5' -o '$work/plain.h5'"
refused 2 "needs --dofs" "option --dofs: none, and the case of '.*plain.h5' has no workspace" \
    "$BIN/invkin" --target 0,0 "$work/plain.h5" -o "$work/output/x.h5"

printf '# two\n0.05, 0.2\n-0.1 0.15\n' >"$work/targets.txt"
list() {
    "$BIN/invkin" --tolerance 1e-4 --targets "$work/targets.txt" "$work/mesh.h5" "$@"
}
expect 0 "a list" list --table -o "$work/inv.h5"
check "reached" test "$(grep -c reached "$work/out")" = 2
mv "$work/inv.h5" "$work/first.h5"
check "again" list --table -o "$work/inv.h5"
check "equal bytes" cmp "$work/first.h5" "$work/inv.h5"
check "pmplot takes it" "$BIN/pmplot" path "$work/inv.h5"
check "its first input but the mesh is the list" sh -c "h5dump -a /inputs '$work/inv.h5' | grep -q 'file targets.txt crc32'"
# The second target starts where the first ended.
pressure=$(awk -F '\t' '$1 == 1 { print $3 "," $4 }' "$work/out")
check "the state of the first target" "$BIN/fesolve" --pressure "$pressure" "$work/mesh.h5" -o "$work/near.h5"
check "another state" "$BIN/fesolve" --pressure 0,0.01 "$work/mesh.h5" -o "$work/other.h5"
expect 0 "from the nearest of two states" "$BIN/invkin" --table --tolerance 1e-4 --target 0.05,0.2 --guess "$work/other.h5" \
    --guess "$work/near.h5" "$work/mesh.h5" -o "$work/warm.h5"
check "nothing is left to do" test "$(awk -F '\t' 'NR == 2 { print $2, $10, $11 }' "$work/out")" = "reached 0 1"
finish
