#!/bin/bash
# The dense workspace of a tiny robot: few points by symmetry, beside Gauss values, again without work; misuse.
. tests/lib.sh

dense() {
    make -s -j2 B="$BUILD" workspace RUN="$work/run" "$@"
}

check "dense workspace" dense CASE=tests/data/tiny.ini STEP=0.03
check "9 of 16 points" test "$(cat "$work"/run/workspace/part-*.txt | wc -l)" -eq 9
# a mesh cut at its mirror plane keeps that symmetry; the other one it breaks by less than a thousandth of the area
check "Gauss values beside it" awk -F '|' 'NR == 3 { dense = $4 } NR > 3 { n++; d = $4 / dense - 1; if (d * d > 1e-4) bad = 1 }
    END { exit bad || n != 5 }' "$work/run/workspace/table.md"
check "a valid file" "$BIN/pmcheck" "$work/run/workspace/workspace.h5"
h5ls -r "$work/run/workspace/workspace.h5" >"$work/ls"
check "VTKHDF: points" grep -q '^/VTKHDF/Points *Soft Link {/workspace/x}' "$work/ls"
check "VTKHDF: angle" grep -q '^/VTKHDF/PointData/angle *Soft Link' "$work/ls"
check "VTKHDF: lines" sh -c "h5dump -d /VTKHDF/Types -s 0 -c 1 '$work/run/workspace/workspace.h5' | grep -q '(0): 3\$'"
check "picture" test -s "$work/run/workspace/workspace.png"
check "its axes" grep -q '^# 2T: U1 \[mm\], U3 \[mm\], 0, pointing angle \[degrees\]$' "$work/run/workspace/boundary.dat"
cp "$work/run/workspace/workspace.h5" "$work/first.h5"
check "again" dense CASE=tests/data/tiny.ini STEP=0.03
check "equal bytes" cmp "$work/first.h5" "$work/run/workspace/workspace.h5"
expect 0 "compare" make -s B="$BUILD" compare RUN="$work/run" BASELINE="$work/run"
check "no gain over itself" grep -q ': +0 %$' "$work/out"
expect 2 "compare with nothing" make -s B="$BUILD" compare RUN="$work/run"
printf 'iteration\taccepted\tmeasure\n0\t1\t2\n1\t0\t1\n2\t1\t3\n' >"$work/run/history.tsv"
printf 'it000\tmesh\t90\n' >"$work/run/times.tsv"
cp tests/data/tiny.ini "$work/run/case.ini"
expect 0 "table" make -s B="$BUILD" table RUNS="$work/run"
check "a row" awk -F ' *[|] *' '$2 == "tiny" { exit !(NF == 14 && $4 == 2 && $5 == 3 && $6 == "1 of 2" && $7 == 2 && $8 > 0 && $10 == "-") } END { exit $2 != "tiny" }' "$work/out"
check "what was not run" grep -q '^| 3A1R2T | not run | - ' "$work/out"
sed -i 's/^name = .*/name = 2A0R2T-small/' "$work/run/case.ini"
cp -r "$work/run" "$work/net"
rm "$work/net/history.tsv"
sed -i 's/^name = .*/name = pneunet-2/' "$work/net/workspace/case.ini"
expect 0 "table with a baseline" make -s B="$BUILD" table RUNS="$work/run $work/net"
check "gain and the paper's" grep -q '^| 2A0R2T-small .* | +0 % | 1314.05 mm2 | +291 % |' "$work/out"
check "the baseline" grep -q "^| pneunet-2 | $work/net | - | - | - | - | .* | 336 mm2 | - |" "$work/out"
expect 2 "table of nothing" make -s B="$BUILD" table RUNS="$work/nothing"
rm "$work/run/history.tsv"

# three chambers: another measure of the same case, by its own path of pressures
check "three chambers, 2R" make -s -j2 B="$BUILD" workspace RUN="$work/three" CASE=tests/data/tripod.ini STEP=0.03 MEASURE=2R
check "6 of 25 points" test "$(cat "$work"/three/workspace/part-*.txt | wc -l)" -eq 6
check "both intervals" grep -q '^| dense, twice the interval | ' "$work/three/workspace/table.md"
# the coarse mesh has none of the symmetry, which leaves one edge of six: some hundredths
check "Gauss values beside it" awk -F '|' 'NR == 3 { dense = $4 } NR > 3 { n++; d = $4 / dense - 1; if (d * d > 2.5e-3) bad = 1 }
    END { exit bad || n != 3 }' "$work/three/workspace/table.md"
check "its picture" test -s "$work/three/workspace/workspace.png"
check "its axes" grep -q '^# 2R: n_x, n_y, n_z, pointing angle' "$work/three/workspace/boundary.dat"
expect 2 "areas are not compared with angles" make -s B="$BUILD" compare RUN="$work/three" BASELINE="$work/run"
check "says so" grep -q '^compare: units differ: [0-9.e-]* sr and [0-9.e+]* mm2$' "$work/err"
expect 2 "no design" make -s B="$BUILD" workspace
check "says what it needs" grep -q 'expected CASE=' "$work/err"

"$BIN/wsint" --full --boundary 0.03 tests/data/tiny.ini >"$work/full"
check "without symmetry all 16" test "$(wc -l <"$work/full")" -eq 16
refused 3 "an interval too small" "expected at least 0.0012" "$BIN/wsint" --boundary 0.0001 tests/data/tiny.ini
refused 2 "no interval" "found 0, expected more than 0" "$BIN/wsint" --boundary 0 tests/data/tiny.ini
refused 2 "no points" "expected at least 1" "$BIN/wsint" --points --per-axis 0 tests/data/tiny.ini
refused 3 "samples that are none of the boundary" "at none of the points of the boundary" \
    "$BIN/wsint" --dense "$work/run/workspace/volume-2.h5" -o "$work/output/x.h5"
finish
