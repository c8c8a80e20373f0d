#!/bin/bash
# optimize.sh RUN CASE SETTINGS DESIGN ITERATIONS: walks through the iterations of a run until trstep says converged or stalled, or
# iteration ITERATIONS is done (default: max_iterations of the case). RUN/history.tsv holds one row per trial.
set -eu
run=$1 case=$2 settings=$3 design=$4 last=$5

fail() {
    echo "optimize: $1" >&2
    exit 2
}

[ -n "$run" ] || fail 'no run, expected RUN=run/NAME'
mkdir -p "$run"
if [ -n "$case" ]; then
    [ -r "$case" ] || fail "cannot read '$case'"
    # SETTINGS "section.key=value ..": lines of the case replaced, or added to their section, a new one where there is none.
    awk -v settings="$settings" 'function add(k, part) { for (k in value) { split(k, part, "."); if (part[1] == section) { print part[2] " = " value[k]; delete value[k] } } }
        BEGIN { n = split(settings, list, " "); for (i = 1; i <= n; i++) { split(list[i], kv, "="); value[kv[1]] = kv[2] } }
        /^\[/ { add(); section = $0; gsub(/[][ ]/, "", section) }
        { key = $1; sub(/=.*/, "", key); key = section "." key }
        key in value { $0 = $1 " = " value[key]; delete value[key] } { print }
        END { add(); for (i = 1; i <= n; i++) { split(list[i], kv, "[.=]"); if ((kv[1] "." kv[2]) in value) { print "\n[" (section = kv[1]) "]"; add() } } }' \
        "$case" >"$run/case.new" || { rm -f "$run/case.new"; exit 2; }
    if [ ! -e "$run/case.ini" ]; then
        mv "$run/case.new" "$run/case.ini"
    elif cmp -s "$run/case.new" "$run/case.ini"; then
        rm "$run/case.new"
    else
        rm "$run/case.new"
        fail "'$run' was started with another case or settings, expected that of '$run/case.ini'"
    fi
fi
if [ -n "$design" ]; then
    [ -r "$design" ] || fail "cannot read '$design'"
    if [ ! -e "$run/it000/surf.h5" ]; then
        cp "$design" "$run/start.h5"
    elif ! cmp -s "$design" "$run/start.h5"; then
        fail "'$run' was started from another design than '$design'"
    fi
fi
[ -r "$run/case.ini" ] || fail "'$run' has no case, expected CASE=data/cases/NAME.ini"
"$BIN/wsint" --points "$run/case.ini" >/dev/null || exit
[ -n "$last" ] || last=$(awk -F '[ =]+' '$1 == "max_iterations" { print $2 }' "$run/case.ini")
[ -n "$last" ] || fail "'$run/case.ini' has no max_iterations, expected ITERATIONS=N"

for ((n = 0; n <= 10#$last; n++)); do
    iteration=$(printf 'it%03d' "$n")
    step=$run/$iteration/step.h5
    [ -e "$step" ] || "$MAKE" --no-print-directory RUN="$run" ITER="$iteration" "$step"
    if [ ! "$run/history.tsv" -nt "$step" ] && [ ! -e "$run/$(printf 'it%03d' $((n + 1)))/step.h5" ]; then
        "$BIN/trstep" --history "$step" >"$run/history.new"
        mv "$run/history.new" "$run/history.tsv"
        awk -F '\t' -v it="$iteration" 'END { printf "%s %s: measure %s, ratio %s, radius %s mm, step %s mm, violations %s %s, amplification %s, gap %s mm%s%s\n",
            it, $2 ? "accepted" : "rejected", $3, $6, $7, $10, $8, $9, $13, $14 < 0 ? "wide" : $14, $11 ? sprintf(", renewed, jump %+.2f %%", 100 * $12) : "", $15 == "-" ? "" : ": " $15 }' "$run/history.tsv" >&2
    fi
    verdict=$("$BIN/trstep" --verdict "$step")
    if [ "$verdict" != continue ]; then
        echo "$run: $verdict after $iteration" >&2
        break
    fi
done
