#!/bin/bash
# reconstruct.sh calls METHOD N FIRST.h5 TABLE | report TABLE..
# The measurements of reconstruct.mk. A refusal ends the table with its reason as a comment.
set -eu
. pipelines/measure.sh

calls() {
    local method=$1 n=$2 first=$3 table=$4 folder=${4%.tsv} i seconds
    rm -rf "$folder"
    mkdir -p "$folder"
    log=$folder/log
    {
        printf 'call\tseconds\tpoints\tvolume\tmean\tmax\tcv\tnear_cv\n'
        printf '0\t0\t%s\n' "$("$LIB/surface_drift" "$first" "$first" 1)"
    } >"$table.part"
    cp "$first" "$folder/now.h5"
    for ((i = 1; i <= n; i++)); do
        if ! seconds=$(cpu "$BIN/surfremesh" --method "$method" --points 477 "$folder/now.h5" -o "$folder/next.h5"); then
            echo "# call $i: $(tail -n 1 "$log")" >>"$table.part"
            break
        fi
        mv "$folder/next.h5" "$folder/now.h5"
        printf '%d\t%s\t%s\n' "$i" "$seconds" "$("$LIB/surface_drift" "$first" "$folder/now.h5" 1)" >>"$table.part"
    done
    mv "$table.part" "$table"
}

report() {
    local table
    for table; do
        echo "$(basename "$table" .tsv):"
        awk -F '\t' '/^#/ { print "  " $0; next }
            $1 ~ /^(0|1|5|12|40)$/ { last = $1; printf "  after %2d: %d control points, volume %.4f, distance mean %.3f max %.3f mm, variation of the edges %.3f, of nearest neighbours %.3f\n", $1, $3, $4, $5, $6, $7, $8 }
            NR > 2 { s += $2; n++ }
            END { if (n) printf "  %.2f CPU s a call (two chambers and the exterior judged)\n", s / n }' "$table"
    done
}

"$@"
