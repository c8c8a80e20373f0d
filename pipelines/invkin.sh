#!/bin/bash
# One list of targets for invkin from a mesh, or the summary of the tables; see pipelines/invkin.mk. Run by make, BIN set.
#
#   pipelines/invkin.sh targets random|turn|shift MESH.h5 MAX COUNT    the targets in the components 1, 3, 5, to stdout
#   pipelines/invkin.sh report TABLE..
# shellcheck disable=SC2154 # BIN comes from make
set -eu -o pipefail
export LC_ALL=C
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# poses FILE: U1 U3 U5 at the pressures of a list.
poses() {
    "$BIN/fesolve" -q --path "$1" "$mesh" -o "$work/path.h5"
    "$BIN/pmplot" path "$work/path.h5" | awk -v n="$chambers" '!/^#/ && NF { print $(n + 1), $(n + 3), $(n + 5) }'
}

case $1 in
targets)
    what=$2 mesh=$3 max=$4 count=$5
    chambers=$(h5dump -A 0 -y -d /mesh/chambers "$mesh" | awk '/ DATA [{]/ { getline; print $1 }')
    if [ "$what" = random ]; then
        awk -v n="$count" -v nc="$chambers" -v max="$max" 'BEGIN { s = 7
            for (i = 1; i <= n * nc; i++) { s = (s * 16807) % 2147483647; printf "%.9f%s", max * s / 2147483647, i % nc ? " " : "\n" } }' >"$work/p"
        poses "$work/p"
    else
        # About the middle of the box, over 1/5 of what the corners span.
        awk -v nc="$chambers" -v max="$max" 'BEGIN { for (c = -1; c < 2^nc; c++) { for (k = 0; k < nc; k++)
            printf "%.9g%s", (c < 0 ? max / 2 : max * (int(c / 2^k) % 2)), (k < nc - 1 ? " " : "\n") } }' >"$work/p"
        poses "$work/p" | awk -v n="$count" -v column="$([ "$what" = turn ] && echo 3 || echo 1)" '
            NR == 1 { split($0, middle) } { if (NR == 1 || $column < low) low = $column; if (NR == 1 || $column > high) high = $column }
            END { for (i = 0; i < n; i++) { for (k = 1; k <= 3; k++)
                printf "%.9g%s", middle[k] + (k == column ? (high - low) / 5 * (i / (n - 1) - 0.5) : 0), (k < 3 ? " " : "\n") } }'
    fi
    ;;
report)
    shift
    for table; do
        awk -F '\t' 'NR > 1 { print $(NF - 1), $NF, ($2 == "reached") }' "$table" | sort -n |
            awk -v name="$(basename "$table" .tsv)" '{ e[NR] = $1; f += $2; r += $3 } END {
                printf "%-8s %d of %d targets reached, equilibria per target: median %d, most %d; %.1f factorisations each\n",
                    name, r, NR, e[int((NR + 1) / 2)], e[NR], f / NR }'
    done
    ;;
esac
