#!/bin/bash
# Bad input files: status 3, one line that names the file, no output.
. tests/lib.sh

for kind in surface mesh state work sens step; do
    check "sample $kind" "$LIB/sample" "$kind" "$work/$kind.h5"
done
echo "not a case" >"$work/bad.ini"
echo "plain text" >"$work/text.h5"
: >"$work/empty.h5"

# refuses TOOL NAME FILE [ARGUMENTS..]: the file is refused by name; the arguments are the whole call.
refuses() {
    local tool=$1 name=$2 file=$3
    shift 3
    refused 3 "$tool: $name" "^$tool: cannot (use|open) '$file'" "$BIN/$tool" "$@" -o "$work/output/x.h5"
}

# each TOOL KIND ITEM [ARGUMENTS.. @ ..]: @ stands for the file under test; KIND is what belongs there.
each() {
    local tool=$1 kind=$2 item=$3 bad name
    shift 3
    for bad in none text empty other truncated nan missing version foreign; do
        local file=$work/$bad.h5
        case $bad in
        other) file=$work/sens.h5 && [ "$kind" = sens ] && file=$work/work.h5 ;;
        truncated) head -c $(($(stat -c %s "$work/$kind.h5") * 2 / 3)) "$work/$kind.h5" >"$file" ;;
        nan | missing | version | foreign) cp "$work/$kind.h5" "$file" ;;
        esac
        case $bad in
        nan) check "damage" "$LIB/mangle" set "$file" "$item" 0 nan ;;
        missing) check "damage" "$LIB/mangle" drop "$file" "$item" ;;
        version) check "damage" "$LIB/mangle" attribute "$file" format_version 2.0 ;;
        foreign) check "damage" "$LIB/mangle" attribute "$file" format other ;;
        esac
        name="$kind file: $bad"
        refuses "$tool" "$name" "$file" "${@/#@/$file}"
        case $bad in
        nan | missing) check "$tool: $name: names the item" grep -qF "'$item'" "$work/err" ;;
        esac
    done
}

refuses surfgen "no case" "$work/none.ini" "$work/none.ini"
refuses surfgen "bad case" "$work/bad.ini" "$work/bad.ini"
refuses surfgen "binary case" "$work/mesh.h5" "$work/mesh.h5"
sed '/^wall *=/d; /^web *=/d; s/^shape = envelope/shape = file/' tests/data/tiny.ini >"$work/file.ini"
refused 2 "surfgen: a body without its file" "from a file, expected --body" \
    "$BIN/surfgen" "$work/file.ini" -o "$work/output/x.h5"
refused 2 "surfgen: a file nobody asks for" "not from a file" \
    "$BIN/surfgen" tests/data/tiny.ini --body "$work/bad.stl" -o "$work/output/x.h5"
refused 2 "surfgen: chamber 9" "expected N=FILE" \
    "$BIN/surfgen" tests/data/tiny.ini --chamber "9=$work/bad.stl" -o "$work/output/x.h5"
echo "not a surface" >"$work/bad.stl"
refuses surfgen "not an STL file" "$work/bad.stl" "$work/file.ini" --body "$work/bad.stl"
each surfremesh surface /surface1/phi @
each tetmesh surface /surface1/phi @
each fesolve mesh /mesh/x --load 0 @
each wsint state /tip/J @
each adjsens state /node/displacement @ "$work/work.h5"
each adjsens work /point/J "$work/state.h5" @
each trstep surface /surface1/phi @ "$work/work.h5"
each trstep work /measure/value "$work/surface.h5" @
each trstep sens /gradient/phi "$work/surface.h5" "$work/work.h5" @ @ @ @
each trstep step /step/radius "$work/surface.h5" "$work/work.h5" --previous @
each tetmesh mesh /mesh/x "$work/surface.h5" --previous @
each fesolve state /node/displacement "$work/mesh.h5" --load 0 --guess @
each invkin mesh /mesh/x --target 0,0 @
each invkin state /node/displacement "$work/mesh.h5" --target 0,0 --guess @
each meshexport state /node/displacement @
each meshexport mesh /mesh/x --pressure 0.1,0 @
each surfexport surface /surface1/phi @
each wsint work /measure/orientation "$work/state.h5" --sign-from @
finish
