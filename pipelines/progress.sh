#!/bin/bash
# progress.sh OUT RUN..: accepted measures of runs against iterations and computing time, as table and picture.
set -eu
out=$1
shift
[ $# -gt 0 ] || { echo "progress: no runs, expected RUNS='run/A run/B'" >&2; exit 2; }
mkdir -p "$out"
names=
for run in "$@"; do
    [ -r "$run/history.tsv" ] || { echo "progress: '$run' has no history.tsv, expected a run of an optimisation" >&2; exit 2; }
    name=$(basename "$run")
    names="$names $name"
    # iteration, minutes of all stages up to it, best accepted measure so far
    awk -F '\t' -v OFS='\t' 'FNR == NR { i = substr($1, 3) + 0; if (i > most) most = i; t[i] += $3; next }
        FNR == 1 { for (i = 1; i <= most; i++) t[i] += t[i - 1]; next } $2 == 1 { print $1, t[$1] / 60, $3 }' "$run/times.tsv" "$run/history.tsv" >"$out/$name"
    awk -F '\t' -v name="$name" '{ i = $1; t = $2; v = $3 } END { printf "%-24s %4d iterations %7.1f min of computing  measure %g\n", name, i, t, v }' "$out/$name"
done
gnuplot -c pipelines/pictures/progress.gp "$out" "$out/progress.png" "${names# }"
echo "$out/progress.png"
