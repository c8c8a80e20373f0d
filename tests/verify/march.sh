#!/bin/bash
# Steps without equilibria that push every wall and bend to its limit: trstep lets none pass.
. tests/lib.sh
. tests/march.sh

sed 's/^tolerance.*/tolerance = 1e-9/' tests/data/tiny.ini >"$work/tiny.ini"
check "chambers against walls" march volume "$work/tiny.ini" 7
held "walls"
check "the walls were reached" awk -F '\t' '$3 < 1.01 { met = 1 } END { exit !met }' "$work/march/rows.tsv"
check "every trial was accepted" awk -F '\t' 'NR > 1 && !$2 { exit 1 }' "$work/march/history.tsv"
check "folds" march area "$work/tiny.ini" 4
held "bends"
finish
