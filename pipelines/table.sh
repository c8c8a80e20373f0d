#!/bin/bash
# table.sh table [RUN..] | compare RUN BASELINE
# table: every case with what the paper reports, beside it its runs or that there is none. compare: the gain of a dense value.
set -eu
shopt -s inherit_errexit
export LC_ALL=C

# NAME, value and unit of the dense workspace, gain over the Pneu-Nets, further.
paper='2A0R2T|1314.05 mm2|+291 %|1359.28 mm2 by Gauss points, 140 iterations, 628 min
3A0R3T|89364.4 mm3|+828 %|200 iterations, 1841 min
3A2R0T|4.05 sr|+158 %|77.7 / 74.3 / 66.1 degrees, 175 iterations, 1432 min
3A3R0T|0.0299|-|40.1 / 28.7 degrees, twist 53.3, 180 iterations, 1785 min
3A1R2T|-|-|more than 50 degrees over most positions, 103 iterations, 1164 min
6A3R3T|-|-|-
pneunet-2|336 mm2|-|from the gain
pneunet-3|9630 mm3|-|from the gain
pneunet-3 2R|1.57 sr|-|from the gain'

# shown RUN: the line about its dense workspace; nothing where there is none.
shown() {
    [ ! -e "$1/workspace/workspace.h5" ] || "$BIN/wsint" --show "$1/workspace/workspace.h5"
}

# dense RUN: its value and unit, none of a pure number.
dense() {
    shown "$1" | sed 's/^[^=]*= //; s/ (dense.*//; s/ 1$//'
}

# title RUN: the name of its case, with the measure where the workspace has another one.
title() {
    local case=$1/workspace/case.ini
    [ ! -e "$1/history.tsv" ] || case=$1/case.ini
    [ -r "$case" ] || { echo "table: '$1' has no '$case', expected what make optimize or make workspace leave" >&2; exit 2; }
    shown "$1" | awk -F '[ =]+' 'NR == FNR { if ($1 == "name") name = $2; if ($1 == "measure") own = $2; next } { measure = $1 }
        END { print name (measure != "" && measure != own ? " " measure : "") }' "$case" -
}

# gain "VALUE UNIT" "OTHER UNIT"
gain() {
    [ "${1#"${1%% *}"}" = "${2#"${2%% *}"}" ] || { echo "compare: units differ: $1 and $2" >&2; exit 3; }
    awk -v a="${1%% *}" -v b="${2%% *}" 'BEGIN { printf "%+.0f %%\n", 100 * (a / b - 1) }'
}

# history RUN: first and last value, steps, minutes.
history() {
    [ -e "$1/history.tsv" ] || { echo '- | - | - | -'; return; }
    awk -F '\t' 'NR == FNR { if (FNR > 1 && $2 == 1) { if (!n++) first = $3; last = $3 } trials = FNR - 2; next } { seconds += $3 }
        END { printf "%s | %s | %d of %d | %.0f\n", first, last, n - 1, trials, seconds / 60 }' "$1/history.tsv" "$1/times.tsv"
}

declare -A baselines=() # run of the Pneu-Nets by case

# row RUN NAME "WHAT THE PAPER SAYS"
row() {
    local value angles over=- baseline=${baselines[${2%%-*}]:-}
    value=$(dense "$1")
    angles=$(shown "$1" | sed 's/.*pointing angle //; s/ degrees$//')
    [ -z "$value" ] || [ -z "$baseline" ] || over=$(gain "$value" "$(dense "$baseline")")
    echo "| $2 | $1 | $(history "$1") | ${value:--} | ${angles:--} | $over | $3 |"
}

table() {
    local run name said
    declare -A titles=() listed=() named=()
    baselines=()
    for run in "$@"; do
        [ -e "$run/history.tsv" ] || [ -e "$run/workspace/workspace.h5" ] ||
            { echo "table: '$run' has neither a history.tsv nor a dense workspace, expected RUNS='run/NAME ..'" >&2; exit 2; }
        titles[$run]=$(title "$run")
        case ${titles[$run]} in
        pneunet-2) baselines[2A0R2T]=$run ;;
        pneunet-3) baselines[3A0R3T]=$run ;;
        'pneunet-3 2R') baselines[3A2R0T]=$run ;;
        esac
    done
    echo '| case | run | first, Gauss | last, Gauss | accepted | min of computing | dense | angles [degrees] | over the baseline | paper: dense | over the baseline | further |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
    while IFS='|' read -r name said; do
        said=${said//|/ | }
        for run in "$@"; do
            [ "${titles[$run]}" = "$name" ] || [ "${titles[$run]%%-*}" = "$name" ] || continue
            row "$run" "${titles[$run]}" "$said"
            listed[$run]=1 named[$name]=1
        done
        [ -n "${named[$name]:-}" ] || echo "| $name | not run | - | - | - | - | - | - | - | $said |"
    done <<<"$paper"
    for run in "$@"; do
        [ -n "${listed[$run]:-}" ] || row "$run" "${titles[$run]}" '- | - | -'
    done
}

case $1 in
table)
    shift
    table "$@"
    ;;
compare)
    for run in "${2:-}" "${3:-}"; do
        [ -n "$run" ] && [ -e "$run/workspace/workspace.h5" ] ||
            { echo "compare: '$run' has no dense workspace, expected RUN and BASELINE after 'make workspace'" >&2; exit 2; }
    done
    of=$(dense "$2") over=$(dense "$3")
    ratio=$(gain "$of" "$over")
    echo "$2 $of, $3 $over: $ratio"
    ;;
esac
