#!/bin/bash
# accuracy.sh mesh BODY.geo NAME.msh | row MESH.h5 NAME.row | round KAPPA | cook | table ROW.. | noise ROW.. | report TABLE
# The measurements of accuracy.mk. A mesh is named BODY-SIZE-KIND: q (quarter, symmetric) or h (half, bends); kind curved,
# straight (middles of chords), linear, or fine (for references: smaller edges at the crests). A row is named
# MESH+ELEMENT+KAPPA+LAW, kappa in mu.
set -eu
. pipelines/measure.sh

# fixed COMMAND..: at fixed addresses where the system permits that; gmsh's meshes depend on them.
fixed() {
    if setarch -R true 2>/dev/null; then setarch -R "$@"; else "$@"; fi
}

make_mesh() {
    local name body size kind set=() log=${2%.msh}.log
    name=$(basename "$2" .msh)
    IFS=- read -r body size kind <<<"$name"
    set=(-setnumber size "$size")
    [ "$body" = h ] && set+=(-setnumber shift 0.8)
    case $kind in
    straight) set+=(-setnumber straight 1) ;;
    linear) set+=(-setnumber order 1) ;;
    fine) set+=(-setnumber crest 0.8) ;;
    esac
    fixed gmsh -3 -nt 1 -v 2 "${set[@]}" "$1" -o "$2" >"$log" 2>&1 || { tail -n 5 "$log" >&2; return 1; }
}

# Parameters of laws of small-strain modulus 1, as examples of how far they differ: a fifth of Mooney-Rivlin in I2, a Yeoh
# law that stiffens, Ogden's rubber of three terms with alpha = 1.3, 5, -2, scaled.
law() {
    case $1 in
    neo-hookean) echo 1 ;;
    mooney-rivlin) echo 0.4,0.1 ;;
    yeoh) echo 0.5,-0.01,0.002 ;;
    ogden) echo 1.4909,1.3,0.0028,5,-0.0237,-2 ;;
    esac
}

# Body, size, kind, element, kappa, law, unknowns, tetrahedra, factorisations, CPU seconds, U, V, V0, CPU seconds of a
# factorisation.
make_row() {
    local body size kind mesh element kappa law cpu unknowns state=${2%.row}.h5 log=${2%.row}.log
    IFS=+ read -r mesh element kappa law <<<"$(basename "$2" .row)"
    IFS=- read -r body size kind <<<"$mesh"
    : >"$log"
    cpu=$(cpu "$BIN/fesolve" -v --element "$element" --law "$law" --parameters "$(law "$law")" --kappa "$kappa" \
        --pressure "$PRESSURE" "$1" -o "$state")
    unknowns=$(sed -n 's/^fesolve: \([0-9]*\) unknowns.*/\1/p' "$log" | tail -n 1)
    printf '%s\t' "$body" "$size" "$kind" "$element" "$kappa" "$law" "$unknowns" "$(tetrahedra "$1")" \
        "$(item /solve/factorisations "$state")" "$cpu" "$(item /tip/U "$state")" "$(item /chamber/volume "$state")" >"$2.part"
    printf '%s\t%s\n' "$(item /chamber/volume0 "$state")" "$(sed -n 's/^fesolve: factor: .* \([0-9.]*\) s each.*/\1/p' "$log" | tail -n 1)" >>"$2.part"
    mv "$2.part" "$2"
}

# Errors of all elements on the sphere and the tube, A = 1, B = 2, p/mu = 0.12: relative errors of u inside and outside and
# of du/dp (central differences). The wanted values solve the radial differential equation.
make_round() {
    local kappa=$1 work element shape n m
    work=$(mktemp -d)
    # shellcheck disable=SC2064
    trap "rm -rf '$work'" EXIT
    printf 'body\tkappa\telement\tparts\tu_a\tu_b\tdua/dp\tdub/dp\n'
    for n in 2 3 4 6 8; do
        m=$((n * 3 / 4))
        for shape in linear quadratic; do
            "$LIB/thick_sphere" write "$n" "$m" "$shape" "$work/s.msh"
            "$BIN/tetmesh" --import "$work/s.msh" --mu 1 --kappa "$kappa" -o "$work/$shape-$n.h5"
        done
    done
    for element in $ELEMENTS; do
        shape=quadratic
        [ "$element" = tet4 ] && shape=linear
        for n in 2 3 4 6 8; do
            for p in 0.12 0.119 0.121; do
                "$BIN/fesolve" --element "$element" --tolerance 1e-10 --pressure "$p" "$work/$shape-$n.h5" -o "$work/state.h5"
                "$LIB/thick_sphere" read "$work/state.h5"
            done | awk -v e="$element" -v n="$n" '{ a[NR] = $1; b[NR] = $2 }
                END { print "sphere", e, n, a[1], b[1], (a[3] - a[2]) / 0.002, (b[3] - b[2]) / 0.002 }'
        done
        for n in 1 2 4 8; do
            echo "tube $element $n $("$LIB/slice" cylinder "$n" "$element" "$kappa" 0.12 | cut -f 2-)"
        done
    done | awk -v OFS='\t' -v kappa="$kappa" '
        function want(name, values) { split(values, v); for (k = 1; k <= 4; k++) w[name, k] = v[k] }
        BEGIN {
            want("sphere 10", "0.037721516 0.010846999 0.34070006 0.10099697"); want("tube 10", "0.092821650 0.051263953 0.87860923 0.49965843")
            want("sphere 100", "0.037058085 0.009676706 0.33367109 0.08987981"); want("tube 100", "0.090362944 0.047015644 0.85031912 0.45618379")
            want("sphere 1000", "0.036991722 0.009559631 0.33296800 0.08876749"); want("tube 1000", "0.090108941 0.046576674 0.84739825 0.45169292")
        }
        { name = $1 " " kappa; printf "%s\t%s\t%s\t%s", $1, kappa, $2, $3
          for (k = 1; k <= 4; k++) printf "\t%.3e", $(3 + k) / w[name, k] - 1
          printf "\n" }'
}

# Cook's membrane at nu = 0.499: u_y at (48, 60) for both ways to cut the cells.
make_cook() {
    local element mesh n
    printf 'mesh\telement\tparts\tunknowns\tu_y\n'
    for mesh in cook-steep cook; do
        for element in $ELEMENTS; do
            for n in 4 8 16 32; do
                [ "$element$n" = tet1532 ] && continue # three minutes
                printf '%s\t%s\t%s\t%s\n' "$mesh" "$element" "$n" "$("$LIB/slice" "$mesh" "$n" "$element" 499.6666667)"
            done
        done
    done
}

# Errors [%] of translation (e_pose: of the whole vector), rotation and volume change against the finest row of the same body, kappa and law.
make_table() {
    printf 'body\tsize\tkind\telement\tkappa\tlaw\tunknowns\ttets\tfactorisations\tcpu_s\tfactor_s\tUx\tUz\ttheta_y\tdV\te_Ux\te_Uz\te_theta\te_dV\te_pose\n'
    cat "$@" | awk -F '\t' -v OFS='\t' '
        function error(a, b) { return b == 0 ? "-" : sprintf("%.2f", 100 * (a / b - 1)) }
        { row[NR] = $0; key = $1 "+" $5 "+" $6
          if ($3 == "fine" && $4 == "tet15") { x[key] = $11; z[key] = $13; t[key] = $15; v[key] = $17 - $18 } }
        END {
            for (i = 1; i <= NR; i++) {
                $0 = row[i]; key = $1 "+" $5 "+" $6
                dx = $11 - x[key]; dz = $13 - z[key]
                size = sqrt(x[key] ^ 2 + z[key] ^ 2)
                e = size > 0 ? sprintf("%.2f", 100 * sqrt(dx * dx + dz * dz) / size) : "-"
                print $1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $19, sprintf("%.4f", $11), sprintf("%.4f", $13),
                    sprintf("%.5f", $15), sprintf("%.2f", $17 - $18), error($11, x[key]), error($13, z[key]),
                    error($15, t[key]), error($17 - $18, v[key]), e
            }
        }' | sort -t "$(printf '\t')" -k 1,1 -k 5,5n -k 6,6 -k 3,3 -k 4,4 -k 2,2gr
}

# Jumps of element pressures between neighbours, in units of mu, beside the pressures themselves (root mean squares).
make_noise() {
    local row name mesh element kappa law
    printf 'mesh\telement\tjump\tpressure\n'
    for row in "$@"; do
        name=$(basename "$row" .row)
        # shellcheck disable=SC2034 # the place of kappa
        IFS=+ read -r mesh element kappa law <<<"$name"
        case $mesh+$element+$law in
        *-curved+tet10*+neo-hookean) [ "$kappa" = 100 ] && printf '%s\t%s\t%s\n' "$mesh" "$element" "$("$LIB/pressure_noise" "${row%.row}.h5")" ;;
        esac
    done | sort -u
}

case $1 in
mesh) make_mesh "$2" "$3" ;;
row) make_row "$2" "$3" ;;
round) make_round "$2" ;;
cook) make_cook ;;
table) shift && make_table "$@" ;;
noise) shift && make_noise "$@" ;;
report) column -t -s "$(printf '\t')" "$2" ;;
esac
