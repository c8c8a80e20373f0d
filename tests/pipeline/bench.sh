#!/bin/bash
# make bench on a tiny robot: a row per measurement, the chart, nothing twice.
# shellcheck disable=SC2016,SC2317 # awk programs; functions that check calls
. tests/lib.sh

bench() {
    make -s B="$BUILD" DEPS=no bench-results BENCH_RUN="$work/bench" BENCH_CASE=tests/data/tiny.ini BENCH_PRESSURE=0.1,0 \
        BENCH_COMPARE=12 BENCH_SIZES='12 8' BENCH_REPEATS=1 >"$work/report" 2>"$work/err"
}
check "runs" bench
# Two sizes of the default element, the plain one and CalculiX once; poses alike.
check "table" awk -F '\t' 'NR > 1 { n[$1]++; bad += NF != 17 || ($1 ~ /^fesolve/ && !($17 > 0)) || ($1 != "DGEMM" && (!($5 > 0) || !($2 > 1000))) || ($1 == "DGEMM" && !($17 > 0)) }
    $1 == "fesolve tet10" { u = $7 } $1 ~ /^CalculiX/ { v = $7 }
    END { exit bad || n["fesolve tet10-blend"] != 2 || n["fesolve tet10"] != 1 || n["CalculiX C3D10"] != 1 || n["DGEMM"] != 1 || (u / v - 1) ^ 2 > 1e-4 }' \
    "$work/bench/bench.tsv"
check "chart" sh -c "head -c 4 '$work/bench/bench.png' | grep -q PNG"
check "says how much faster" grep -Eq '^[0-9]+ unknowns: fesolve [0-9.]+ CPU s, CalculiX [0-9.]+ .* times$' "$work/report"
touch "$work/before"
check "again" bench
check "nothing is made twice" test -z "$(find "$work/bench" -newer "$work/before")"
finish
