#!/bin/bash
# bench.sh fesolve MESH.h5 ELEMENT ROW | calculix MESH.h5 JOB.dat | compare STATE.h5 JOB.dat ROW | dgemm ROW | table ROW.. | report TABLE
# The measurements of bench.mk: CPU seconds (user and system) of one thread, from zero to PRESSURE. A row: name, unknowns,
# elements, factorisations (CalculiX: iterations, each factors), CPU seconds, of them those until CalculiX would have
# stopped by itself, the pose, for CalculiX its distance from fesolve's, for fesolve the entries of the factor, the
# operations of a factorisation in 1e9, and its rate in 1e9/s, of the CPU seconds in factorisations.
set -eu
. pipelines/measure.sh

measure_fesolve() {
    local mesh=$1 element=$2 row=$3 state=${3%.row}.h5 log=${3%.row}.log seconds first unknowns factorisations factor i
    : >"$log"
    first=$(cpu "$BIN/fesolve" -v --element "$element" --pressure "$PRESSURE" "$mesh" -o "$state")
    seconds=$first
    if awk -v s="$first" 'BEGIN { exit !(s < 20) }'; then
        seconds=$({
            echo "$first"
            for ((i = 1; i < REPEATS; i++)); do
                cpu "$BIN/fesolve" -v --element "$element" --pressure "$PRESSURE" "$mesh" -o "$state"
            done
        } | sort -n | awk '{ s[NR] = $1 } END { print s[int((NR + 1) / 2)] }')
    fi
    unknowns=$(sed -n 's/^fesolve: \([0-9]*\) unknowns.*/\1/p' "$log" | tail -n 1)
    factorisations=$(item /solve/factorisations "$state")
    factor=$(awk '/^fesolve: factor: / { entries = $3; flops = $5; rate = $11 }
        END { printf "%.3g\t%.3g\t%s", entries, flops / 1e9, rate }' "$log")
    printf 'fesolve %s\t%s\t%s\t%s\t%s\t%s\t%s\t-\t-\t%s\n' "$element" "$unknowns" "$(tetrahedra "$mesh")" \
        "$factorisations" "$seconds" "$seconds" "$(item /tip/U "$state")" "$factor" >"$row.part"
    mv "$row.part" "$row"
}

# In a folder of another name until it is done: a killed run leaves no results.
measure_calculix() {
    local mesh=$1 folder part log
    folder=$(dirname "$2")
    part=$folder.part
    rm -rf "$folder" "$part"
    mkdir -p "$part"
    log=$part/log
    "$BIN/meshexport" --pressure "$PRESSURE" "$mesh" -o "$part/job.inp"
    echo "bench: CalculiX at work, log: $log" >&2
    cpu env -C "$part" ccx job >"$part/cpu"
    mv "$part" "$folder"
}

# Columns of job.sta: step, increment, attempt, iterations.
write_comparison() {
    local state=$1 dat=$2 row=$3 folder
    folder=$(dirname "$dat")
    "$BIN/meshexport" --compare "$dat" "$state" >"$folder/compare.tsv"
    awk -v OFS='\t' -v seconds="$(cat "$folder/cpu")" -v first="$(cat "${row%/*}/tet10-${folder##*-}.row")" '
        FILENAME ~ /sta$/ && $1 ~ /^[12]$/ { all += $4; load += $1 == 1 ? $4 : 0 }
        FILENAME ~ /tsv$/ { there[$1] = $3; off[$1] = $4 }
        END {
            split(first, f, "\t")
            print "CalculiX C3D10", f[2], f[3], all, seconds, sprintf("%.2f", seconds * load / all), there["U1"], there["U2"], there["U3"],
                there["U4"], there["U5"], there["U6"], off["translation"], off["rotation"], "-", "-", "-"
        }' "$folder/job.sta" "$folder/compare.tsv" >"$row.part"
    mv "$row.part" "$row"
}

table() {
    printf 'solver\tunknowns\telements\tfactorisations\tcpu_s\tcpu_s_default_stop\tU1\tU2\tU3\tU4\tU5\tU6\ttranslation_off\trotation_off\tfactor_entries\tfactor_gflop\tgflop_per_s\n'
    cat "$@" | sort -t "$(printf '\t')" -k 1,1 -k 2,2n
}

# The table for people, and how much faster fesolve is with the same element on the same mesh.
report() {
    cut -f 1-6,13- "$1" | column -t -s "$(printf '\t')"
    awk -F '\t' '$1 == "fesolve tet10" { cpu[$2] = $5 }
        $1 == "DGEMM" { most = $17 }
        $1 == "fesolve tet10-blend" && $2 > 60000 { rate[$2] = $17 }
        $1 ~ /^CalculiX/ { there[$2] = $5; early[$2] = $6 }
        END {
            for (n in there)
                printf "%d unknowns: fesolve %.1f CPU s, CalculiX %.1f (%.1f at its default stop): %.0f (%.0f) times\n",
                    n, cpu[n], there[n], early[n], there[n] / cpu[n], early[n] / cpu[n]
            for (n in rate)
                printf "%d unknowns: factorisations at %.1f GFlop/s, %.0f %% of DGEMM (%.1f)\n", n, rate[n], 100 * rate[n] / most, most
        }' "$1" | sort -n
}

case $1 in
fesolve) measure_fesolve "$2" "$3" "$4" ;;
calculix) measure_calculix "$2" "$3" ;;
compare) write_comparison "$2" "$3" "$4" ;;
table) shift && table "$@" ;;
report) report "$2" ;;
dgemm) printf 'DGEMM\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t%s\n' "$("$LIB/dgemm")" >"$2" ;;
esac
