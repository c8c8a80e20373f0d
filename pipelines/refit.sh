#!/bin/bash
# refit.sh FILE.msh MU KAPPA PRESSURES: a body given as a mesh against the robot whose surfaces are fitted to its boundary,
# as refit.mk says; BIN, LIB, SPACING, SIZE, CREST, ELEMENT and RUN are set there. Table on standard output and in
# RUN/table.md, what the tools say in RUN/log.
set -eu
shopt -s inherit_errexit
msh=$1 mu=$2 kappa=$3 pressures=$4
. pipelines/measure.sh

fail() {
    echo "refit: $1" >&2
    exit 2
}

[ -r "$msh" ] || fail "cannot read '$msh', expected MSH=FILE.msh"
[[ "$mu $pressures" =~ ^[0-9.e-]+\ [0-9.,e-]+$ ]] || fail 'expected MU=MPA and PRESSURE=MPA[,MPA..]'
material=(--mu "$mu" ${kappa:+--kappa "$kappa"})
log=$RUN/log
mkdir -p "$RUN"
rm -f "$RUN"/*.h5 "$RUN"/*.obj
: >"$log"

quiet() { cpu "$@" >>"$log"; }

# sizes MESH.h5: tetrahedra, mean edge, volume of the body.
sizes() { "$LIB/mesh_skin" sizes "$1"; }

# The given mesh; its end-effector turns about the point that surfgen takes.
case $msh in *.gz) gzip -dc "$msh" ;; *) cat "$msh" ;; esac >"$RUN/given.msh"
quiet "$BIN/tetmesh" --import "$RUN/given.msh" "${material[@]}" -o "$RUN/given.h5"
shape=$("$LIB/mesh_skin" obj "$RUN/given.h5" "$RUN")
read -r height radius side <<<"$shape"
chambers=$(($(wc -l <<<"$shape") - 1))
given=$(tr , '\n' <<<"$pressures" | wc -l)
[ "$given" -eq 1 ] || [ "$given" -eq "$chambers" ] || fail "found $given pressures, expected 1 or $chambers"
linear=()
h5dump -H -d /mesh/tri "$RUN/given.h5" | grep -q ', 3 )' && linear=(--promote)
quiet "$BIN/tetmesh" --import "$RUN/given.msh" "${material[@]}" "${linear[@]}" --reference "0,0,$height" -o "$RUN/given.h5"
read -r tetrahedra edge _ <<<"$(sizes "$RUN/given.h5")"
spacing=${SPACING:-$(awk -v e="$edge" 'BEGIN { printf "%.4g", e / 1.5 }')}

# A case that asks nothing of the shape: control points alike along and around the body.
{
    printf '[case]\nname = refit\n[material]\nmu = %s\n' "$mu"
    [ -z "$kappa" ] || printf 'kappa = %s\n' "$kappa"
    awk -v h="$height" -v r="$radius" -v side="$side" -v s="$spacing" -v edge="$edge" -v crest="$CREST" 'BEGIN {
        around = 6.283185307 * r / s + 0.5
        rows = side / (6.283185307 * r) / s + 0.5
        if (around < 8) around = 8
        if (rows < 8) rows = 8
        printf "[body]\nshape = file\nheight = %s\naround = %d\nrows = %d\n", h, around, rows
        printf "[mesh]\nsize = %g\ncrest = %g\n[constraints]\nwall_min = %g\ncap_min = 0\n", edge, crest, edge / 2
    }'
    tail -n +2 <<<"$shape" | awk -v s="$spacing" '{ printf "[chamber%d]\nshape = file\ncenter = %s, %s, %s\nspacing = %s\n", NR, $1, $2, $3, s }'
} >"$RUN/case.ini"
files=(--body "$RUN/body.obj")
for k in $(seq "$chambers"); do files+=(--chamber "$k=$RUN/chamber$k.obj"); done
quiet "$BIN/surfgen" -v "${files[@]}" "$RUN/case.ini" -o "$RUN/surf.h5"

bodies='given moved'
kept=$("$LIB/mesh_skin" moved "$RUN/given.h5" "$RUN/moved.msh" "$RUN/surf.h5")
quiet "$BIN/tetmesh" --import "$RUN/moved.msh" "${material[@]}" --reference "0,0,$height" -o "$RUN/moved.h5"

# Wanted edges are not mean edges: as long as those differ, once more by what is missing.
size=${SIZE:-$edge} refused=0
for _ in 1 2 3; do
    "$BIN/tetmesh" -v --size "$size" "$RUN/surf.h5" -o "$RUN/curved.h5" >>"$log" 2>&1 || refused=$?
    if [ "$refused" -gt 0 ]; then
        reason=$(tail -n 1 "$log")
        break
    fi
    [ -z "$SIZE" ] || break
    read -r _ got _ <<<"$(sizes "$RUN/curved.h5")"
    awk -v a="$edge" -v b="$got" 'BEGIN { exit (a / b - 1) ^ 2 > 0.03 ^ 2 }' && break
    size=$(awk -v a="$edge" -v b="$got" -v s="$size" 'BEGIN { printf "%.4g", s * a / b }')
done
if [ "$refused" -eq 0 ]; then
    if [ ${#linear[@]} -gt 0 ]; then
        bodies="$bodies straight"
        "$LIB/mesh_skin" straight "$RUN/curved.h5" "$RUN/straight.msh"
        quiet "$BIN/tetmesh" --import "$RUN/straight.msh" "${material[@]}" --promote --reference "0,0,$height" -o "$RUN/straight.h5"
    fi
    bodies="$bodies curved"
fi

ratios=$(awk -v p="$pressures" -v mu="$mu" -v n="$chambers" 'BEGIN {
    m = split(p, list, ",")
    for (k = 1; k <= n; k++) printf "%s%.12g", (k > 1 ? "," : ""), list[(m > 1 ? k : 1)] / mu
}')

report() {
    local k body pose
    printf '| surface | control points | distance of the given one, mean mm | max mm |\n|--|--|--|--|\n'
    for k in $(seq 0 "$chambers"); do
        printf '| %s | %d | %.3f | %.3f |\n' "$([ "$k" -gt 0 ] && echo "chamber $k" || echo body)" \
            "$(h5dump -H -d "/surface$k/phi" "$RUN/surf.h5" | sed -n 's/.*DATASPACE *SIMPLE *{ ( \([0-9]*\),.*/\1/p')" \
            "$(item /fit/mean "$RUN/surf.h5" | tr '\t' '\n' | sed -n "$((k + 1))p")" "$(item /fit/max "$RUN/surf.h5" | tr '\t' '\n' | sed -n "$((k + 1))p")"
    done
    printf '\n| mesh, %s | tetrahedra | mean edge mm | body mm3 | chambers mm3 | U at %s MPa, mm and rad | CPU s |\n|--|--|--|--|--|--|--|\n' "$ELEMENT" "$pressures"
    for body in $bodies; do
        time=$(cpu "$BIN/fesolve" --element "$ELEMENT" --pressure "$ratios" "$RUN/$body.h5" -o "$RUN/state-$body.h5")
        pose=$(item /tip/U "$RUN/state-$body.h5")
        read -r tetrahedra edge volume <<<"$(sizes "$RUN/$body.h5")"
        printf '| %s | %d | %.3f | %.1f | %s | %s | %s |\n' "$(name "$body")" "$tetrahedra" "$edge" "$volume" \
            "$(item /chamber/volume0 "$RUN/state-$body.h5" | awk '{ for (k = 1; k <= NF; k++) printf "%s%.1f", (k > 1 ? ", " : ""), $k }')" \
            "$(awk '{ printf "%.4f %.4f %.4f, %.5f %.5f %.5f", $1, $2, $3, $4, $5, $6 }' <<<"$pose")" "$time"
        printf '%s\t%s\n' "$(name "$body")" "$pose" >>"$RUN/poses.tsv"
    done
    printf '\n'
    differences "$RUN/poses.tsv"
}

name() {
    case $1 in
    given) echo given ;;
    moved) echo "given, moved to the fit but for $kept elements" ;;
    straight) echo 'fitted, straight edges' ;;
    curved) echo fitted ;;
    esac
}

# differences POSES: of each pose from the first one; angles of the rotation that leads from one to the other.
differences() {
    awk -F '\t' '
        function quaternion(x, y, z, q, a, f) {
            a = sqrt(x * x + y * y + z * z); f = a > 0 ? sin(a / 2) / a : 0.5
            q[0] = cos(a / 2); q[1] = f * x; q[2] = f * y; q[3] = f * z
            return a
        }
        NR == 1 { for (k = 2; k <= 4; k++) u[k] = $k; length0 = sqrt($2 ^ 2 + $3 ^ 2 + $4 ^ 2); angle0 = quaternion($5, $6, $7, p); next }
        {
            d = sqrt(($2 - u[2]) ^ 2 + ($3 - u[3]) ^ 2 + ($4 - u[4]) ^ 2)
            quaternion($5, $6, $7, q)
            sum = 0
            for (k = 1; k <= 3; k++) { i = k % 3 + 1; j = i % 3 + 1; sum += (p[0] * q[k] - q[0] * p[k] - p[i] * q[j] + p[j] * q[i]) ^ 2 }
            w = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]
            t = 2 * atan2(sqrt(sum), w < 0 ? -w : w)
            printf "%s against given: %.4f mm of %.3f (%.2f %%), %.4f degrees of %.3f (%.2f %%)\n", $1, d, length0,
                (length0 > 0 ? 100 * d / length0 : 0), t * 57.29577951, angle0 * 57.29577951, (angle0 > 0 ? 100 * t / angle0 : 0)
        }' "$1"
}

rm -f "$RUN/poses.tsv"
report | tee "$RUN/table.md"
[ "$refused" -eq 0 ] || { echo "refit: no mesh of the fitted surfaces: $reason" >&2; exit "$refused"; }
