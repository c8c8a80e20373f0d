#!/bin/bash
# workspace.sh RUN CASE STEP SIZE MEASURE RULES: the dense workspace of a design and its Gauss values (workspace.mk).
set -eu
shopt -s inherit_errexit
export LC_ALL=C
run=$1 case=$2 step=$3 size=$4 measure=$5 wanted=$6

fail() {
    echo "workspace: $1" >&2
    exit 2
}

[ -n "$run$case" ] || fail 'no design, expected CASE=data/cases/NAME.ini or RUN=run/NAME'
sign=() other=(${measure:+--measure "$measure"})
if [ -n "$case" ]; then
    [ -r "$case" ] || fail "cannot read '$case'"
    run=${run:-run/$(basename "$case" .ini)${measure:+-$measure}}
    out=$run/workspace
    mkdir -p "$out"
    # another case or size: nothing of the last one serves
    { cmp -s "$case" "$out/case.ini" && cmp -s <(echo "$size") "$out/size"; } ||
        { rm -f "$out"/*; cp "$case" "$out/case.ini"; echo "$size" >"$out/size"; }
    [ -e "$out/surf.h5" ] || "$BIN/surfgen" "$case" -o "$out/surf.h5"
    [ -e "$out/mesh.h5" ] || "$BIN/tetmesh" ${size:+--size "$size"} "$out/surf.h5" -o "$out/mesh.h5"
else
    [ -r "$run/history.tsv" ] || fail "'$run' has no history.tsv, expected RUN=run/NAME of an optimisation"
    case=$run/case.ini
    last=$(awk -F '\t' '$2 == 1 { a = $1 } END { printf "it%03d", a }' "$run/history.tsv")
    out=$run/workspace
    mkdir -p "$out"
    # another design: nothing of the last one serves
    cmp -s "$run/$last/mesh.h5" "$out/mesh.h5" || { rm -f "$out"/*; cp "$run/$last/mesh.h5" "$out/mesh.h5"; }
    sign=(--sign-from "$run/it000/work.h5")
fi

# list NAME: from stdin, kept where it is the same.
list() {
    cat >"$out/$1.new"
    if cmp -s "$out/$1.new" "$out/$1.txt"; then rm "$out/$1.new"; else mv "$out/$1.new" "$out/$1.txt"; fi
}

"$BIN/wsint" "${other[@]}" --boundary "$step" "$case" >"$out/boundary"
points=$(wc -l <"$out/boundary")
parts=$(((points + 63) / 64))
parts=$((parts < 2 ? 2 : parts))
each=$(((points + parts - 1) / parts))
paths=()
for ((k = 0; k * each < points; k++)); do
    name=part-$(printf %02d $k)
    sed -n "$((k * each + 1)),$(((k + 1) * each))p" "$out/boundary" | list "$name"
    paths+=("$out/$name.h5")
done
rules=() counts=() # points that have a weight
for rule in $wanted; do
    "$BIN/wsint" "${other[@]}" --points --form "${rule%-*}" --per-axis "${rule#*-}" "$case" >"$out/points" 2>/dev/null || continue
    awk -F '\t' 'NR > 1 { for (i = 6; i <= NF; i++) printf "%s%s", $i, i < NF ? " " : "\n" }' "$out/points" | list "$rule"
    rules+=("$rule")
    counts+=("$(awk -F '\t' 'NR > 1 && $3 != 0 { n++ } END { print n }' "$out/points")")
done
gauss=("${rules[@]/#/$out/}")
# shellcheck disable=SC2086 # JOBS is empty or one option
"$MAKE" --no-print-directory $JOBS WORKSPACE="$out" "${paths[@]}" "${gauss[@]/%/.h5}"

"$BIN/wsint" "${other[@]}" --dense "${sign[@]}" "${paths[@]}" -o "$out/workspace.h5"
"$BIN/wsint" --show "$out/workspace.h5" >"$out/shown"
for rule in "${rules[@]}"; do
    "$BIN/wsint" -q "${other[@]}" --form "${rule%-*}" --per-axis "${rule#*-}" "${sign[@]}" "$out/$rule.h5" -o "$out/$rule-work.h5"
    "$BIN/wsint" --show "$out/$rule-work.h5" >"$out/shown-$rule"
done
{
    awk -v points="$points" '{ printf "| rule | points | %s [%s] | against dense |\n|---|---|---|---|\n| dense | %s | %s | |\n", $1, $4, points, $3
        if (match($0, /twice the interval [^:]*/)) { c = substr($0, RSTART + 19, RLENGTH - 19)
            printf "| dense, twice the interval | | %s | %+.2g %% |\n", c, 100 * (c / $3 - 1) } }' "$out/shown"
    for ((k = 0; k < ${#rules[@]}; k++)); do
        rule=${rules[k]}
        awk -v form="${rule%-*}" -v m="${rule#*-}" -v points="${counts[k]}" 'NR == FNR { dense = $3; next } { printf "| Gauss, %s form, m = %s | %d | %s | %+.2f %% |\n",
            form, m, points, $3, 100 * ($3 / dense - 1) }' "$out/shown" "$out/shown-$rule"
    done
} >"$out/table.md"
cat "$out/table.md" "$out/shown"
measure=$(awk '{ print $1 }' "$out/shown")
"$BIN/pmplot" boundary "$out/workspace.h5" >"$out/boundary.dat"
IFS=, read -ra labels < <(sed -n '1s/^# [^:]*: //p' "$out/boundary.dat")
gnuplot -c pipelines/pictures/dense.gp "$out/boundary.dat" "$measure" "$out/workspace.png" "${labels[@]# }"
echo "$out/workspace.h5 $out/workspace.png"
