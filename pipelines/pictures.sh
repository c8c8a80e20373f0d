#!/bin/bash
# pictures.sh RUN: draws RUN/pictures/*.png from the files of a run: the first design and the last accepted one.
set -eu
run=$1
[ -r "$run/history.tsv" ] || { echo "pictures: '$run' has no history.tsv, expected RUN=run/NAME of an optimisation" >&2; exit 2; }
last=$(awk -F '\t' '$2 == 1 { a = $1 } END { printf "it%03d", a }' "$run/history.tsv")
out=$run/pictures
data=$out/data
mkdir -p "$data"

# plot SCRIPT: gnuplot with the folder of tables and the name of the picture.
plot() {
    gnuplot -c "pipelines/pictures/$1.gp" "$data" "$out/$1.png"
    echo "$out/$1.png"
}

awk -F '\t' -v OFS='\t' 'NR == 1 { print; next } { print $1, $2, $3, $4, $5, $6, $7, $8, $9, $10 }' "$run/history.tsv" >"$data/history"
plot convergence

"$BIN/pmplot" surface --accepted "$run/it000/step.h5" >"$data/surface-before"
"$BIN/pmplot" section --accepted "$run/it000/step.h5" >"$data/section-before"
"$BIN/pmplot" surface --accepted "$run/$last/step.h5" >"$data/surface-after"
"$BIN/pmplot" section --accepted "$run/$last/step.h5" >"$data/section-after"
plot shape

# Corners of the actuation box: none, the first chamber, all.
chambers=$("$BIN/wsint" --points "$run/case.ini" | awk -F '\t' 'NR == 1 { n = NF - 5 } END { print n }')
none=$(printf -- '-0%.0s' $(seq "$chambers"))
none=${none:1} one=1${none:1} all=${none//0/1}
"$MAKE" -s --no-print-directory RUN="$run" ITER="$last" "$run/$last/corner-$one.h5" "$run/$last/corner-$all.h5" || exit
"$BIN/pmplot" deformed "$run/$last/corner-$one.h5" >"$data/deformed-one"
"$BIN/pmplot" deformed "$run/$last/corner-$all.h5" >"$data/deformed-all"
plot deformed

# The outline of a planar workspace.
[ "$chambers" -eq 2 ] || exit 0
for iteration in it000 "$last"; do
    d=$run/$iteration
    "$MAKE" -s --no-print-directory RUN="$run" ITER="$iteration" "$d/corner-$none.h5" "$d/corner-$one.h5" "$d/corner-$all.h5" || exit
done
"$BIN/pmplot" workspace "$run"/it000/state-*.h5 "$run"/it000/corner-*.h5 >"$data/workspace-before"
"$BIN/pmplot" workspace "$run/$last"/state-*.h5 "$run/$last"/corner-*.h5 >"$data/workspace-after"
plot workspace
