#!/bin/bash
# Suction and several pressures at once: J against differences, strain energy against the work of the pressures, balance
# of forces and moments.
# shellcheck disable=SC2317 # functions that check calls
. tests/lib.sh

numbers() {
    h5dump -m %.17g -y -w 0 -d "$1" "$2" | awk '/DATA \{/ { on++; next } /}/ { on += on } on == 1' | tr ',\n' '  '
}

# body NAME PART
body() {
    "$LIB/beam" "$1" "$2" 4 "$work/b.msh" && "$BIN/tetmesh" -q --import "$work/b.msh" --mu 1 --kappa 100 -o "$work/$1.h5"
}

# path BODY: along $work/path.txt to $work/path.h5
path() {
    rm -f "$work/path.h5"
    "$BIN/fesolve" --tolerance 1e-10 --path "$work/path.txt" "$work/$1.h5" -o "$work/path.h5"
}

# jacobian CHAMBERS: central differences, h = 2e-6, of each pressure in turn. Walls under suction are near to buckling:
# h^2 U'''/6 is 5e-7 at h = 1e-5; with residuals of 1e-10 over h seen up to 1e-7.
jacobian() {
    awk -v p="$(numbers /path/pressure "$work/path.h5")" -v u="$(numbers /path/U "$work/path.h5")" \
        -v j="$(numbers /path/J "$work/path.h5")" -v nc="$1" 'BEGIN {
        split(u, U); split(j, J); split(p, P)
        for (r = 1; r <= nc; r++)
            for (g = 0; g < 6; g += 3) {
                square = error = 0
                for (i = 1 + g; i <= 3 + g; i++) {
                    want = J[nc * (i - 1) + r]
                    square += want^2
                    error += ((U[6 * 2 * r + i] - U[6 * (2 * r - 1) + i]) / (P[nc * 2 * r + r] - P[nc * (2 * r - 1) + r]) - want)^2
                }
                e = sqrt(error / square)
                print e
                if (!(e < 1e-6)) bad = 1
            }
        exit bad }'
}

# work NC PARTS: along an even path from 0 the strain energy is the integral of sum p dV (mu = 1 MPa); trapezoids of the
# whole path and of its parts, extrapolated (Romberg), seen to 2e-8 (7e-12 with twice the points).
work() {
    awk -v p="$(numbers /path/pressure "$work/path.h5")" -v v="$(numbers /path/volume "$work/path.h5")" \
        -v w="$(numbers /path/energy "$work/path.h5")" -v nc="$1" -v parts="$2" 'BEGIN {
        split(p, P); split(v, V); split(w, W)
        for (n = parts; n >= 1; n /= 2) {
            levels++
            for (k = 0; k < parts; k += parts / n)
                for (r = 1; r <= nc; r++) {
                    a = nc * k + r; b = nc * (k + parts / n) + r
                    T[levels] += (P[a] + P[b]) / 2 * (V[b] - V[a])
                }
        }
        for (m = 1; m < levels; m++)
            for (k = 1; k <= levels - m; k++)
                T[k] += (T[k] - T[k + 1]) / (4^m - 1)
        e = T[1] / W[parts + 1] - 1
        print "energy", W[parts + 1], "work", T[1], "relative", e
        exit !(e < 1e-7 && e > -1e-7) }'
}

# balance STATE SCALE: the clamp holds nothing, forces to 1e-8 of SCALE, moments to that times 30 mm.
balance() {
    awk -v f="$(numbers /base/reaction "$1")" -v s="$2" 'BEGIN {
        n = split(f, F)
        for (i = 1; i <= n; i++) {
            F[i] /= i > 3 ? 30 * s : s
            print F[i]
            if (!(F[i]^2 < 1e-16)) bad = 1
        }
        exit bad || n != 6 }'
}

check "finger" body finger half
check "half a pair" body pair half
printf '%s\n' -0.05 -0.050002 -0.049998 >"$work/path.txt"
check "suction" path finger
check "J under suction" jacobian 1
jacobian 1 | sed 's/^/# /'
printf '%s\n' "0.1 -0.02" "0.099998 -0.02" "0.100002 -0.02" "0.1 -0.020002" "0.1 -0.019998" >"$work/path.txt"
check "pressure and suction" path pair
check "J of both" jacobian 2
jacobian 2 | sed 's/^/# /'

awk 'BEGIN { for (k = 0; k <= 16; k++) printf "%.17g\n", -0.03 * k / 16 }' >"$work/path.txt"
check "suction from zero" path finger
check "energy is the work of suction" work 1 16
work 1 16 | sed 's/^/# /'
awk 'BEGIN { for (k = 0; k <= 16; k++) printf "%.17g %.17g\n", 0.1 * k / 16, -0.03 * k / 16 }' >"$work/path.txt"
check "two pressures from zero" path pair
check "energy is the work of both" work 2 16
work 2 16 | sed 's/^/# /'

check "a whole pair" body pair whole
check "one state" "$BIN/fesolve" --tolerance 1e-10 --pressure 0.1,-0.03 "$work/pair.h5" -o "$work/state.h5"
# 0.1 MPa on 100 mm2
check "a free body: no force, no moment on the clamp" balance "$work/state.h5" 10
balance "$work/state.h5" 10 | sed 's/^/# /'
finish
