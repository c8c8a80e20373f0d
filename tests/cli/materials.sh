#!/bin/bash
# Materials of imported meshes: presets, laws with parameters, refusals; every tool takes them.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

out=$work/output
import() {
    "$BIN/tetmesh" --import "$work/sphere.msh" "$@"
}
# stated FILE LINE: the line stands in the case of the mesh or state
stated() {
    h5dump -d /case/text "$1" | grep -q "$2"
}
"$LIB/thick_sphere" write 3 2 quadratic "$work/sphere.msh"

expect 0 "a preset" import --material dragon-skin-30 --kappa 20 -o "$work/preset.h5"
check "stands in the case of the mesh" stated "$work/preset.h5" "preset = dragon-skin-30"
check "with kappa" stated "$work/preset.h5" "kappa = 20"
expect 0 "a law" import --law ogden --parameters 0.4,1.3,-0.01,-5 -o "$work/ogden.h5"
check "stands in the case of the mesh" stated "$work/ogden.h5" "alpha2 = -5"
expect 0 "fesolve takes it" "$BIN/fesolve" "$work/ogden.h5" --pressure 0.02 -o "$work/state.h5"
printf '[case]\nname = m\n[material]\nlaw = ogden\nmu1 = 0.4\nalpha1 = 2\n' >"$work/ogden.ini"
expect 0 "one term with exponent 2" import --case "$work/ogden.ini" -o "$work/ogden.h5"
expect 0 "is neo-Hookean" import --mu 0.4 -o "$work/neo.h5"
for law in ogden neo; do
    expect 0 "state of $law" "$BIN/fesolve" "$work/$law.h5" --pressure 0.02 -o "$work/$law-state.h5"
done
# [mm] of 0.03; both are converged to rounding, seen 1e-16.
check "the same state" h5diff -d 1e-13 "$work/ogden-state.h5" "$work/neo-state.h5" /node/displacement
expect 0 "an Ogden term of the wrong sign" import --law ogden --parameters 0.4,2,-0.01,5 -o "$work/ogden.h5"
check "is warned of" grep -q "mu2 alpha2 = -0.05 MPa < 0" "$work/err"

# another material than that of the mesh
fesolve() {
    "$BIN/fesolve" "$work/neo.h5" --pressure 0.02 "$@"
}
expect 0 "fesolve with another law" fesolve --law ogden --parameters 0.4,2 -o "$work/other.h5"
check "stands in the case of the state" stated "$work/other.h5" "alpha1 = 2"
check "which is that of a mesh of this material" \
    h5diff -d 1e-13 "$work/other.h5" "$work/ogden-state.h5" /node/displacement
expect 0 "fesolve with a preset" fesolve --material dragon-skin-10 -o "$work/other.h5"
check "stands in the case of the state" stated "$work/other.h5" "preset = dragon-skin-10"
expect 0 "fesolve with another kappa" fesolve --kappa 12 -o "$work/other.h5"
check "keeps the law" stated "$work/other.h5" "law = neo-hookean"
check "and has kappa" stated "$work/other.h5" "kappa = 12"
refused 2 "fesolve: unknown preset" "unknown material 'butter'" fesolve --material butter -o "$out/x.h5"
refused 2 "fesolve: parameters without a law" "need each other" fesolve --parameters 1 -o "$out/x.h5"
refused 2 "fesolve: kappa 0" "option --kappa: found 0, expected a number > 0" fesolve --kappa 0 -o "$out/x.h5"

both() {
    refused 2 "$1" "needs one of --case, --material, --law with --parameters, --mu" import "${@:2}" -o "$out/x.h5"
}
both "no material"
both "law and case" --case a.ini --law yeoh --parameters 1
both "preset and mu" --material sylgard-184 --mu 1
refused 2 "kappa with a case" "--kappa does not go with --case" import --case a.ini --kappa 1 -o "$out/x.h5"
refused 2 "law without parameters" "--law and --parameters need each other" import --law yeoh -o "$out/x.h5"
refused 2 "parameters without a law" "--law and --parameters need each other" import --parameters 1 -o "$out/x.h5"
refused 2 "not numbers" "option '--parameters': found '1,x', expected numbers" \
    import --law yeoh --parameters 1,x -o "$out/x.h5"
refused 2 "unknown preset" "unknown material 'butter', expected ecoflex-00-30, " import --material butter -o "$out/x.h5"
refused 2 "unknown law" "unknown law 'gent', expected neo-hookean, " import --law gent --parameters 1 -o "$out/x.h5"
refused 2 "too many parameters" "law 'mooney-rivlin': found 3 parameters, expected 2" \
    import --law mooney-rivlin --parameters 1,2,3 -o "$out/x.h5"
refused 2 "half an Ogden term" "law 'ogden': found 3 parameters, expected 2 to 12 in pairs" \
    import --law ogden --parameters 1,2,3 -o "$out/x.h5"
refused 3 "no stiffness" "small-strain shear modulus -2 MPa, expected > 0" \
    import --law yeoh --parameters=-1 -o "$out/x.h5"
finish
