#!/bin/bash
# Pleats of a chamber under suction close, touch and go through each other: fesolve sees it coming, says so, and wsint
# carries it on. Half of a body with a pair of chambers.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

numbers() {
    h5dump -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}

# The sections that an imported body needs for a workspace; the others are those of a case.
cat >"$work/pair.ini" <<'EOT'
[case]
name = pair
[material]
mu = 1
kappa = 100
[body]
height = 28
wall = 1
[chamber1]
shape = sphere
center = 3, 0, 14
radius = 2
[symmetry]
group = mirror-x mirror-y
[actuation]
pmin = -0.09
pmax = 0.05
[workspace]
measure = 2T
EOT
for part in half whole; do
    check "$part" "$LIB/beam" pair "$part" 4 "$work/$part.msh"
    check "import" "$BIN/tetmesh" --import "$work/$part.msh" --case "$work/pair.ini" -o "$work/$part.h5"
done

# The gap of the pleat, 1.5 mm at rest, closes between 0.075 and 0.09 mu.
awk 'BEGIN { for (k = 0; k <= 6; k++) print -0.015 * k, 0 }' >"$work/path.txt"
expect 0 "a path into contact" "$BIN/fesolve" --path "$work/path.txt" "$work/half.h5" -o "$work/path.h5"
check "fesolve warns" grep -q "self-contact is not modelled: the body penetrates itself at 1 of 7 points" "$work/err"
check "the gap closes: it falls, then faces pierce" awk -v g="$(numbers /path/gap "$work/path.h5")" \
    -v n="$(numbers /path/intersections "$work/path.h5")" 'BEGIN {
    split(g, gap); split(n, pairs)
    for (k = 1; k <= 6; k++)
        if (pairs[k] != 0 || gap[k] <= 0 || (k > 1 && gap[k] >= gap[k - 1])) exit 1
    exit !(pairs[7] > 0 && gap[7] == 0) }'
echo "# gap, pairs: $(numbers /path/gap "$work/path.h5")" "$(numbers /path/intersections "$work/path.h5")"

for load in 0 1 2 3; do
    expect 0 "load $load" "$BIN/fesolve" --load $load "$work/half.h5" -o "$work/s$load.h5"
    if [ $load -lt 2 ]; then
        check "fesolve warns" grep -q "self-contact is not modelled: .* pierce each other, the first of chamber 1 and itself" "$work/err"
    else
        check "no contact, no warning" test ! -s "$work/err"
    fi
done
expect 0 "wsint" "$BIN/wsint" "$work"/s?.h5 -o "$work/work.h5"
check "wsint warns" grep -q "penetrates itself in 2 of 4 states" "$work/err"
check "and records it" awk -v n="$(numbers /point/intersections "$work/work.h5")" -v g="$(numbers /point/gap "$work/work.h5")" \
    'BEGIN { split(n, N); split(g, G); exit !(N[1] > 0 && N[2] > 0 && N[3] == 0 && N[4] == 0 && G[1] == 0 && G[2] == 0 && G[3] > 0) }'
# What a symmetry plane cannot show: the whole body buckles sideways before.
refused 4 "the whole body" "no stable equilibrium beyond load 0\.[34].* of the pressures" \
    "$BIN/fesolve" --load 0 "$work/whole.h5" -o "$work/output/x.h5"
finish
