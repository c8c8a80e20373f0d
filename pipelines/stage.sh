#!/bin/bash
# stage.sh RUN ITERATION STAGE COMMAND..: runs one stage, says how long it took, adds a row to RUN/times.tsv.
set -u
run=$1 iteration=$2 stage=$3
shift 3
start=$EPOCHREALTIME
"$@" || exit
seconds=$(awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }')
printf '%s %-12s %6s s\n' "$iteration" "$stage" "$seconds" >&2
printf '%s\t%s\t%s\n' "$iteration" "$stage" "$seconds" >>"$run/times.tsv"
