#!/bin/bash
# gradients.sh row CASE NAME.row | table sphere|robot ROW.. | report TABLE
# The measurements of gradients.mk. A row is named sphere-KAPPA-PARTSxLAYERS or robot-SIZE; it holds one line a form.
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

# The rate of the measure where a chamber grows evenly along its normal, away from the ends, by both forms.
robot_row() {
    local size=$1 case=$2 base=${3%.row} g last form cost
    log=$base.log
    : >"$log"
    "$BIN/surfgen" "$case" -o "$base-surf.h5"
    "$BIN/tetmesh" --size "$size" "$base-surf.h5" -o "$base.h5"
    last=$(("$("$BIN/wsint" --points "$case" | awk 'NR > 1' | wc -l)" - 1))
    for ((g = 0; g <= last; g++)); do "$BIN/fesolve" --tolerance 1e-9 --load "$g" "$base.h5" -o "$base-state$g.h5"; done
    "$BIN/wsint" "$base"-state?.h5 -o "$base-work.h5"
    for form in domain boundary; do
        cost=$(derivatives "$form" "$base-state$last.h5" "$base-$form.h5" "$base-work.h5")
        printf '%s\t%s\t%s\t%s\t%s\n' "$form" "$size" "$(tetrahedra "$base.h5")" "$("$LIB/growth" "$base-surf.h5" "$base-$form.h5")" "$cost"
    done >"$3.part"
    mv "$3.part" "$3"
}

case $1 in
row)
    name=$(basename "$3" .row)
    IFS=- read -r kind a b <<<"$name"
    if [ "$kind" = sphere ]; then sphere_row "$a" "$b" "$3"; else robot_row "$a" "$2" "$3"; fi
    ;;
table)
    if [ "$2" = sphere ]; then
        printf 'form\tkappa\tparts\tlayers\ttetrahedra\te_dA\te_dB\te_dpdA\te_dpdB\tcpu_s\tfactor_s\n'
    else
        printf 'form\tsize\ttetrahedra\tchambers\texterior\tcpu_s\tfactor_s\n'
    fi
    shift 2
    cat "$@"
    ;;
report) column -t -s $'\t' "$2" ;;
esac
