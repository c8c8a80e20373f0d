#!/bin/bash
# fesolve against CalculiX, an independent solver, on the same meshes: a finger with one chamber, a body with three, all
# laws, a half-model, linear and quadratic tetrahedra. CalculiX (package calculix-ccx) must be there.
# shellcheck disable=SC2016,SC2317 # awk programs; functions that check calls
. tests/lib.sh
export OMP_NUM_THREADS=1

# Linear tetrahedra have plane faces: every operation of both programs is the same, what differs are the seven digits that
# CalculiX prints. Quadratic faces: CalculiX integrates their pressure with three points, fesolve exactly; 0.1 % is the
# agreement we ask for (seen 0.02 % to 0.06 %).
digits=1e-6
quadrature=1e-3

# solve MESH ELEMENT PRESSURES NAME: both; $work/NAME.tsv is the comparison.
solve() {
    "$BIN/fesolve" --element "$2" --pressure "$3" "$1" -o "$work/$4.h5" &&
        "$BIN/meshexport" "$work/$4.h5" -o "$work/$4.inp" &&
        (cd "$work" && ccx "$4" >"$4.log") &&
        "$BIN/meshexport" --compare "$work/$4.dat" "$work/$4.h5" >"$work/$4.tsv"
}

# agree NAME TOLERANCE: pose and volumes, and that the rotation node holds a rotation vector (printed digits).
agree() {
    awk -v tol="$2" -F '\t' '
        $1 ~ /^(translation|rotation|V[0-9])$/ { n++; if (!($4 <= tol)) { print $0; bad = 1 } }
        $1 == "rigid_end" && !($4 <= 1e-6) { print $0; bad = 1 }
        END { exit bad || n < 3 }' "$work/$1.tsv"
}

# both MESH ELEMENT PRESSURES NAME TOLERANCE
both() {
    check "$4: solved twice" solve "$1" "$2" "$3" "$4"
    check "$4: agree to $5" agree "$4" "$5"
    [ -r "$work/$4.tsv" ] && sed -n 's/^\(translation\|rotation\|V1\)/# \1/p' "$work/$4.tsv"
}

check "CalculiX is installed (deps.sh)" command -v ccx

check "finger: surfaces" "$BIN/surfgen" -q tests/data/finger.ini -o "$work/s.h5"
check "finger: mesh" "$BIN/tetmesh" -q "$work/s.h5" -o "$work/finger-mesh.h5"
both "$work/finger-mesh.h5" tet10 0.15 finger "$quadrature"
both "$work/finger-mesh.h5" tet4 0.3 finger-tet4 "$digits"

# three MATERIAL SIZE NAME: the tiny robot with three chambers of that material.
three() {
    sed -e 's/^name = .*/name = three/; s/mirror-x mirror-y/c3 mirror-y/; s/= 2T/= 3T/' -e '/^law\|^mu\|^kappa/d' \
        -e "s/^\[material\]/&\n$1/" tests/data/tiny.ini >"$work/$3.ini" &&
        "$BIN/surfgen" -q "$work/$3.ini" -o "$work/s.h5" && "$BIN/tetmesh" -q --size "$2" "$work/s.h5" -o "$work/$3-mesh.h5"
}
check "three chambers: mesh" three 'mu = 0.5\nkappa = 50' 6 three
both "$work/three-mesh.h5" tet10 0.12,0,0 three "$quadrature"
both "$work/three-mesh.h5" tet10 0.12,0.06,0 three-two "$quadrature"

check "Mooney-Rivlin: mesh" three 'law = mooney-rivlin\nc10 = 0.15\nc01 = 0.1\nkappa = 25' 12 mooney
both "$work/mooney-mesh.h5" tet4 0.3,0.1,0 mooney "$digits"
check "Yeoh: mesh" three 'law = yeoh\nc1 = 0.25\nc2 = 0.05\nc3 = 0.02\nkappa = 25' 12 yeoh
both "$work/yeoh-mesh.h5" tet4 0.3,0.1,0 yeoh "$digits"
check "Ogden: mesh" three 'law = ogden\nmu1 = 0.3\nalpha1 = 2.5\nmu2 = -0.1\nalpha2 = -2\nmu3 = 0.01\nalpha3 = 4' 12 ogden
both "$work/ogden-mesh.h5" tet4 0.3,0.1,0 ogden "$digits"

# Half a block with a round chamber and a symmetry plane.
check "half: gmsh" "$LIB/gmsh_body" 1 HALF "$work/half"
check "half: import" "$BIN/tetmesh" --import "$work/half-4.1.msh" --mu 0.5 --kappa 50 -o "$work/half-mesh.h5"
both "$work/half-mesh.h5" tet4 0.3 half "$digits"
finish
