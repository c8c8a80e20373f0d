# TAP for shell tests: source it from a test that runs in the source root. `make check` sets BUILD; by hand
# the default is the plain build. A test ends with `finish`; one that dies early prints no plan and fails.
# shellcheck shell=bash
set -u
export LC_ALL=C
# A make that a test calls is its own, but takes the variables of the command line: other flags would
# rebuild what is being tested.
case ${MAKEFLAGS-} in
*' -- '*) export MAKEFLAGS="-- ${MAKEFLAGS#* -- }" ;;
*) unset MAKEFLAGS ;;
esac
unset MFLAGS MAKELEVEL
BUILD=${BUILD:-build}
# shellcheck disable=SC2034
BIN=$BUILD/bin
# shellcheck disable=SC2034
LIB=$BUILD/tests/lib
# The tools there must be, and those there are.
# shellcheck disable=SC2034
mapfile -t tools < <({
    printf '%s\n' surfgen surfremesh tetmesh fesolve adjsens wsint trstep
    for main in tools/*/main.c; do basename "$(dirname "$main")"; done
} | sort -u)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
count=0
failed=0

# result STATUS NAME: one check, good where STATUS is 0.
result() {
    count=$((count + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $count - $2"
    else
        echo "not ok $count - $2"
        failed=$((failed + 1))
    fi
}

# check NAME COMMAND..: the command succeeds; leaves $work/out and $work/err of the last expect or refused.
check() {
    local name=$1 status=0
    shift
    "$@" >"$work/check" 2>&1 || status=$?
    result "$status" "$name"
    [ "$status" -eq 0 ] || note "$*" "$work/check"
}

# expect STATUS NAME COMMAND..: the command ends with this exit status; its output is in $work/out and
# $work/err.
expect() {
    local want=$1 name=$2 status=0
    shift 2
    "$@" >"$work/out" 2>"$work/err" || status=$?
    result "$((status != want))" "$name"
    if [ "$status" -ne "$want" ]; then
        echo "# got status $status, want $want"
        note "$*"
    fi
}

# refused STATUS NAME PATTERN COMMAND..: ends with the status, says why in one line that matches, and leaves
# nothing in $work/output (where the command should have written).
refused() {
    local want=$1 name=$2 pattern=$3 status=0 bad=0
    shift 3
    rm -rf "$work/output" && mkdir "$work/output"
    "$@" >"$work/out" 2>"$work/err" || status=$?
    [ "$status" -eq "$want" ] || bad=1
    [ "$(grep -vc "^Try '" "$work/err")" -eq 1 ] || bad=1
    grep -qE -- "$pattern" "$work/err" || bad=1
    [ -z "$(ls -A "$work/output")" ] || bad=1
    result "$bad" "$name"
    if [ "$bad" -ne 0 ]; then
        echo "# got status $status, want $want, one line like '$pattern' and no file; files: $(ls -A "$work/output")"
        note "$*"
    fi
}

# note COMMAND [FILE]: how to repeat it and what it said.
note() {
    echo "# command: $1"
    sed 's/^/# /' "${2:-$work/err}"
}

finish() {
    echo "1..$count"
    exit "$((failed > 0))"
}

# fill_body SKIN.msh BODY.msh: gmsh fills the body of two chambers whose surfaces surfexport wrote.
fill_body() {
    cat >"$work/body.geo" <<END
Merge "$1";
Surface Loop(1) = {1, 2, 3};
Surface Loop(2) = {4};
Surface Loop(3) = {5};
Volume(1) = {1, 2, 3};
Physical Volume("body") = {1};
END
    gmsh -3 -nt 1 -v 2 -format msh41 "$work/body.geo" -o "$2"
}
