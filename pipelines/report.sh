#!/bin/bash
# report.sh RUN: the history of a run, and the measure of the first and the last accepted design by both forms; their
# difference is the error of the quadrature.
set -eu
run=$1

[ -r "$run/history.tsv" ] || { echo "report: '$run' has no history.tsv, expected RUN=run/NAME of an optimisation" >&2; exit 2; }
last=$(awk -F '\t' '$2 == 1 { a = $1 } END { printf "it%03d", a }' "$run/history.tsv")
for iteration in it000 "$last"; do
    "$MAKE" --no-print-directory RUN="$run" ITER="$iteration" "$run/$iteration/both.h5"
done
awk -F '\t' 'NR == 1 { printf "%9s %9s %12s %8s %9s %9s %9s  %s\n", "iteration", "accepted", "measure", "ratio", "radius mm", "step mm", "wall lack", "reason" }
    NR > 1 { printf "%9d %9s %12s %8s %9s %9s %9s  %s\n", $1, $2 ? "yes" : "no", $3, $6, $7, $10, $9, ($11 ? sprintf("renewed, jump %+.2f %% ", 100 * $12) : "") ($15 == "-" ? "" : $15) }' "$run/history.tsv"
echo
for iteration in it000 "$last"; do
    "$BIN/wsint" --show "$run/$iteration/both.h5" | sed "s/^/$iteration  /"
done
awk -F '\t' 'NR == 2 { a = $3 } NR > 1 && $2 == 1 { b = $3 } END { printf "gain   %.1f %%\n", 100 * (b / a - 1) }' "$run/history.tsv"
awk -F '\t' '{ t += $3; n++ } END { printf "stages %d, %.0f s of computing\n", n, t }' "$run/times.tsv"
