#!/bin/bash
# deps.sh with a packager that only takes notes: what is missing is installed, the command comes first.
. tests/lib.sh

stub=$work/stub
mkdir "$stub"
cat >"$stub/dpkg-query" <<END
#!/bin/sh
cat "$work/installed"
END
for name in apt-get sudo; do
    cat >"$stub/$name" <<END
#!/bin/sh
echo "$name \$*" >>"$work/log"
[ "$name" = sudo ] && exec "\$@"
echo running
END
done
chmod +x "$stub"/*
all='build-essential pkg-config libhdf5-dev hdf5-tools libsuitesparse-dev libmetis-dev libopenblas-dev libgsl-dev
liblbfgs-dev libinih-dev zlib1g-dev libgmsh-dev gmsh libcjson-dev gnuplot-nox calculix-ccx admesh perl'
installed() {
    printf 'installed %s\n' "$@" >"$work/installed"
    : >"$work/log"
}

# shellcheck disable=SC2086
installed $all
expect 0 "nothing missing" env -u DEPS PATH="$stub:$PATH" ./deps.sh build
check "nothing said" test ! -s "$work/out"
check "nothing done" test ! -s "$work/log"

# shellcheck disable=SC2086
installed ${all/libgsl-dev/}
sed -i 's/^installed pkg-config$/installed pkgconf\ninstalled pkg-config (= 1)/' "$work/installed"
expect 0 "one missing" env -u DEPS PATH="$stub:$PATH" ./deps.sh build
check "it alone is installed" grep -q 'apt-get install -y --no-install-recommends libgsl-dev$' "$work/log"
check "the command comes before its run" sh -c "grep -n 'apt-get install\|running' '$work/out' | head -n 1 | grep -q 'install'"

expect 0 "DEPS=no" env DEPS=no PATH="$stub:$PATH" ./deps.sh build
check "DEPS=no says nothing" test ! -s "$work/out"
expect 2 "unknown list" ./deps.sh other
finish
