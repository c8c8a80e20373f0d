#!/bin/bash
# The optimisation loop on a tiny robot: it raises the measure, equal runs give equal bytes, a killed run goes on to
# shellcheck disable=SC2016,SC2317
# the same history, a rejected trial costs no adjoint and shrinks the radius, misuse is refused.
. tests/lib.sh

# run NAME ITERATIONS [VARIABLE=VALUE..]
run() {
    local name=$1 last=$2
    shift 2
    make -s -j2 B="$BUILD" optimize CASE=tests/data/tiny.ini RUN="$work/$name" ITERATIONS="$last" "$@"
}

check "two iterations" run first 2
check "history has a header and three rows" test "$(wc -l <"$work/first/history.tsv")" -eq 4
check "first trial accepted and better" awk -F '\t' \
    'NR == 2 { t = $3 } NR == 3 { good = $2 == 1 && $3 > t } END { exit !good }' "$work/first/history.tsv"
check "seconds of every stage" grep -qP '^it002\tfesolve 03\t[0-9.]+$' "$work/first/times.tsv"
check "the second iteration renews the design and says the jump" awk -F '\t' 'NR == 3 { t = $3 }
    NR == 4 { off = $3 / t - 1 - $12; good = $2 == 1 && $11 > 0 && $12 != 0 && off < 0.005 && off > -0.005 } END { exit !good }' "$work/first/history.tsv"
check "and reconstructs its surfaces" test -e "$work/first/it002/surf.h5" -a ! -e "$work/first/it001/surf.h5"

# The states of an iteration start from those of the one before, here of another mesh: the leap wears the coarse one. Of four the
# second and third bound the median.
factorisations() {
    local state
    for state in "$work/first/$1"/state-0?.h5; do
        h5dump -y -d /solve/factorisations "$state" | sed -n 's/^ *\([0-9][0-9]*\)$/\1/p'
    done | sort -n | sed -n 3p
}
check "from zero at most 8 factorisations, median" test "$(factorisations it000)" -le 8
check "from the previous iteration at most 3, median" test "$(factorisations it001)" -le 3

check "the same again" run second 2
same() {
    local file
    for file in "$work"/first/it*/*.h5 "$work/first/history.tsv"; do
        cmp "$file" "${file/first/$1}" || return
    done
}
check "equal bytes" same second

# Killed with everything it started, as soon as the first state of iteration 1 is there.
setsid make -s -j2 B="$BUILD" optimize CASE=tests/data/tiny.ini RUN="$work/third" ITERATIONS=2 >"$work/log" 2>&1 &
pid=$!
for ((i = 0; i < 1200; i++)); do
    [ -z "$(ls "$work"/third/it001/state-*.h5 2>/dev/null)" ] || break
    sleep 0.05
done
kill -KILL -- "-$pid"
wait "$pid" 2>/dev/null
check "killed in iteration 1" test ! -e "$work/third/it001/step.h5"
check "goes on" run third 2
check "the killed run ends with the same files" same third

# Pictures and report; the area inside the outline of the workspace is the measure, up to
# what a coarse unsymmetric mesh breaks of the symmetry (0.01 to 0.5 % on the demo).
check "pictures" make -s -j2 B="$BUILD" pictures RUN="$work/first"
for picture in convergence shape deformed workspace; do
    check "$picture.png" test -s "$work/first/pictures/$picture.png"
done
check "area of the outline" awk 'FNR == NR { if (FNR > 1) t = $3; next }
    /^#/ { on = /outline/; next }
    on && NF == 2 { if (n++) a += (x * $2 - y * $1) / 2; x = $1; y = $2 }
    END { a = a < 0 ? -a : a; print a, t; exit !(a > 0.9 * t && a < 1.1 * t) }' "$work/first/history.tsv" "$work/first/pictures/data/workspace-after"
expect 0 "report" make -s -j2 B="$BUILD" report RUN="$work/first"
check "report gives both forms" grep -q "^it002  2T = .*by the other form" "$work/out"

# A design that cannot be meshed: a control point of a chamber far outside of the body.
check "one iteration" run wild 0
check "damage" "$LIB/mangle" set "$work/wild/it000/step.h5" /surface1/phi 0 400
check "goes on" run wild 3
row() {
    awk -F '\t' -v n="$1" "NR == n + 2 { exit !($2) }" "$work/wild/history.tsv"
}
check "the trial is rejected with a reason and no measure" row 1 '$2 == 0 && $3 == "-" && $15 != "-"'
check "without adjoint work" test ! -e "$work/wild/it001/sens-00.h5"
check "after a renewal the next one has a third of the radius and is better" awk -F '\t' \
    'NR == 4 { t = $3; renewed = $11 } NR == 5 { good = renewed && $2 == 1 && $7 < 0.07 && $3 > t } END { exit !good }' "$work/wild/history.tsv"

# A renewal that changed the mesh alone, as the history says; told that control points changed too, jumps does it once more
# on the mesh before, where they change nothing.
check "small steps" run slow 3 SET='optimisation.radius=0.06 optimisation.radius_max=0.06 optimisation.remesh_every=3'
jump=$(awk -F '\t' '$11 == 1 { printf "%.2f", 100 * $12 }' "$work/slow/history.tsv")
for kind in 1 2; do
    awk -F '\t' -v OFS='\t' -v kind=$kind 'NR == 5 { $11 = kind } 1' "$work/slow/history.tsv" >"$work/history"
    mv "$work/history" "$work/slow/history.tsv"
    expect 0 "jumps" make -s -j2 B="$BUILD" jumps RUN="$work/slow"
    check "of the mesh alone" awk -v jump="$jump" 'END { exit NR != 2 || !($1 == 3 && jump != 0 && $5 == 0 && $6 == jump && $7 == jump) }' "$work/out"
done
check "made for that" test -e "$work/slow/it003/kept.h5"

# The last design on two meshes: crests resolved otherwise change the mesh, the measure by what a coarse one is worth.
expect 0 "meshes" make -s B="$BUILD" meshes RUN="$work/first" SIZES='8 8/0.8'
check "two rows" awk -F '|' 'NR > 2 { n++; t[n] = $4; m[n] = $7 + 0 } END { print; exit !(n == 2 && t[2] > t[1] && m[1] > 0 && m[2] > 0.8 * m[1] && m[2] < 1.2 * m[1]) }' "$work/out"

# wsint takes every point of a Gauss set once, of one design.
states=("$work"/first/it000/state-0?.h5)
refused 3 "a missing point" "no state at point 3 of the boundary form" "$BIN/wsint" "${states[@]:0:3}" -o "$work/output/x.h5"
refused 3 "a double point" "are states at the same point 0" "$BIN/wsint" "${states[@]}" "${states[0]}" -o "$work/output/x.h5"
refused 3 "another design" "its mesh differs" "$BIN/wsint" "${states[@]:0:3}" "$work/first/it001/state-03.h5" -o "$work/output/x.h5"
refused 3 "a form without states" "no state at a point of the volume form" "$BIN/wsint" --form volume "${states[@]}" -o "$work/output/x.h5"
refused 3 "a measure of three chambers" "measure 3T got 2 chambers, expected 3" "$BIN/wsint" --measure 3T "${states[@]}" -o "$work/output/x.h5"
refused 3 "a free load" "at no Gauss point" "$BIN/wsint" "${states[@]}" "$work/first/it000/corner-1-0.h5" -o "$work/output/x.h5"

# A design starts another run on another mesh, whose first measure is the last one there up to what a coarse mesh is worth.
check "a design is kept" make -s B="$BUILD" design RUN="$work/first" NAME="$work/designs/tiny"
check "with its history" cmp "$work/first/history.tsv" "$work/designs/tiny.tsv"
check "and starts a run" run next 0 DESIGN="$work/designs/tiny.h5" SIZE=7 SET=optimisation.secants=0
check "with its measure" awk -F '\t' 'FNR == NR { if ($2 == 1) t = $3; next } FNR == 2 { print t, $3; exit !($3 > 0.95 * t && $3 < 1.05 * t) }' \
    "$work/first/history.tsv" "$work/next/history.tsv"
check "a setting that the case lacks stands in its section" awk '/^\[/ { on = /optimisation/ } on && /^secants = 0$/ { found = 1 } END { exit !found }' "$work/next/case.ini"
refused 3 "a design of another symmetry" "its symmetry is not that of the case" \
    "$BIN/surfgen" --design "$work/designs/tiny.h5" <(sed 's/^group = .*/group = mirror-x/' tests/data/tiny.ini) -o "$work/output/x.h5"
refused 3 "a design of another height" "it is 32 mm high, the case 33" \
    "$BIN/surfgen" --design "$work/designs/tiny.h5" <(sed 's/^height = .*/height = 33/' tests/data/tiny.ini) -o "$work/output/x.h5"
refused 2 "another case for the same run" 'another case or settings' \
    env BIN="$BIN" pipelines/optimize.sh "$work/first" tests/data/tiny.ini mesh.size=9 '' 2
refused 2 "no case" 'has no case' env BIN="$BIN" pipelines/optimize.sh "$work/none" '' '' '' 2
finish
