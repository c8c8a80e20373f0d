#!/bin/bash
# Gauss sets, full and reduced by symmetry, of a body whose mesh has the symmetry and of one whose mesh has not.
. tests/lib.sh

rows=("$work/sets/tiny-2T-boundary-2.row" "$work/sets/tripod-3T-volume-2.row")
check "two rows" make -s B="$BUILD" SETS_RUN="$work/sets" "${rows[@]}"
# half of the mesh is the image of the other half: what the solver leaves, 1e-8 of the load
check "mirrors: 4 of 8 points" awk -F '\t' '{ d = $8 / $6 - 1 } END { exit !(NR == 1 && $5 == 8 && $7 == 4 && d * d < 1e-12 && $6 > 0) }' "${rows[0]}"
# a third of a turn maps no tetrahedron to another: the discretisation, some hundredths on this mesh
check "thirds of a turn: 4 of 8 points" awk -F '\t' '{ d = $8 / $6 - 1 } END { exit !(NR == 1 && $5 == 8 && $7 == 4 && d * d < 2.5e-3 && $6 > 0) }' "${rows[1]}"
check "a table" env BIN="$BIN" pipelines/sets.sh table "${rows[@]}"
check "of two lines" test "$(grep -c '^| t' "$work/check")" -eq 2
finish
