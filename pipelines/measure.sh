# What the scripts that measure share: source it. One thread, so that CPU time is a measure of work.
# shellcheck shell=bash
export LC_ALL=C OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1

# cpu COMMAND..: runs it; prints its CPU seconds to stdout. Its own output goes to the log $log.
# shellcheck disable=SC2154 # log is set by the caller
cpu() {
    local TIMEFORMAT='%U %S'
    { time "$@" >>"$log" 2>&1; } 2>"$log.time" || { tail -n 5 "$log" >&2; return 1; }
    awk '{ printf "%.2f\n", $1 + $2 }' "$log.time"
}

# item NAME FILE: the numbers of a dataset, tab separated.
item() {
    h5dump -A 0 -y -w 0 -d "$1" "$2" | awk '/ DATA \{/ { on = 1; next } /\}/ { on = 0 } on { gsub(/ /, ""); gsub(/,/, "\t"); print }'
}

# tetrahedra FILE: their number in a mesh.
tetrahedra() {
    h5dump -H -d /mesh/tet "$1" | sed -n 's/.*DATASPACE *SIMPLE *{ ( \([0-9]*\),.*/\1/p'
}
