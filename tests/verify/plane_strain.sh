#!/bin/bash
# Slices in plane strain: the tube 1 <= r <= 2 under p/mu = 0.12 and 0.3 against the closed form (kappa = 100 mu, all
# printed digits), and Cook's membrane at nu = 0.499.
# shellcheck disable=SC2016,SC2317 # awk programs; functions that check calls
. tests/lib.sh

slice=$LIB/slice
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 # as the tools do for themselves
abs='function abs(v) { return v < 0 ? -v : v }'

# tube ELEMENT N P WANT..: relative errors of u_a, u_b, dub/dp to the table.
tube() {
    local element=$1 n=$2 p=$3
    shift 3
    "$slice" cylinder "$n" "$element" 100 "$p" >"$work/tube" &&
        awk -v e="$element" -v n="$n" -v p="$p" -v w="$*" '{ split(w, v); print e, n, p, $2 / v[1] - 1, $3 / v[2] - 1, $5 / v[3] - 1 }' \
            "$work/tube" >>"$work/table"
}

elements='tet10-blend tet10 tet10-mean tet15'
for element in $elements; do
    for n in 2 4; do
        check "tube: $element, $n parts" tube "$element" "$n" 0.12 0.090362944 0.047015644 0.45618379
    done
done
check "tube, p/mu = 0.3: tet10-blend, 4 parts" tube tet10-blend 4 0.30 0.282959524 0.156508297 0.81421025
echo "# element parts p/mu error_a error_b error_dub/dp"
sed 's/^/# /' "$work/table"
check "tube: tet10-blend within 0.1 % of u and du/dp at 4 parts" awk "$abs"' $1 == "tet10-blend" && $2 == 4 &&
    (abs($4) > 1e-3 || abs($5) > 1e-3 || abs($6) > 1e-3) { bad = 1 } END { exit bad || NR == 0 }' "$work/table"
# quadratic elements: order 3 in the displacement; seen 2.2 to 2.6 from 2 to 4 parts, 2.5 to 2.8 from 4 to 8
for element in $elements; do
    check "tube: $element, order 2 or more in u_a" awk -v e="$element" "$abs"' $1 == e && $3 == 0.12 { v[$2] = abs($4) }
        END { exit !(v[4] > 0 && v[2] / v[4] > 4) }' "$work/table"
done

# Cook: u_y at (48, 60), mm. Quadrilaterals with F-bar give 6.1414 at 4 and 6.8914 at 30 parts a side, with plain
# displacements 2.2867 and 4.7028 (OpenGeoSys's benchmark of large deformations); all our quadratic elements run to
# 6.935 +- 0.01.
cook() {
    "$slice" "$1" "$3" "$2" 499.6666667 >"$work/cook" && echo "$1 $2 $3 $(cut -f 2 "$work/cook")" >>"$work/cooks"
}
for element in $elements; do
    check "Cook: $element, 8 parts" cook cook-steep "$element" 8
done
check "Cook: tet10-blend, 16 parts, other diagonals" cook cook tet10-blend 16
check "Cook: tet4, 8 parts" cook cook-steep tet4 8
sed 's/^/# /' "$work/cooks"
check "Cook: tet10-blend within 1 % on both meshes" awk '$2 == "tet10-blend" && ($4 < 0.99 * 6.935 || $4 > 1.01 * 6.935) { bad = 1 }
    END { exit bad || NR == 0 }' "$work/cooks"
check "Cook: tet10-blend is nearer than plain tet10" awk "$abs"' $1 == "cook-steep" { v[$2] = abs($4 - 6.935) }
    END { exit !(v["tet10-blend"] < v["tet10"] / 2) }' "$work/cooks"
check "Cook: tet15 within 1 %" awk '$2 == "tet15" { good = $4 > 0.99 * 6.935 && $4 < 1.01 * 6.935 } END { exit !good }' "$work/cooks"
check "Cook: tet4 locks" awk '$2 == "tet4" { good = $4 < 0.7 * 6.935 } END { exit !good }' "$work/cooks"
finish
