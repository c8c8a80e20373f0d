#!/bin/bash
# Shape derivatives of the inflated thick sphere (octant, kappa = 100 mu, p/mu = 0.12) by adjsens --nodal, both forms:
# of the outer radial displacement ub and of dub/dp, by both radii, against the radial equation. The outer side is a second
# chamber without pressure, so its volume gives ub.
# shellcheck disable=SC2016,SC2317 # awk programs; functions that check calls
. tests/lib.sh

# The radial equation, solved elsewhere to all these digits: ub dub/dp dub/dA dub/dB d2ub/dpdA d2ub/dpdB.
want='0.009676706 0.08987981 0.03393648 -0.01212989 0.322647 -0.116384'
exact() {
    "$LIB/sphere_shape" exact 100 0.12 | awk -v want="$want" '{ n = split(want, w)
        for (i = 1; i <= n; i++) if (($i / w[i] - 1) ^ 2 > 1e-10) exit 1 }'
}
check "the radial equation solved here agrees to 1e-5 with printed digits" exact

octant() {
    "$LIB/thick_sphere" write "$1" "$2" quadratic "$work/s.msh" 2 chamber2 &&
        "$BIN/tetmesh" --import "$work/s.msh" --mu 1 --kappa 100 -o "$work/mesh.h5"
}

# derivatives ELEMENT FORM N: relative errors to the table.
derivatives() {
    "$BIN/fesolve" --element "$1" --tolerance 1e-10 "$work/mesh.h5" --pressure 0.12,0 -o "$work/state.h5" &&
        "$BIN/adjsens" --nodal --form "$2" "$work/state.h5" -o "$work/sens.h5" &&
        "$LIB/sphere_shape" read "$work/state.h5" "$work/sens.h5" | awk -v name="$1 $2 $3" -v want="$want" '{ split(want, w)
            printf "%s", name; for (i = 3; i <= 6; i++) printf " %.5f", $i / w[i] - 1; print "" }' >>"$work/table"
}

for grid in "3 2" "8 6"; do
    # shellcheck disable=SC2086
    check "octant of $grid parts" octant $grid
    for element in tet10-blend tet10 tet15; do
        for form in domain boundary; do
            check "$element, $form form, $grid parts" derivatives "$element" "$form" "${grid% *}"
        done
    done
done
echo "# element form parts: relative errors of dub/dA dub/dB d2ub/dpdA d2ub/dpdB"
sed 's/^/# /' "$work/table"

# within ELEMENT FORM BOUND: all four at 8 x 6 parts; and all fall from 3 x 2.
within() {
    awk -v e="$1" -v f="$2" -v bound="$3" 'function abs(v) { return v < 0 ? -v : v }
        $1 == e && $2 == f { for (i = 4; i <= 7; i++) { if ($3 == 3) c[i] = abs($i); else if (abs($i) > bound || abs($i) > c[i]) bad = 1 } n++ }
        END { exit !(n == 2 && !bad) }' "$work/table"
}
# Seen at 8 x 6 parts: 0.02, 0.09, 0.08 % in the domain form, 0.84, 0.76, 0.7 % in the boundary form, whose error is that of
# the stress on the surface.
for element in tet10-blend tet10 tet15; do
    check "$element, domain form: 0.2 %" within "$element" domain 0.002
    check "$element, boundary form: 1 %" within "$element" boundary 0.01
done
finish
