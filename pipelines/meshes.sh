#!/bin/bash
# meshes.sh RUN CASE SIZES: the measure of one design on meshes of several SIZE or SIZE/CREST: the last accepted design of a
# run, or the first one of a case. Each mesh starts from the states of the one before. Table on standard output, files in RUN/meshes/.
set -eu
shopt -s inherit_errexit
export LC_ALL=C
run=$1 case=$2 sizes=$3

fail() {
    echo "meshes: $1" >&2
    exit 2
}

[ -n "$run$case" ] || fail 'no design, expected RUN=run/NAME or CASE=data/cases/NAME.ini'
run=${run:-run/$(basename "$case" .ini)}
out=$run/meshes
mkdir -p "$out"
if [ -n "$case" ]; then
    "$BIN/surfgen" "$case" -o "$out/surf.h5"
else
    [ -r "$run/history.tsv" ] || fail "'$run' has no history.tsv, expected RUN=run/NAME of an optimisation"
    case=$run/case.ini
    steps=("$run"/it*/step.h5)
    "$BIN/surfgen" --design "${steps[-1]}" "$case" -o "$out/surf.h5"
fi
points=$("$BIN/wsint" --points "$case" | awk 'NR > 1 { print $1 }')
. pipelines/measure.sh
log=$out/log
: >"$log"
printf '| size mm | crest | tetrahedra | unknowns | mid-side nodes damped by up to | measure | CPU s |\n|--|--|--|--|--|--|--|\n'
before=
for entry in $sizes; do
    size=${entry%/*} crest=${entry#"$size"} name=${entry/\//c}
    crest=${crest#/}
    mesh=$out/mesh-$name.h5
    time=$(cpu "$BIN/tetmesh" --size "$size" ${crest:+--crest "$crest"} "$out/surf.h5" -o "$mesh")
    for g in $points; do
        time="$time $(cpu "$BIN/fesolve" --load "$g" ${before:+--guess "$out/state-$before-$g.h5"} "$mesh" -o "$out/state-$name-$g.h5")"
    done
    "$BIN/wsint" "$out/state-$name-"[0-9]*.h5 -o "$out/work-$name.h5"
    printf '| %s | %s | %d | %d | %.2f | %.6g %s | %.1f |\n' "$size" "${crest:-of the case}" "$(tetrahedra "$mesh")" \
        "$(item /solve/unknowns "$out/state-$name-0.h5")" "$(item /mesh/max_damping "$mesh")" "$(item /measure/value "$out/work-$name.h5")" \
        "$("$BIN/wsint" --show "$out/work-$name.h5" | awk '{ print $4 }')" "$(awk -v t="$time" 'BEGIN { n = split(t, a, " "); for (i = 1; i <= n; i++) s += a[i]; print s }')"
    before=$name
done
