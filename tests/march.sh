# march KIND CASE STEPS: optimises a synthetic measure (tests/lib/synthetic.c) without equilibria for
# STEPS trials or until trstep ends, in $work/march, reconstructing where trstep says renew. rows.tsv: iteration
# and what synthetic prints; history.tsv.
# shellcheck shell=bash disable=SC2154
march() {
    local kind=$1 case=$2 steps=$3 dir=$work/march surf=s.h5 n sens previous=()
    rm -rf "$dir" && mkdir "$dir" || return
    "$BIN/surfgen" -q "$case" -o "$dir/s.h5" || return
    for ((n = 0; n <= steps; n++)); do
        "$LIB/synthetic" "$kind" "$dir/$surf" "$dir/work.h5" "$dir/sens.h5" >"$dir/row" || return
        sed "s/^/$n\t/" "$dir/row" >>"$dir/rows.tsv"
        sens=("$dir/sens.h5")
        [ "$("$BIN/trstep" "$dir/$surf" "$dir/work.h5" --judge "${previous[@]}")" = accept ] || sens=()
        "$BIN/trstep" -q "$dir/$surf" "$dir/work.h5" "${sens[@]}" "${previous[@]}" -o "$dir/new.h5" || return
        mv "$dir/new.h5" "$dir/step.h5"
        surf=step.h5 previous=(--previous "$dir/step.h5")
        [ "$("$BIN/trstep" --verdict "$dir/step.h5")" = continue ] || break
        if [ "$("$BIN/trstep" --next "$dir/step.h5")" = renew ]; then
            "$BIN/surfremesh" -q --or-keep "$dir/step.h5" -o "$dir/surf.h5" || return
            surf=surf.h5
        fi
    done
    "$BIN/trstep" --history "$dir/step.h5" >"$dir/history.tsv"
}

# held NAME [CURVATURE]: every trial of the march is a robot with walls above 98 % of wall_min, curvature below CURVATURE
# (1.05) times curvature_max and symmetry to 1e-12 mm.
held() {
    awk -v most="${2:-1.05}" -F '\t' '{ wall = NR == 1 || $3 < wall ? $3 : wall; cap = NR == 1 || $4 < cap ? $4 : cap; bend = $5 > bend ? $5 : bend
            defect = $6 + 0 > defect + 0 ? $6 : defect; fault = $8 != "-" ? $8 : fault }
        END { defect += 0; print NR, "trials: least wall", wall, "cap", cap, "largest curvature", bend, "defect", defect, fault
            exit !(wall >= 0.98 && cap >= 0.98 && bend <= most && defect < 1e-12 && fault == "") }' "$work/march/rows.tsv" >"$work/held"
    result $? "$1: $(cat "$work/held")"
}
