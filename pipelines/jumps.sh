#!/bin/bash
# jumps.sh RUN: the jumps of the measure over the renewals of a run. Each renewal is done once more with the control points it
# found, meshed anew and solved: from the last accepted mesh to that the mesh alone changes, from there on the control points
# and with them the mesh.
set -eu
run=$1
. pipelines/measure.sh

[ -r "$run/history.tsv" ] || { echo "jumps: '$run' has no history.tsv, expected RUN=run/NAME of an optimisation" >&2; exit 2; }
printf '%9s %12s %12s %12s %10s %16s %8s\n' iteration before 'mesh anew' renewed 'mesh %' 'control points %' 'all %'
awk -F '\t' 'NR > 1 && $11 > 0 { print $1, before, $3, $11 } $2 == 1 { before = $3 }' "$run/history.tsv" | while read -r n before renewed kind; do
    iteration=$(printf 'it%03d' "$n") anew=$renewed
    if [ "$kind" -eq 2 ]; then
        "$MAKE" --no-print-directory RUN="$run" ITER="$iteration" "$run/$iteration/anew.h5" </dev/null
        anew=$(item /measure/value "$run/$iteration/anew.h5")
    fi
    awk -v n="$n" -v a="$before" -v b="$anew" -v c="$renewed" 'BEGIN {
        printf "%9d %12.6g %12.6g %12.6g %+10.2f %+16.2f %+8.2f\n", n, a, b, c, 100 * (b / a - 1), 100 * (c / b - 1), 100 * (c / a - 1) }'
done
