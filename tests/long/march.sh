#!/bin/bash
# Steps without equilibria at a radius up to 1 mm, with reconstructions between them: no wall, bend, fold or lost
# symmetry gets past trstep. surfremesh takes 1.25 times curvature_max at its samples; between samples, next to control
# points, a surface bends up to a fifth more.
. tests/lib.sh
. tests/march.sh

for case in tests/data/tiny.ini data/cases/2A0R2T-spheres.ini; do
    { sed '/^\[optimisation\]/,$d' "$case"; printf '[optimisation]\nradius = 0.2\ntolerance = 1e-9\n'; } >"$work/case.ini"
    for kind in volume area; do
        # areas grow without end, and the control points with them: to five times the first area
        steps=60
        [ $kind = volume ] || steps=30
        check "$(basename "$case") $kind" march "$kind" "$work/case.ini" "$steps"
        held "$(basename "$case") $kind" 1.5
    done
done
finish
