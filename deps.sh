#!/bin/bash
# deps.sh build|lint: installs the Debian packages that are missing for building and testing, or for
# `make lint`. Prints the command before it runs it; does nothing when nothing is missing.
# DEPS=no turns it off.
set -eu

build=(build-essential pkg-config libhdf5-dev hdf5-tools libsuitesparse-dev libmetis-dev libopenblas-dev
    libgsl-dev liblbfgs-dev libinih-dev zlib1g-dev libgmsh-dev gmsh libcjson-dev gnuplot-nox calculix-ccx admesh perl)
lint=(clang-format clang-tidy cppcheck shellcheck mandoc)

case ${1-} in
build) wanted=("${build[@]}") ;;
lint) wanted=("${lint[@]}") ;;
*)
    echo "usage: deps.sh build|lint" >&2
    exit 2
    ;;
esac

[ "${DEPS-}" = no ] && exit 0
if ! command -v dpkg-query >/dev/null; then
    echo "deps: no dpkg-query here; expected to be installed: ${wanted[*]}" >&2
    exit 0
fi

# A package counts as present when it is installed or another installed one provides it (pkgconf).
present=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n${db:Status-Status} ${Provides}\n' |
    sed -n 's/^installed //p' | tr ',' '\n' | sed 's/^ *//; s/[ (].*//' | sort -u)
missing=()
for package in "${wanted[@]}"; do
    grep -qxF -- "$package" <<<"$present" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
    if ! command -v sudo >/dev/null; then
        echo "deps: as root, run: apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
fi
install=(apt-get install -y --no-install-recommends "${missing[@]}")
echo "deps: missing: ${missing[*]}"
echo "deps: ${as_root[*]} apt-get update && ${as_root[*]} ${install[*]}"
"${as_root[@]}" apt-get update -q
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" "${install[@]}"
