#!/bin/bash
# fesolve against CalculiX, an independent solver, on the same meshes: a finger with one chamber, a body with three, all
# laws, a half-model, linear and quadratic tetrahedra. CalculiX (package calculix-ccx) must be there.
# shellcheck disable=SC2016,SC2317 # awk programs; functions that check calls
. tests/lib.sh
export OMP_NUM_THREADS=1

# Linear tetrahedra have plane faces: every operation of both programs is the same; what differs are the seven digits that
# CalculiX prints and iterates to (seen 1.1e-6). Quadratic faces: CalculiX integrates their pressure with three points,
# fesolve exactly; 0.1 % is the agreement we ask for (seen 0.01 % to 0.06 %). CalculiX does not converge at much more
# suction.
digits=3e-6
quadrature=1e-3

# solve MESH ELEMENT PRESSURES NAME [FESOLVE OPTIONS..]: both; $work/NAME.tsv is the comparison.
solve() {
    local mesh=$1 element=$2 pressure=$3 job=$work/$4
    shift 4
    "$BIN/fesolve" --element "$element" --pressure "$pressure" "$@" "$mesh" -o "$job.h5" &&
        "$BIN/meshexport" "$job.h5" -o "$job.inp" &&
        (cd "$work" && ccx "${job##*/}" >"$job.log") &&
        "$BIN/meshexport" --compare "$job.dat" "$job.h5" >"$job.tsv"
}

# agree NAME TOLERANCE: pose and volumes, and that the rotation node holds a rotation vector (printed digits).
agree() {
    awk -v tol="$2" -F '\t' '
        $1 ~ /^(translation|rotation|V[0-9])$/ { n++; if (!($4 <= tol)) { print $0; bad = 1 } }
        $1 == "rigid_end" && !($4 <= 1e-6) { print $0; bad = 1 }
        END { exit bad || n < 3 }' "$work/$1.tsv"
}

# both TOLERANCE MESH ELEMENT PRESSURES NAME [FESOLVE OPTIONS..]
both() {
    local tolerance=$1 name=$5
    shift
    check "$name: solved twice" solve "$@"
    check "$name: agree to $tolerance" agree "$name" "$tolerance"
    sed -n 's/^\(translation\|rotation\|V1\)/# \1/p' "$work/$name.tsv"
}

check "CalculiX is installed (deps.sh)" command -v ccx

check "finger: surfaces" "$BIN/surfgen" -q tests/data/finger.ini -o "$work/s.h5"
check "finger: mesh" "$BIN/tetmesh" -q --size 4 "$work/s.h5" -o "$work/finger-mesh.h5"
finger=$work/finger-mesh.h5
both "$quadrature" "$finger" tet10 0.15 finger
both "$digits" "$finger" tet4 0.3 finger-tet4
both "$digits" "$finger" tet4 0.3 mooney-rivlin --law mooney-rivlin --parameters 0.15,0.1 --kappa 25
both "$digits" "$finger" tet4 0.3 yeoh --law yeoh --parameters 0.25,0.05,0.02 --kappa 25
both "$digits" "$finger" tet4 0.3 ogden --law ogden --parameters 0.3,2.5,-0.1,-2,0.01,4
both "$digits" "$finger" tet4 -0.04 suction

# The tiny robot with three chambers.
sed 's/^name = .*/name = three/; s/mirror-x mirror-y/c3 mirror-y/; s/= 2T/= 3T/; s/^wall_min = .*/wall_min = 1.9/' tests/data/tiny.ini >"$work/three.ini"
check "three chambers: surfaces" "$BIN/surfgen" -q "$work/three.ini" -o "$work/s.h5"
check "three chambers: mesh" "$BIN/tetmesh" -q --size 6 "$work/s.h5" -o "$work/three-mesh.h5"
both "$quadrature" "$work/three-mesh.h5" tet10 0.12,0,0 three
both "$quadrature" "$work/three-mesh.h5" tet10 0.12,0.06,0 three-two

# Half a block with a round chamber and a symmetry plane.
check "half: gmsh" "$LIB/gmsh_body" 1 HALF "$work/half"
check "half: import" "$BIN/tetmesh" --import "$work/half-4.1.msh" --mu 0.5 --kappa 50 -o "$work/half-mesh.h5"
both "$digits" "$work/half-mesh.h5" tet4 0.3 half
finish
