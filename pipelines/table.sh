#!/bin/bash
# table.sh table RUN.. | compare RUN BASELINE
# table: a Markdown row for every run, beside what the paper reports for its case. compare: the gain of a dense value.
set -eu
export LC_ALL=C

# dense RUN: value and unit of its dense workspace; nothing where there is none.
dense() {
    [ ! -e "$1/workspace/workspace.h5" ] || "$BIN/wsint" --show "$1/workspace/workspace.h5" | awk '{ print $3, $4 }'
}

# paper CASE: two cells with what the paper reports.
paper() {
    case $1 in
    2A0R2T*) echo '1314.05 mm2 | 1359.28 mm2, 140 iterations, 628 min' ;;
    3A0R3T*) echo '89364.4 mm3 | 200 iterations, 1841 min' ;;
    3A2R0T*) echo '4.05 sr | 77.7 / 74.3 / 66.1 degrees, 175 iterations, 1432 min' ;;
    3A3R0T*) echo '0.0299 | 40.1 / 28.7 degrees, twist 53.3, 180 iterations, 1785 min' ;;
    3A1R2T*) echo ' | more than 50 degrees over most positions, 103 iterations, 1164 min' ;;
    *) echo ' | ' ;;
    esac
}

angles() {
    [ ! -e "$1/workspace/workspace.h5" ] ||
        "$BIN/wsint" --show "$1/workspace/workspace.h5" | sed 's/.*pointing angle //; s/ degrees$//'
}

row() {
    local run=$1 name
    name=$(awk -F '[ =]+' '$1 == "name" { print $2; exit }' "$run/case.ini")
    awk -F '\t' -v run="$run" -v name="$name" -v dense="$(dense "$run")" -v angles="$(angles "$run")" -v paper="$(paper "$name")" \
        'NR == FNR { if (FNR > 1 && $2 == 1) { if (!n++) first = $3; last = $3 } trials = FNR - 2; next } { seconds += $3 }
        END { printf "| %s | %s | %s | %s | %s | %s | %d of %d | %.0f | %s |\n", run, name, first, last, dense, angles, n - 1, trials, seconds / 60, paper }' \
        "$run/history.tsv" "$run/times.tsv"
}

case $1 in
table)
    shift
    [ $# -gt 0 ] || { echo "table: no finished runs, expected RUNS='run/NAME ..' with a history.tsv" >&2; exit 2; }
    echo '| run | case | first, Gauss | last, Gauss | last, dense | angles [degrees] | accepted | min of computing | paper, dense | paper, further |'
    echo '|---|---|---|---|---|---|---|---|---|---|'
    for run in "$@"; do row "$run"; done
    ;;
compare)
    for run in "${2:-}" "${3:-}"; do
        [ -n "$run" ] && [ -e "$run/workspace/workspace.h5" ] ||
            { echo "compare: '$run' has no dense workspace, expected RUN and BASELINE after 'make workspace'" >&2; exit 2; }
    done
    echo "$(dense "$2") $(dense "$3")" | awk -v run="$2" -v baseline="$3" '{
        if ($2 != $4) { print "compare: units differ: " $2 " and " $4 > "/dev/stderr"; exit 3 }
        printf "%s %s %s, %s %s %s: %+.0f %%\n", run, $1, $2, baseline, $3, $4, 100 * ($1 / $3 - 1) }'
    ;;
esac
