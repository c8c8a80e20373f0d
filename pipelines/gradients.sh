#!/bin/bash
# gradients.sh row CASE NAME.row | table sphere|robot|measure ROW.. | report TABLE
# The measurements of gradients.mk. A row is named sphere-KAPPA-PARTSxLAYERS or robot-SIZE, with one
# line a form, or measure-CASE.
set -eu
shopt -s inherit_errexit
. pipelines/measure.sh

# derivatives FORM STATE SENS [OPTION or OPERAND..]: prints the CPU seconds of adjsens beyond one factorisation, and of that.
derivatives() {
    local form=$1 state=$2 sens=$3
    shift 3
    cpu "$BIN/adjsens" -v --form "$form" "$state" "$@" -o "$sens" >"$sens.cpu"
    awk -v cpu="$(<"$sens.cpu")" 'match($0, /factorisation [0-9.]+/) { f = substr($0, RSTART + 14, RLENGTH - 14) } END { printf "%s\t%s", cpu, f }' "$log"
}

sphere_row() {
    local kappa=$1 parts=${2%x*} layers=${2#*x} base=${3%.row} form cost
    log=$base.log
    : >"$log"
    "$LIB/thick_sphere" write "$parts" "$layers" quadratic "$base.msh" 2 chamber2
    "$BIN/tetmesh" --import "$base.msh" --mu 1 --kappa "$kappa" -o "$base.h5"
    "$BIN/fesolve" --tolerance 1e-10 "$base.h5" --pressure 0.12,0 -o "$base-state.h5"
    for form in domain boundary; do
        cost=$(derivatives "$form" "$base-state.h5" "$base-$form.h5" --nodal)
        paste <("$LIB/sphere_shape" exact "$kappa" 0.12) <("$LIB/sphere_shape" read "$base-state.h5" "$base-$form.h5") |
            awk -v OFS='\t' -v head="$form $kappa $parts $layers $(tetrahedra "$base.h5")" -v cost="$cost" '{ gsub(/ /, "\t", head)
                printf "%s", head; for (i = 3; i <= 6; i++) printf "\t%.3e", $(i + 6) / $i - 1; print "\t" cost }'
    done >"$3.part"
    mv "$3.part" "$3"
}

# states CASE SIZE BASE: all states of the case on a mesh of that size, BASE-00.state.h5 .., and BASE-work.h5; sets $last.
states() {
    local case=$1 size=$2 base=$3 g n
    "$BIN/surfgen" -q "$case" -o "$base-surf.h5"
    "$BIN/tetmesh" --size "$size" "$base-surf.h5" -o "$base.h5"
    n=$("$BIN/wsint" --points "$case" | awk 'NR > 1' | wc -l)
    for ((g = 0; g < n; g++)); do
        last=$base-$(printf %02d "$g").state.h5
        "$BIN/fesolve" --tolerance 1e-9 --load "$g" "$base.h5" -o "$last"
    done
    "$BIN/wsint" -q "$base"-??.state.h5 -o "$base-work.h5"
}

# Measure, its value, relative error of the gradient in the chambers, in the exterior, in both.
measure_row() {
    local base=${3%.row}
    log=$base.log
    states "data/cases/$1.ini" 6 "$base"
    "$BIN/adjsens" --check "$last" "$base-work.h5" -o "$base-sens.h5" >"$log"
    { printf '%s\t' "$1" "$(item /measure/value "$base-work.h5")"; awk '/plateau/ { printf "%s%s", s, $7; s = "\t" } END { print "" }' "$log"; } >"$3.part"
    mv "$3.part" "$3"
}

# The rate of the measure where a chamber grows evenly along its normal, away from the ends, by both forms.
robot_row() {
    local size=$1 case=$2 base=${3%.row} form cost
    log=$base.log
    : >"$log"
    states "$case" "$size" "$base"
    for form in domain boundary; do
        cost=$(derivatives "$form" "$last" "$base-$form.h5" "$base-work.h5")
        printf '%s\t%s\t%s\t%s\t%s\n' "$form" "$size" "$(tetrahedra "$base.h5")" "$("$LIB/growth" "$base-surf.h5" "$base-$form.h5")" "$cost"
    done >"$3.part"
    mv "$3.part" "$3"
}

case $1 in
row)
    name=$(basename "$3" .row)
    IFS=- read -r kind a b <<<"$name"
    case $kind in
    sphere) sphere_row "$a" "$b" "$3" ;;
    robot) robot_row "$a" "$2" "$3" ;;
    measure) measure_row "$a" "$2" "$3" ;;
    esac
    ;;
table)
    case $2 in
    sphere) printf 'form\tkappa\tparts\tlayers\ttetrahedra\te_dA\te_dB\te_dpdA\te_dpdB\tcpu_s\tfactor_s\n' ;;
    robot) printf 'form\tsize\ttetrahedra\tchambers\texterior\tcpu_s\tfactor_s\n' ;;
    measure) printf 'case\tvalue\te_chambers\te_exterior\te_both\n' ;;
    esac
    shift 2
    cat "$@"
    ;;
report) column -t -s $'\t' "$2" ;;
esac
