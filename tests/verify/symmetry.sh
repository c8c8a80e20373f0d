#!/bin/bash
# Parts of bodies on symmetry planes against the whole bodies, on meshes that are exact images; pressures exchanged
# between chambers that are images of each other; chambers in threefold symmetry.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

numbers() {
    h5dump -m %.17g -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}

# solve BODY PART PRESSURES NAME: 3 pitches
solve() {
    rm -f "$work/$4.h5"
    "$LIB/beam" "$1" "$2" 3 "$work/b.msh" && "$BIN/tetmesh" -q --import "$work/b.msh" --mu 1 --kappa 100 -o "$work/b.h5" &&
        "$BIN/fesolve" --tolerance 1e-10 --pressure="$3" "$work/b.h5" -o "$work/$4.h5"
}

# The residuals are 1e-10 of the pressure load; seen 7e-11 in J, 1e-12 and less in all others.
exact=1e-8

# compare ITEM FACTORS FIRST SECOND [exchange]: FACTORS (one each, the last repeated) times the numbers of the first are
# those of the second, with those of the two chambers exchanged where asked for.
compare() {
    awk -v a="$(numbers "$1" "$work/$3.h5")" -v b="$(numbers "$1" "$work/$4.h5")" -v f="$2" -v x="${5-}" -v t="$exact" 'BEGIN {
        n = split(a, A); m = split(f, F); split(b, B)
        for (i = 1; i <= n; i++) {
            other = x == "" ? i : i % 2 ? i + 1 : i - 1
            d = F[i < m ? i : m] * A[i] - B[other]
            if (d < 0) d = -d
            if (d > worst) worst = d
            if (B[i]^2 > most^2) most = B[i] < 0 ? -B[i] : B[i]
        }
        print "worst", worst, "of", most
        exit !(n > 0 && most > 0 && worst <= t * most) }'
}

# part BODY PART WHOLE PRESSURES
part() {
    local name="$1: $2 and $3 at $4"
    check "$name: the $2" solve "$1" "$2" "$4" part
    check "$name: the $3" solve "$1" "$3" "$4" whole
    check "$name: pose" compare /tip/U 1 part whole
    check "$name: Jacobian" compare /tip/J 1 part whole
    check "$name: volumes" compare /chamber/volume 2 part whole
    check "$name: energy" compare /solve/energy 2 part whole
}
part finger half whole 0.12
part bellows quarter half 0.08
part bellows half whole 0.08
part pair half whole 0.1,-0.03

# The mirror x -> -x takes one chamber to the other.
check "pair: pressures exchanged" solve pair whole -0.03,0.1 exchanged
check "pose is the image" compare /tip/U "-1 1 1 1 -1 -1" whole exchanged
check "Jacobian too" compare /tip/J "-1 -1 1 1 1 1 1 1 -1 -1 -1 -1" whole exchanged exchange
check "volumes exchanged" compare /chamber/volume 1 whole exchanged exchange
check "energy the same" compare /solve/energy 1 whole exchanged

# Three chambers, each the image of the one before by a turn of 120 degrees: a mesh that is not symmetric keeps that up to
# its own error (seen 2 % at this size, 0.5 % at 3 mm).
sed 's/^name = .*/name = three/; s/mirror-x mirror-y/c3 mirror-y/; s/= 2T/= 3T/; s/wall_min = 2/wall_min = 1.9/' tests/data/tiny.ini >"$work/three.ini"
check "three chambers: surfaces" "$BIN/surfgen" -q "$work/three.ini" -o "$work/s.h5"
check "three chambers: mesh" "$BIN/tetmesh" -q --size 4 "$work/s.h5" -o "$work/three.h5"
printf '0.12 0 0\n0 0.12 0\n0 0 0.12\n0.1 0.06 -0.03\n-0.03 0.1 0.06\n0.06 -0.03 0.1\n' >"$work/turned.txt"
check "three chambers: path" "$BIN/fesolve" --path "$work/turned.txt" "$work/three.h5" -o "$work/path.h5"
# turned FIRST: the next two points (from 1) are those before, turned.
turned() {
    awk -v u="$(numbers /path/U "$work/path.h5")" -v first="$1" 'BEGIN {
        split(u, U); c = -0.5; s = sqrt(3) / 2
        for (k = first; k < first + 2; k++)
            for (g = 0; g < 6; g += 3) {
                a = 6 * (k - 1) + g; b = a + 6
                e = (c * U[a + 1] - s * U[a + 2] - U[b + 1])^2 + (s * U[a + 1] + c * U[a + 2] - U[b + 2])^2 + (U[a + 3] - U[b + 3])^2
                e = sqrt(e / (U[b + 1]^2 + U[b + 2]^2 + U[b + 3]^2))
                print e
                if (!(e < 0.03)) bad = 1
            }
        exit bad }'
}
check "three chambers, one pressure" turned 1
turned 1 | sed 's/^/# /'
check "three chambers, three pressures" turned 4
turned 4 | sed 's/^/# /'
finish
