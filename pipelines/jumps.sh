#!/bin/bash
# jumps.sh RUN: the jumps of the measure over the renewals of a run. Where control points changed, the renewed design is solved
# once more on the last accepted mesh, carried to it: from that design to this the control points alone change, from there on
# the mesh. Where the mesh cannot be carried, its part and theirs are left out and tetmesh says why.
set -eu
run=$1
. pipelines/measure.sh

[ -r "$run/history.tsv" ] || { echo "jumps: '$run' has no history.tsv, expected RUN=run/NAME of an optimisation" >&2; exit 2; }
printf '%9s %12s %12s %12s %16s %8s %8s\n' iteration before 'mesh kept' renewed 'control points %' 'mesh %' 'all %'
awk -F '\t' 'NR > 1 && $11 > 0 { print $1, before, $3, $11 } $2 == 1 { before = $3 }' "$run/history.tsv" | while read -r n before renewed kind; do
    iteration=$(printf 'it%03d' "$n") kept=$before
    if [ "$kind" -eq 2 ]; then
        "$MAKE" --no-print-directory RUN="$run" ITER="$iteration" "$run/$iteration/kept.h5" </dev/null
        kept=$(item /measure/value "$run/$iteration/kept.h5" 2>/dev/null) # none where that failed
    fi
    awk -v n="$n" -v a="$before" -v b="$kept" -v c="$renewed" '
        function change(from, to) { return b + 0 > 0 ? sprintf("%+.2f", 100 * (to / from - 1)) : "-" }
        BEGIN { printf "%9d %12.6g %12s %12.6g %16s %8s %+8.2f\n", n, a, (b + 0 > 0 ? sprintf("%.6g", b) : "-"), c, change(a, b), change(b, c), 100 * (c / a - 1) }'
done
