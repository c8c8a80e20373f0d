#!/bin/bash
# sets.sh mesh CASE SIZE MESH.h5 | row BODY-MEASURE-FORM-M.row | table ROW..
# The measurements of sets.mk. A row: body, measure, form, m; points and value of the full set, of the reduced one.
set -eu
shopt -s inherit_errexit
. pipelines/measure.sh

# evaluate BASE MESH CASE [--full]: points (without the guard) and value of one Gauss set.
evaluate() {
    local base=$1 mesh=$2 case=$3
    shift 3
    "$BIN/wsint" --points "$@" "$case" >"$base.set"
    awk -F '\t' 'NR > 1 { for (i = 6; i <= NF; i++) printf "%s%s", $i, i < NF ? " " : "\n" }' "$base.set" >"$base.txt"
    "$BIN/fesolve" -q --path "$base.txt" "$mesh" -o "$base.h5"
    "$BIN/wsint" -q "$@" "$base.h5" -o "$base-work.h5"
    printf '%d\t%s\n' "$(awk -F '\t' 'NR > 1 && $3 != 0 { n++ } END { print n }' "$base.set")" "$(item /measure/value "$base-work.h5")"
}

row() {
    local name folder body measure form m rule
    name=$(basename "$1" .row)
    folder=$(dirname "$1")
    IFS=- read -r body measure form m <<<"$name"
    rule=(--measure "$measure" --form "$form" --per-axis "$m")
    printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$body" "$measure" "$form" "$m" \
        "$(evaluate "$folder/$name-full" "$folder/$body.h5" "tests/data/$body.ini" "${rule[@]}" --full)" \
        "$(evaluate "$folder/$name" "$folder/$body.h5" "tests/data/$body.ini" "${rule[@]}")" >"$1.part"
    mv "$1.part" "$1"
    rm "$folder/$name"*.h5
}

# Every measure against its finest full set, the last one.
table() {
    echo '| body | measure | form | m | points, full | value | against the finest | points, reduced | value | against the full set |'
    echo '|---|---|---|---|---|---|---|---|---|---|'
    cat "$@" | awk -F '\t' '{ line[NR] = $0; finest[$1, $2] = $6 }
        END { for (i = 1; i <= NR; i++) { split(line[i], v, "\t")
            printf "| %s | %s | %s | %s | %s | %.6g | %+.2g %% | %s | %.6g | %+.2g %% |\n", v[1], v[2], v[3], v[4], v[5], v[6],
                100 * (v[6] / finest[v[1], v[2]] - 1), v[7], v[8], 100 * (v[8] / v[6] - 1) } }'
}

case $1 in
mesh)
    "$BIN/surfgen" -q "$2" -o "${4%.h5}-surf.h5"
    "$BIN/tetmesh" -q ${3:+--size "$3"} "${4%.h5}-surf.h5" -o "$4"
    ;;
row) row "$2" ;;
table)
    shift
    table "$@"
    ;;
esac
